#include "node_firmware/port/stm32g0b1_ebb/heat_stage.hpp"

#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"

namespace kinebus::g0b1 {
namespace {

// 160.5 clocks to sample, for dividers of up to 100 kOhm with a capacitor, and 12.5 to convert, at 16 MHz:
// 256 of them are 2.8 ms, within a sample's 10 ms.
constexpr std::uint32_t kMost = 4095u * 256 / 16;
static_assert(heat::kFullRatio == 16u << 16 && kMost < 0x10000);

void start_servo() {
  enable_clock(rcc().APBENR2, Rcc::kTim17);
  Timer& t = tim17();
  t.PSC = kCoreHz / 1'000'000 - 1;  // us
  t.ARR = heat::PinProbe::kPeriod / std::chrono::microseconds{1} - 1;
  t.CCMR1 = Timer::kPwm1Preload;
  t.CCR[0] = 0;
  t.CCER = bit(0);
  t.BDTR = Timer::kMainOutput;
  t.EGR = Timer::kGenerateUpdate;
  t.CR1 = Timer::kEnable | Timer::kAutoReloadPreload;
}

void wait_us(std::uint32_t us) {
  const std::uint32_t from = local_counts(), counts = us * (kLocalHz / 1'000'000);
  static_cast<void>(wait_until([&] { return local_counts() - from > counts; }));
}

// RM0444: regulator, calibration, clocks between that and switching it on, then settings and channels.
bool start_converter() {
  enable_clock(rcc().APBENR2, Rcc::kAdc);
  Adc& a = adc();
  a.CR = Adc::kRegulator;
  wait_us(20);  // t_ADCVREG_STUP
  a.CFGR2 = Adc::kClockDividedBy4 | Adc::kOversample | Adc::k256Times | Adc::kShift4;
  a.CR = Adc::kRegulator | Adc::kCalibrate;
  if (!wait_until([&] { return (a.CR & Adc::kCalibrate) == 0; })) return false;
  wait_us(1);
  a.ISR = Adc::kReady;
  a.CR = Adc::kRegulator | Adc::kEnable;
  if (!wait_until([&] { return (a.ISR & Adc::kReady) != 0; })) return false;
  a.CFGR1 = Adc::kOverwrite | Adc::kContinuous;
  a.SMPR = Adc::kSample160;
  a.ISR = Adc::kChannelsTaken;
  a.CHSELR = bit(ebb::kThermistor);
  if (!wait_until([&] { return (a.ISR & Adc::kChannelsTaken) != 0; })) return false;
  a.CR = Adc::kRegulator | Adc::kEnable | Adc::kStart;
  return true;
}

}  // namespace

bool HeatPort::start() {
  start_servo();
  SpiPort<Spi2>::start();
  SpiPort<Spi1>::start();
  return started_ = start_converter();
}

std::optional<std::uint32_t> HeatPort::take_ratio(int) {
  if (!started_ || (adc().ISR & Adc::kEndOfConversion) == 0) return std::nullopt;
  const std::uint32_t sum = adc().DR;  // and the flag is gone
  return (sum << 16) / (kMost / 16);
}

}  // namespace kinebus::g0b1
