#pragma once
// The TMC2209s of a board, each with a wire of its own and one of them spoken to at a time.

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <span>

#include "node_firmware/step/tmc2209.hpp"

namespace kinebus::step {

/// Puts bytes out and takes in all that comes on the wire, echo and answer, without the processor.
template <typename T>
concept DriverWire = requires(T& wire, std::size_t driver, std::span<const std::uint8_t> said,
                              std::size_t answer_bytes, std::span<std::uint8_t> heard) {
  wire.begin(driver, said, answer_bytes);
  { wire.done() } -> std::same_as<bool>;
  // Ends it. How many bytes came whole.
  { wire.take(heard) } -> std::same_as<std::size_t>;
};

template <DriverWire Wire, std::size_t kCount>
class DriverChain {
 public:
  static constexpr std::size_t kDrivers = kCount;

  explicit constexpr DriverChain(Wire& wire) : wire_(wire) {}

  tmc2209::Driver& driver(std::size_t i) { return drivers_[i]; }
  const tmc2209::Driver& driver(std::size_t i) const { return drivers_[i]; }

  /// Main loop, each pass.
  void serve(LocalTime now) {
    if (said_) {
      // No exchange takes half as long.
      if (!wire_.done() && now - begun_ < kLongest) return;
      finish();
    }
    // Settings before questions.
    if (!begin_next(now, true)) begin_next(now, false);
  }
  /// Each has its settings, or does not answer.
  bool settled() const {
    for (const tmc2209::Driver& d : drivers_)
      if (d.state() == tmc2209::State::kUnasked) return false;
    return true;
  }

 private:
  static constexpr LocalTime kLongest = std::chrono::milliseconds{10};

  bool begin_next(LocalTime now, bool busy_ones) {
    for (std::size_t n = 1; n <= kCount; ++n) {
      const std::size_t i = (at_ + n) % kCount;
      if (drivers_[i].busy() != busy_ones) continue;
      said_ = drivers_[i].next(now);
      if (!said_) continue;
      // One that is being configured is so to the end.
      at_ = busy_ones ? (i + kCount - 1) % kCount : i;
      talks_to_ = i;
      begun_ = now;
      wire_.begin(i, said_->said(), said_->read ? tmc2209::kValueBytes : 0);
      return true;
    }
    return false;
  }
  void finish() {
    tmc2209::Driver& driver = drivers_[talks_to_];
    std::array<std::uint8_t, 2 * tmc2209::kValueBytes> heard{};
    const tmc2209::Datagram said = *said_;
    said_.reset();
    const std::size_t wanted = said.length + (said.read ? tmc2209::kValueBytes : 0);
    const std::size_t came = wire_.take(std::span(heard).first(wanted));
    const auto echo = std::span<const std::uint8_t>(heard).first(said.length);
    if (came < said.length || !std::equal(echo.begin(), echo.end(), said.bytes.begin()))
      return driver.on_failure();
    if (!said.read) return driver.on_said();
    const auto value =
        tmc2209::answer_of(std::span(heard).subspan(said.length, came - said.length), said.address());
    value ? driver.on_answer(*value) : driver.on_failure();
  }

  Wire& wire_;
  std::array<tmc2209::Driver, kCount> drivers_{};
  std::optional<tmc2209::Datagram> said_;
  std::size_t at_ = kCount - 1, talks_to_ = 0;
  LocalTime begun_{0};
};

}  // namespace kinebus::step
