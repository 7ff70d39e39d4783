#pragma once
// ADC1 to ADC3: injected groups by trigger, regular groups by software, both conversions one after another in
// the time that sampling and clock settings give, simultaneous injected mode of ADC1 and ADC2, results of
// regular groups by DMA.

#include <array>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

class AdcBlock final : public Peripheral {
 public:
  static constexpr int kIrq = 18;
  static constexpr std::uint32_t kAddress = 0x40012000;
  explicit AdcBlock(InterruptLines& lines) : lines_(lines) {}

  /// The three have clocks of their own, one after another in APB2ENR, and share those of ADC1.
  static int clock_offset(std::uint32_t address) {
    const std::uint32_t offset = address - kAddress;
    return offset < 0x300 ? static_cast<int>(offset / 0x100) : 0;
  }

  // ADC1 at 0x000, ADC2 at 0x100, ADC3 at 0x200, common at 0x300.
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return next_; }
  void advance(Cycle now) override;
  void reset();

  /// The trigger with this JEXTSEL code has come.
  void on_trigger(std::uint32_t jextsel, Cycle now);

  /// Voltage of `channel` as a fraction of the reference, 0..1 (clipped), at time `at`.
  std::function<double(int channel, Cycle at)> sample;
  /// ADC 1 to 3 asks its DMA stream to take the result.
  std::function<void(int converter, Cycle at)> on_request;

 private:
  struct Converter {
    std::uint32_t sr = 0, cr1 = 0, cr2 = 0, jsqr = 0, dr = 0;
    std::array<std::uint32_t, 2> smpr{};
    std::array<std::uint32_t, 4> jofr{};
    std::array<std::uint32_t, 3> sqr{};
    std::array<std::uint32_t, 4> jdr{};
    // What is converted now: -1 nothing; the injected group interrupts nothing here, they come one after the
    // other.
    int injected_rank = -1, regular_rank = -1;
    Cycle injected_ready = kNever, regular_ready = kNever;
  };

  Cycle clock() const { return kApb2Divider * 2 * (Cycle{ccr_ >> 16 & 3} + 1); }
  Cycle sampling(const Converter& c, int channel) const;
  static int injected_count(const Converter& c) { return static_cast<int>(c.jsqr >> 20 & 3) + 1; }
  static int injected_channel(const Converter& c, int rank);
  static int regular_channel(const Converter& c, int rank);
  void start_injected(Converter& c, Cycle now);
  void start_regular(Converter& c, Cycle now);
  void convert(Converter& c, Cycle now);
  void hand_over(Converter& c, std::uint32_t result, Cycle at);
  std::uint32_t quantised(int channel, Cycle at) const;
  void schedule();
  void update_line();

  InterruptLines& lines_;
  std::array<Converter, 3> converters_{};
  std::uint32_t ccr_ = 0;
  std::array<Cycle, 3> pending_end_{kNever, kNever, kNever};  // of the injected group, by converter
  Cycle next_ = kNever;
};

}  // namespace kinebus::emulator
