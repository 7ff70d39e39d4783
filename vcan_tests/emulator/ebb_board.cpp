#include "vcan_tests/emulator/ebb_board.hpp"

#include <algorithm>

#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "protocol/canopen/boards/heat.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kCrystalHz = 8'000'000;
// 64 MHz on the time base of all boards: 21 cycles are 8 clocks.
constexpr Cycle kClockCycles = 21, kClockParts = 8;
constexpr Rcc::Clock kSpi1Clock{0x40, 12}, kSpi2Clock{0x3C, 14};

}  // namespace

EbbBoard::EbbBoard(const ElfImage& image, const BoardOptions& options, std::uint32_t device_id)
    : Stm32g0b1Chip(image, options, kCrystalHz, device_id),
      spi1_(cpu_.nvic(), 25, kClockCycles, max31865_, true, kClockParts),
      spi2_(cpu_.nvic(), 26, kClockCycles, accelerometer_, true, kClockParts) {
  map(0x40013000, 0x400, spi1_, kSpi1Clock);
  map(0x40003800, 0x400, spi2_, kSpi2Clock);
  for (GpioPort& port : ports_) port.on_change = [this](Cycle at) { on_pins(at); };
  for (Timer* timer : {&tim16_, &tim17_}) timer->on_output = [this](Cycle at) { on_pins(at); };
  usart2_.on_output = [this](Cycle at) { look_at_wire(at); };
  driver_.on_step = [this](bool direction, Cycle at) { tmc_.on_step(direction, at); };
  // A divider to 3.3 V; without a sensor it is there.
  adc_.sample = [this](int channel, Cycle) {
    if (channel != ebb::kThermistor) return 0.0;
    return heated_.hot_end().part.max31865 ? 1.0 : heated_.hot_end().voltage();
  };
  constexpr double kNothing = 1e9;
  max31865_.ohm = [this] { return heated_.hot_end().part.max31865 ? heated_.hot_end().ohm() : kNothing; };
  max31865_.mode = [this] { return spi1_.mode(); };
  max31865_.clock_hz = [this] { return spi1_.clock_hz(); };
  heated_.set_contactor(true);  // there is none
  start();
}

EbbBoard::~EbbBoard() = default;

std::uint32_t EbbBoard::product_code() const {
  return Stm32g0b1EbbBoard::kFacts.product_code;
}

std::uint32_t EbbHeatBoard::product_code() const {
  return HeatBoard::kFacts.product_code;
}

bool EbbBoard::heater_on() const {
  return ports_[static_cast<std::size_t>(ebb::kHeater.port)].output_high(ebb::kHeater.number);
}

bool EbbBoard::fan_on(int fan) const {
  const stm32::OutputPin pin = ebb::kFans[static_cast<std::size_t>(fan)];
  return ports_[static_cast<std::size_t>(pin.port)].output_high(pin.number);
}

ServoPulses EbbBoard::servo() {
  constexpr int kServoPort = 1, kServoPin = 9, kTim17 = 2;
  return servo_pulses(tim17_, ports_[kServoPort], kServoPin, kTim17, true, cpu_.now());
}

double EbbBoard::true_counts(int axis) const {
  return axis == 0 ? tmc_.rotor_counts() + start_counts(0) : 0;
}

void EbbBoard::set_input(int input, bool level) {
  const stm32::SwitchPin pin = ebb::kSwitchPins[static_cast<std::size_t>(input)];
  ports_[static_cast<std::size_t>(pin.port)].drive(pin.line, level);
  exti_.on_level(static_cast<int>(pin.port), pin.line, level);
}

bool EbbBoard::anything_on() const {
  return std::ranges::any_of(ebb::kPowerPins, [&](const ebb::PowerPin& power) {
    const GpioPort& port = ports_[static_cast<std::size_t>(power.pin.port)];
    return port.mode(power.pin.number) == GpioPort::Mode::kOutput &&
           port.output_high(power.pin.number) != power.off;
  });
}

void EbbBoard::advance_devices(Cycle now) {
  spi1_.advance(now);
  spi2_.advance(now);
  heated_.advance(now);
  if (tmc_.next_event() <= now) tmc_.advance(now);
  look_at_wire(now);
}

// Open drain at both ends, and the chip's own resistor.
void EbbBoard::look_at_wire(Cycle now) {
  constexpr int kUsart2Function = 1;
  const stm32::OutputPin pin = ebb::kDriverWire;
  GpioPort& port = ports_[static_cast<std::size_t>(pin.port)];
  const bool usart = port.mode(pin.number) == GpioPort::Mode::kAlternate &&
                     port.alternate(pin.number) == kUsart2Function && usart2_.one_wire_at_rx();
  const bool output = port.mode(pin.number) == GpioPort::Mode::kOutput;
  const bool low = (usart && usart2_.drives_low()) || (output && !port.output_high(pin.number));
  const bool forced = !low && !port.open_drain(pin.number) && ((usart && usart2_.drives()) || output);
  if (!wire_.look(low || tmc_.pulls_low(), forced, port.pulled_up(pin.number), now)) return;
  port.drive(pin.number, wire_.high());
  if (usart) usart2_.on_wire(wire_.high(), now);
  tmc_.on_wire(wire_.high(), now);
}

void EbbBoard::reset_devices(Cycle now) {
  spi1_.reset();
  spi2_.reset();
  on_pins(now);
}

void EbbBoard::on_pins(Cycle now) {
  const auto high = [&](const stm32::OutputPin& pin) {
    return ports_[static_cast<std::size_t>(pin.port)].output_high(pin.number);
  };
  // PD0 is TIM16's channel 1, PD1 TIM17's, both by function 2.
  const auto timed = [&](const stm32::OutputPin& pin, const Timer& timer) {
    constexpr int kTimers = 2;
    const GpioPort& port = ports_[static_cast<std::size_t>(pin.port)];
    const bool alternate = port.mode(pin.number) == GpioPort::Mode::kAlternate;
    return alternate ? port.alternate(pin.number) == kTimers && timer.output_high() : high(pin);
  };
  // A pin that nobody drives leaves the driver disabled: pulled up on the board.
  const GpioPort& port = ports_[static_cast<std::size_t>(ebb::kEnable.port)];
  const bool enabled = port.mode(ebb::kEnable.number) == GpioPort::Mode::kOutput && !high(ebb::kEnable);
  const auto selects = [&](const stm32::OutputPin& pin) {
    return ports_[static_cast<std::size_t>(pin.port)].mode(pin.number) == GpioPort::Mode::kOutput &&
           !high(pin);
  };
  accelerometer_.select(selects(ebb::kAccelerometer), now);
  // SPI1 is PA5 to PA7's function 0.
  const GpioPort& port_a = ports_[0];
  const auto of_spi1 = [&](int pin) {
    return port_a.mode(pin) == GpioPort::Mode::kAlternate && port_a.alternate(pin) == 0;
  };
  const bool wired = of_spi1(5) && of_spi1(6) && of_spi1(7);
  max31865_.select(wired && selects(ebb::kResistanceConverter), now);
  // A MOSFET with a pull-down: a pin that nobody drives is off.
  heated_.set_power(high(ebb::kHeater), false, now);
  tmc_.on_enable(enabled);
  look_at_wire(now);
  driver_.on_pins(timed(ebb::kStep, tim16_), timed(ebb::kDirection, tim17_), enabled, now);
}

}  // namespace kinebus::emulator
