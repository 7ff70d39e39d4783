#include "vcan_tests/emulator/board.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "node_firmware/port/stm32f405/board.hpp"
#include "protocol/canopen/object_addresses.hpp"

namespace kinebus::emulator {
namespace {

constexpr double kCountsPerTurn = 51200;

double turns_of(double counts) {
  return counts / kCountsPerTurn;
}

}  // namespace

Board::Board(const ElfImage& image, const BoardOptions& options)
    : Stm32f4Chip(image, options,
                  {.device_id = 0x1007'0413,
                   .flash_bytes = CortexM4::kFlashSize,
                   .core_coupled_memory = true,
                   .clocks = {.crystal_hz = board::kCrystalHz},
                   .ports = 4,
                   .program = board::kProgramAddress}),
      tim1_(cpu_.nvic(), {.update_irq = 25, .break_irq = 24}),
      tim8_(cpu_.nvic(), {.update_irq = 44, .break_irq = 43}),
      adc_(cpu_.nvic()),
      absolute_scales_{
          SsiScale(options.absolute_scales[0], [this](Cycle at) { return absolute_position(0, at); }),
          SsiScale(options.absolute_scales[1], [this](Cycle at) { return absolute_position(1, at); })},
      spi1_(cpu_.nvic(), 35, kApb2Divider, on_encoder_port(0)),
      spi3_(cpu_.nvic(), 51, kApb1Divider, on_encoder_port(1)),
      usart_(cpu_.nvic(), 37, kApb2Divider),
      usb_(cpu_.nvic()),
      motors_{StepperMotor(options.motors[0]), StepperMotor(options.motors[1])},
      temperature_c_{options.temperature_c, options.temperature_c} {
  absolute_scales_[0].on_clock(spi1_);
  absolute_scales_[1].on_clock(spi3_);
  map(0x40000400, 0x400, scales_[0], apb1(1));
  map(0x40000800, 0x400, scales_[1], apb1(2));
  map(0x40003C00, 0x400, spi3_, apb1(15));
  map(0x40010000, 0x400, tim1_, apb2(0));
  map(0x40010400, 0x400, tim8_, apb2(1));
  map(0x40011000, 0x400, usart_, apb2(4));
  map(AdcBlock::kAddress, 0x400, adc_, apb2(8));
  map(0x40013000, 0x400, spi1_, apb2(12));
  map(0x40040000, 0x40000, usb_, ahb1(29));

  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    motors_[a].place(2 * std::numbers::pi * turns_of(options.axes[a].start_counts));
    stages_[a] = std::make_unique<PowerStage>(pwm(axis), motors_[a], options.stage);
    stages_[a]->set_supply(options.supply_v, 0);
    PowerStage* stage = stages_[a].get();
    Timer* timer = &pwm(axis);
    timer->before_change = [stage](Cycle at) { stage->advance(at); };
    stage->on_comparator = [timer](bool high, Cycle at) { timer->set_break_level(high, at); };
    encoders_[a].turns = [this, a, stage](Cycle at) {
      stage->advance(at);
      return motors_[a].angle_rad() / (2 * std::numbers::pi) + options_.encoder_offset_turns[a];
    };
  }
  for (std::size_t a = 0; a < scales_.size(); ++a) {
    const board::ScalePins& pins = board::kScalePins[a];
    scales_[a].wired = [this, pins] {
      const GpioPort& port = ports_[static_cast<std::size_t>(pins.port)];
      return std::ranges::all_of(std::array{pins.first, pins.second}, [&](int pin) {
        return port.mode(pin) == GpioPort::Mode::kAlternate && port.alternate(pin) == pins.timer;
      });
    };
    if (!options.axes[a].scale || options.absolute_scales[a].bits != 0) continue;
    scales_[a].scale = [this, a](Cycle at) {
      stages_[a]->advance(at);
      return options_.axes[a].scale(true_counts(static_cast<int>(a)));
    };
  }
  tim1_.on_trigger = [this](Cycle at) { adc_.on_trigger(1, at); };
  adc_.sample = [this](int channel, Cycle at) { return analogue(channel, at); };
  for (GpioPort& port : ports_) port.on_change = [this](Cycle at) { on_pins(at); };
  start();
}

Board::~Board() = default;

SpiDevice& Board::on_encoder_port(std::size_t axis) {
  if (options_.absolute_scales[axis].bits != 0) return absolute_scales_[axis];
  return encoders_[axis];
}

std::uint32_t Board::absolute_position(std::size_t axis, Cycle at) {
  // Its zero lies within the travel: beyond it is the highest number.
  constexpr std::int32_t kWhere = 100;
  stages_[axis]->advance(at);
  return static_cast<std::uint32_t>(kWhere + options_.axes[axis].scale(true_counts(static_cast<int>(axis))));
}

std::uint32_t Board::product_code() const {
  return kProductCode;
}

int Board::clock_offset(std::uint32_t base, std::uint32_t address) const {
  return base == AdcBlock::kAddress ? AdcBlock::clock_offset(address) : 0;
}

void Board::reset_devices(Cycle now) {
  tim1_.reset(now);
  tim8_.reset(now);
  for (QuadratureCounter& scale : scales_) scale.reset();
  adc_.reset();
  spi1_.reset();
  spi3_.reset();
  usart_.reset();
  usb_.reset();
  on_pins(now);
}

void Board::advance_devices(Cycle now) {
  tim1_.advance(now);
  tim8_.advance(now);
  adc_.advance(now);
  spi1_.advance(now);
  spi3_.advance(now);
  usart_.advance(now);
}

Cycle Board::next_of_devices() const {
  return std::min({tim1_.next_event(), tim8_.next_event(), adc_.next_event(), spi1_.next_event(),
                   spi3_.next_event(), usart_.next_event()});
}

void Board::after_run() {
  for (const auto& stage : stages_) stage->advance(cpu_.now());
}

void Board::on_pins(Cycle now) {
  for (int axis = 0; axis < 2; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const board::OutputPin enable = board::kDriverEnable[a], select = board::kEncoderSelect[a];
    if (stages_[a])
      stages_[a]->set_enabled(ports_[static_cast<std::size_t>(enable.port)].output_high(enable.number), now);
    const GpioPort& port = ports_[static_cast<std::size_t>(select.port)];
    encoders_[a].select(
        port.mode(select.number) == GpioPort::Mode::kOutput && !port.output_high(select.number), now);
  }
}

double Board::true_counts(int axis) const {
  return motors_[static_cast<std::size_t>(axis)].angle_rad() / (2 * std::numbers::pi) * kCountsPerTurn;
}

void Board::set_input(int input, bool level) {
  const board::SwitchPin pin = board::kSwitchPins[static_cast<std::size_t>(input)];
  ports_[static_cast<std::size_t>(pin.port)].drive(pin.line, level);
  exti_.on_level(static_cast<int>(pin.port), pin.line, level);
}

void Board::set_usb_cable(bool plugged) {
  ports_[static_cast<std::size_t>(board::kUsbVbus.port)].drive(board::kUsbVbus.number, plugged);
}

bool Board::usb_device_seen() {
  constexpr std::uint32_t kAhb1Enable = 0x30, kAhb1EnableInSleep = 0x50;
  constexpr int kUsb = 29, kExternalPhy = 30, kUsbFunction = 12;
  const GpioPort& b = ports_[1];
  const bool pins = b.mode(14) == GpioPort::Mode::kAlternate && b.alternate(14) == kUsbFunction &&
                    b.mode(15) == GpioPort::Mode::kAlternate && b.alternate(15) == kUsbFunction;
  const bool clocks = rcc_.clock_enabled(kAhb1Enable, kUsb) && rcc_.clock_enabled(kAhb1EnableInSleep, kUsb) &&
                      !rcc_.clock_enabled(kAhb1EnableInSleep, kExternalPhy) && rcc_.usb_hz() == 48'000'000u;
  return pins && clocks && b.level(board::kUsbVbus.number) && usb_.pulled_up(cpu_.now());
}

bool Board::system_boot_selected() const {
  return ports_[static_cast<std::size_t>(board::kSystemBoot.port)].output_high(board::kSystemBoot.number);
}

bool Board::led_lit() const {
  const GpioPort& port = ports_[static_cast<std::size_t>(board::kStatusLed.port)];
  return port.mode(board::kStatusLed.number) == GpioPort::Mode::kOutput &&
         !port.output_high(board::kStatusLed.number);
}

void Board::set_supply(double volts) {
  for (const auto& stage : stages_) stage->set_supply(volts, cpu_.now());
}

double Board::analogue(int channel, Cycle at) {
  const auto current = [&](std::size_t motor, int phase) {
    stages_[motor]->advance(at);
    const double volts =
        stages_[motor]->current_a(phase) * static_cast<double>(board::kCurrentVoltsPerAmpere);
    return volts / static_cast<double>(board::kReferenceV) + 0.5;
  };
  const auto temperature = [&](std::size_t motor) {
    // NTC to ground, 10 kOhm at 25 C, under 10 kOhm.
    const double kelvin = temperature_c_[motor] + 273.15;
    const double ratio = std::exp(static_cast<double>(board::kNtcBeta) * (1 / kelvin - 1 / 298.15));
    return ratio / (1 + ratio);
  };
  switch (channel) {
    case 0:
      return current(0, 0);
    case 1:
      return current(0, 1);
    case 2:
      return current(1, 0);
    case 3:
      return current(1, 1);
    case 10:
      return stages_[0]->supply_v() / static_cast<double>(board::kSupplyDivider * board::kReferenceV);
    case 11:
      return temperature(0);
    case 12:
      return temperature(1);
    default:
      return 0;
  }
}

}  // namespace kinebus::emulator
