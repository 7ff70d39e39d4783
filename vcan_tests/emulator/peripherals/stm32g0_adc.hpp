#pragma once
// ADC1 of the STM32G0B1 (RM0444): one channel by software's start, once or on and on, with its oversampler.
// Stricter than most chips: what is out of the manual's order is not done, and counted.

#include <cstdint>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator::g0 {

class Adc final : public Peripheral {
 public:
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return result_; }
  void advance(Cycle now) override;
  void reset();

  /// Voltage of `channel` as a fraction of the reference, 0..1 (clipped), at time `at`.
  std::function<double(int channel, Cycle at)> sample;
  /// Writes that the chip would not have taken, or with no known effect.
  std::uint64_t refused() const { return refused_; }
  bool running() const { return result_ != kNever; }

 private:
  Cycle clocks(double count) const;
  Cycle conversion() const;
  unsigned conversions() const { return (cfgr2_ & 1) != 0 ? 2u << (cfgr2_ >> 2 & 7) : 1u; }
  void control(std::uint32_t value, Cycle now);
  void settle(Cycle now);
  void configure(std::uint32_t& reg, std::uint32_t value, bool off_only);
  void refuse() { ++refused_; }

  std::uint32_t isr_ = 0, cr_ = 0, cfgr1_ = 0, cfgr2_ = 0, smpr_ = 0, chselr_ = 0, dr_ = 0;
  Cycle regulated_ = kNever, calibrated_ = kNever, ready_ = kNever, taken_ = kNever, result_ = kNever;
  std::uint64_t refused_ = 0;
};

}  // namespace kinebus::emulator::g0
