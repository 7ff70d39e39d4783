#include "node_firmware/port/stm32f405/power_stage.hpp"

#include "node_firmware/board/thermistor.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {
namespace {

Timer& timer(int axis) {
  return axis == 0 ? tim1() : tim8();
}
Spi& spi(int axis) {
  return axis == 0 ? spi1() : spi3();
}

constexpr Thermistor kThermistor{static_cast<double>(board::kNtcBeta)};

// BKE, active low; the outputs float when the break comes (OSSI 0), by hardware alone.
constexpr std::uint32_t kBreakSetting = Timer::kBreakEnable;

// No voltage across a winding. In force from the next update on.
void rest_at_half(Timer& t) {
  for (Reg& compare : t.CCR) compare = board::kPwmTop / 2;
}

void start_timer(Timer& t) {
  t.PSC = 0;
  t.ARR = board::kPwmTop;
  t.RCR = board::kPwmRepetition;
  rest_at_half(t);
  t.CCMR1 = Timer::kPwm1Preload;
  t.CCMR2 = Timer::kPwm1Preload;
  t.CCER = Timer::kAllOutputs;
  t.BDTR = kBreakSetting;
  t.CR1 = Timer::kCentreAligned1 | Timer::kAutoReloadPreload;
  t.EGR = Timer::kGenerateUpdate;
  t.SR = 0;
  t.DIER = Timer::kBreakInterrupt;
}

void start_converters() {
  // Sampling 15 cycles for the currents (0.7 us), 144 for the slow channels.
  for (const int n : {1, 2}) {
    Adc& a = adc(n);
    a.SMPR2 = 0x0000'0249;  // channels 0 to 3
    const auto& channel = n == 1 ? board::kPhaseAChannel : board::kPhaseBChannel;
    // Two conversions: they are written in the places 3 and 4 of the four.
    a.JSQR = 1u << 20 | static_cast<std::uint32_t>(channel[0]) << 10 |
             static_cast<std::uint32_t>(channel[1]) << 15;
    a.CR1 = Adc::kScan | (n == 1 ? Adc::kInjectedInterrupt : 0);
  }
  adc(3).SMPR1 = 0x0000'01B6;  // channels 10 to 12: 144 cycles each
  adc_common().CCR = AdcCommon::kInjectedSimultaneous | AdcCommon::kPrescaler4;
  adc(1).CR2 = Adc::kOn | Adc::kInjectedByTim1Update | Adc::kInjectedRisingEdge;
  adc(2).CR2 = Adc::kOn;
  adc(3).CR2 = Adc::kOn;
}

void start_encoder(int axis) {
  constexpr std::uint32_t kSetting =
      Spi::kSecondEdge | Spi::kMaster | Spi::kInternalSelect | Spi::kSoftwareSelect | Spi::kFrame16;
  // 84 MHz / 16, 42 MHz / 8: 5.25 MHz.
  spi(axis).CR1 = kSetting | Spi::divide(axis == 0 ? 4 : 3) | Spi::kEnable;
}

}  // namespace

void PowerStage::start() {
  debug_control() = debug_control() | bit(24);
  dwt().CTRL = dwt().CTRL | bit(0);
  enable_clock(rcc().APB2ENR, Rcc::kTim1 | Rcc::kTim8 | Rcc::kAdc1 | Rcc::kAdc2 | Rcc::kAdc3 | Rcc::kSpi1);
  enable_clock(rcc().APB1ENR, Rcc::kSpi3);
  start_converters();
  for (int axis = 0; axis < 2; ++axis) start_encoder(axis);
  start_timer(tim1());
  start_timer(tim8());
  tim1().CR2 = Timer::kMasterUpdate;
  for (int axis = 0; axis < 2; ++axis) begin_encoder(axis);
  adc(3).SQR3 = board::kSlowChannels[slow_];
  adc(3).CR2 = adc(3).CR2 | Adc::kSoftwareStart;
  enable_interrupt(Irq::kTim1Break, 1);
  enable_interrupt(Irq::kTim8Break, 1);
  enable_interrupt(Irq::kAdc, 3);
  // Motor B's timer lags by one conversion.
  tim1().CNT = board::kMotorBLag;
  tim8().CNT = 0;
  tim1().CR1 = tim1().CR1 | Timer::kEnable;
  tim8().CR1 = tim8().CR1 | Timer::kEnable;
}

std::array<std::uint32_t, 2> PowerStage::raw(int axis) {
  return {adc(1).JDR[axis], adc(2).JDR[axis]};
}

motor::Vector PowerStage::currents(int axis) const {
  const auto [a, b] = raw(axis);
  const motor::Vector& zero = zero_[static_cast<std::size_t>(axis)];
  return {(static_cast<float>(a) - zero.x) * board::kAmperesPerStep,
          (static_cast<float>(b) - zero.y) * board::kAmperesPerStep};
}

void PowerStage::on_break(int axis) {
  write(board::kDriverEnable[static_cast<std::size_t>(axis)], false);
  // The flag stays set, and the interrupt pending, as long as the input is active: the next power-on asks
  // again.
  timer(axis).DIER = 0;
  timer(axis).SR = ~Timer::kBreakFlag;
  on_[static_cast<std::size_t>(axis)].store(false, std::memory_order_relaxed);
  broken_[static_cast<std::size_t>(axis)].store(true, std::memory_order_relaxed);
}

void PowerStage::apply(int axis, const motor::AxisOutputs& outputs) {
  const auto i = static_cast<std::size_t>(axis);
  Timer& t = timer(axis);
  if (!outputs.power) {
    // The period in which power comes begins with these, not with the duty of before.
    rest_at_half(t);
    if (on_[i].load(std::memory_order_relaxed)) {
      t.BDTR = kBreakSetting;
      write(board::kDriverEnable[i], false);
      on_[i].store(false, std::memory_order_relaxed);
    }
    return;
  }
  constexpr float kHalf = static_cast<float>(board::kPwmTop) / 2;
  const float a = outputs.duty.x * kHalf, b = outputs.duty.y * kHalf;
  t.CCR[0] = static_cast<std::uint32_t>(kHalf + a + 0.5F);
  t.CCR[1] = static_cast<std::uint32_t>(kHalf - a + 0.5F);
  t.CCR[2] = static_cast<std::uint32_t>(kHalf + b + 0.5F);
  t.CCR[3] = static_cast<std::uint32_t>(kHalf - b + 0.5F);
  if (on_[i].load(std::memory_order_relaxed)) return;
  // A break interrupt comes before this or after: one that came since take_break() is not undone here.
  disable_interrupts();
  if (!broken_[i].load(std::memory_order_relaxed)) {
    // A break of before is over when the input says so; MOE cannot be set while it is active.
    t.SR = ~Timer::kBreakFlag;
    t.DIER = Timer::kBreakInterrupt;
    t.BDTR = kBreakSetting | Timer::kMainOutput;
    write(board::kDriverEnable[i], true);
    on_[i].store(true, std::memory_order_relaxed);
  }
  enable_interrupts();
}

void PowerStage::serve_slow() {
  if ((adc(3).SR & Adc::kEndOfConversion) == 0) return;
  const std::uint32_t steps = adc(3).DR;
  if (slow_ == 0)
    readings_.supply_v = static_cast<float>(steps) * board::kSupplyVoltsPerStep;
  else
    readings_.temperature_c[slow_ - 1] = kThermistor.celsius(steps);
  // The supply is what a dip shows in: every other conversion is of it.
  static constexpr std::array<std::size_t, 4> kOrder{0, 1, 0, 2};
  turn_ = (turn_ + 1) % kOrder.size();
  slow_ = kOrder[turn_];
  adc(3).SQR3 = board::kSlowChannels[slow_];
  adc(3).CR2 = adc(3).CR2 | Adc::kSoftwareStart;
}

std::uint16_t PowerStage::take_encoder(int axis) {
  if (lent_[static_cast<std::size_t>(axis)].load(std::memory_order_relaxed)) return 0xFFFF;
  Spi& s = spi(axis);
  const board::OutputPin select = board::kEncoderSelect[static_cast<std::size_t>(axis)];
  const bool answered = (s.SR & Spi::kReceived) != 0;
  const auto answer = static_cast<std::uint16_t>(s.DR);
  write(select, true);
  return answered ? answer : std::uint16_t{0xFFFF};
}

void PowerStage::begin_encoder(int axis) {
  if (lent_[static_cast<std::size_t>(axis)].load(std::memory_order_relaxed)) return;
  write(board::kEncoderSelect[static_cast<std::size_t>(axis)], false);
  spi(axis).DR = motor::kReadAngle;
}

void PowerStage::lend_encoder_port(int axis) {
  lent_[static_cast<std::size_t>(axis)].store(true, std::memory_order_relaxed);
  // The control interrupt's last frame takes 3 us.
  for (int i = 0; i < 10'000 && (spi(axis).SR & Spi::kBusy) != 0; ++i) {
  }
  write(board::kEncoderSelect[static_cast<std::size_t>(axis)], true);
  spi(axis).CR1 = 0;
}

void PowerStage::return_encoder_port(int axis) {
  spi(axis).CR1 = 0;
  start_encoder(axis);
  static_cast<void>(spi(axis).DR);
  lent_[static_cast<std::size_t>(axis)].store(false, std::memory_order_relaxed);
}

}  // namespace kinebus::stm32
