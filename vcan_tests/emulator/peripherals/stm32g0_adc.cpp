#include "vcan_tests/emulator/peripherals/stm32g0_adc.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace kinebus::emulator::g0 {
namespace {

constexpr std::uint32_t kStatus = 0x00, kControl = 0x08, kSettings = 0x0C, kClocking = 0x10, kSampling = 0x14,
                        kChannels = 0x28, kResult = 0x40;
constexpr std::uint32_t kReady = 1, kEndOfConversion = 4, kLost = 16, kTaken = 1u << 13;
constexpr std::uint32_t kEnable = 1, kStart = 4, kRegulator = 1u << 28, kCalibrate = 1u << 31;
constexpr std::uint32_t kOverwrite = 1u << 12, kContinuous = 1u << 13, kClock = 3u << 30;
constexpr Cycle kMicrosecond = kCoreHz / 1'000'000;
// DS13560: of the regulator and of switching on; RM0444: calibration, and between it and switching on.
constexpr Cycle kRegulatorTime = 20 * kMicrosecond, kSwitchOnTime = kMicrosecond;
constexpr double kCalibrationClocks = 82, kAfterCalibrationClocks = 2, kConversionClocks = 12.5;
constexpr std::array kSamplingClocks{1.5, 3.5, 7.5, 12.5, 19.5, 39.5, 79.5, 160.5};
constexpr double kPclk = 64e6;

}  // namespace

void Adc::reset() {
  isr_ = cr_ = cfgr1_ = cfgr2_ = smpr_ = chselr_ = dr_ = 0;
  regulated_ = calibrated_ = ready_ = taken_ = result_ = kNever;
}

// CKMODE: its own clock is not modelled, and nothing ends with it.
Cycle Adc::clocks(double count) const {
  constexpr std::array kDividers{0.0, 2.0, 4.0, 1.0};
  const double divider = kDividers[cfgr2_ >> 30];
  return divider == 0 ? kNever / 2
                      : static_cast<Cycle>(std::ceil(count * divider / kPclk * static_cast<double>(kCoreHz)));
}

Cycle Adc::conversion() const {
  return clocks(conversions() * (kSamplingClocks[smpr_ & 7] + kConversionClocks));
}

void Adc::settle(Cycle now) {
  if ((cr_ & kCalibrate) != 0 && now >= calibrated_) cr_ &= ~kCalibrate;
  if (now >= ready_) {
    isr_ |= kReady;
    ready_ = kNever;
  }
  if (now >= taken_) {
    isr_ |= kTaken;
    taken_ = kNever;
  }
}

void Adc::advance(Cycle now) {
  settle(now);
  while (result_ <= now) {
    const int channel = std::countr_zero(chselr_);
    std::uint32_t sum = 0;
    for (unsigned i = 0; i < conversions(); ++i) {
      const double fraction = sample ? sample(channel, result_) : 0;
      sum += static_cast<std::uint32_t>(std::clamp(std::floor(fraction * 4096 + 0.5), 0.0, 4095.0));
    }
    sum = std::min<std::uint32_t>(sum >> (cfgr2_ >> 5 & 15), 0xFFFF);
    const bool lost = (isr_ & kEndOfConversion) != 0;
    if (lost) isr_ |= kLost;
    if (!lost || (cfgr1_ & kOverwrite) != 0) dr_ = sum;
    isr_ |= kEndOfConversion;
    const bool goes_on = (cfgr1_ & kContinuous) != 0;
    result_ = goes_on ? result_ + conversion() : kNever;
    if (!goes_on) cr_ &= ~kStart;
  }
}

std::uint32_t Adc::read(std::uint32_t offset, Cycle now) {
  advance(now);
  switch (offset) {
    case kStatus:
      return isr_;
    case kControl:
      return cr_;
    case kSettings:
      return cfgr1_;
    case kClocking:
      return cfgr2_;
    case kSampling:
      return smpr_;
    case kChannels:
      return chselr_;
    case kResult:
      isr_ &= ~kEndOfConversion;
      return dr_;
    default:
      return 0;
  }
}

// One thing at a time, as a program is to do them.
void Adc::control(std::uint32_t value, Cycle now) {
  const std::uint32_t fresh = value & ~cr_;
  if ((value & ~(kEnable | kStart | kRegulator | kCalibrate)) != 0) return refuse();
  if ((fresh & kRegulator) != 0) {
    regulated_ = now + kRegulatorTime;
    cr_ |= kRegulator;
    if (fresh != kRegulator) refuse();
    return;
  }
  if ((fresh & kCalibrate) != 0) {
    if ((cr_ & kEnable) != 0 || now < regulated_) return refuse();
    calibrated_ = now + clocks(kCalibrationClocks);
    cr_ |= kCalibrate;
  }
  if ((fresh & kEnable) != 0) {
    if (calibrated_ == kNever || now < calibrated_ + clocks(kAfterCalibrationClocks)) return refuse();
    cr_ |= kEnable;
    ready_ = now + kSwitchOnTime;
  }
  if ((fresh & kStart) != 0) {
    if ((isr_ & kReady) == 0 || (isr_ & kTaken) == 0 || std::popcount(chselr_) != 1) return refuse();
    cr_ |= kStart;
    result_ = now + conversion();
  }
}

void Adc::configure(std::uint32_t& reg, std::uint32_t value, bool off_only) {
  if ((cr_ & (kStart | kCalibrate)) != 0 || (off_only && (cr_ & kEnable) != 0)) return refuse();
  reg = value;
}

void Adc::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  switch (offset) {
    case kStatus:
      isr_ &= ~value;
      break;
    case kControl:
      control(value, now);
      break;
    case kSettings:
      if ((value & ~(kOverwrite | kContinuous)) != 0) refuse();
      configure(cfgr1_, value, false);
      break;
    case kClocking:
      configure(cfgr2_, value, ((value ^ cfgr2_) & kClock) != 0);
      break;
    case kSampling:
      configure(smpr_, value, false);
      break;
    case kChannels:
      configure(chselr_, value, false);
      // It is taken over some clocks later, which CCRDY tells.
      taken_ = now + clocks(4);
      break;
    default:
      refuse();
  }
}

}  // namespace kinebus::emulator::g0
