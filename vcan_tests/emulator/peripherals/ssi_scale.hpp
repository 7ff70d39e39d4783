#pragma once
// An absolute linear scale with a synchronous serial interface: it takes its place at the first falling edge
// of a clock that rested high, and puts out a bit with each rising edge. A clock that rests for longer than
// its monoflop is the frame's end.

#include <cstdint>
#include <functional>

#include "vcan_tests/emulator/peripherals/spi.hpp"

namespace kinebus::emulator {

class SsiScale final : public SpiDevice {
 public:
  struct Options {
    unsigned bits = 0;  ///< 0: there is no such scale
    bool gray = false;
    /// The cable is off, or is not; empty: it never is.
    std::function<bool()> unplugged{};
  };

  SsiScale(Options options, std::function<std::uint32_t(Cycle)> position)
      : options_(std::move(options)), position_(std::move(position)) {}

  void on_clock(const Spi& spi) { spi_ = &spi; }
  void select(bool /*selected*/, Cycle /*now*/) override {}
  std::uint16_t exchange(std::uint16_t /*sent*/, Cycle now) override {
    if (options_.unplugged && options_.unplugged()) return 0xFFFF;
    // Bits that are taken at the edge at which they change, or too fast for the cable, are anything.
    if (spi_->mode() != kMode || spi_->frame_bits() != kWord || spi_->clock_hz() > kFastestHz) return 0xA5A5;
    const auto word = static_cast<Cycle>(kWord * static_cast<double>(kCoreHz) / spi_->clock_hz());
    if (now - word > ended_ + kMonoflop || place_ == 0) latch(now - word);
    ended_ = now;
    std::uint32_t bits = 0;
    for (unsigned i = 0; i < kWord; ++i) bits = bits << 1 | next_bit();
    return static_cast<std::uint16_t>(bits);
  }
  std::uint64_t frames() const { return frames_; }

 private:
  static constexpr int kMode = 2, kWord = 16;
  static constexpr double kFastestHz = 1e6;
  static constexpr Cycle kMonoflop = Cycle{168} * 15;

  void latch(Cycle at) {
    const std::uint32_t mask = (std::uint32_t{1} << options_.bits) - 1, value = position_(at) & mask;
    latched_ = options_.gray ? value ^ value >> 1 : value;
    place_ = 0;
    ++frames_;
  }
  std::uint32_t next_bit() {
    const unsigned place = place_++;
    if (place == 0) return 1;  // the line at rest
    return place <= options_.bits ? latched_ >> (options_.bits - place) & 1 : 0;
  }

  Options options_;
  std::function<std::uint32_t(Cycle)> position_;
  const Spi* spi_ = nullptr;
  std::uint32_t latched_ = 0;
  unsigned place_ = 0;
  Cycle ended_ = 0;
  std::uint64_t frames_ = 0;
};

}  // namespace kinebus::emulator
