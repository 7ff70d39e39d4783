#include "vcan_tests/emulator/board.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>

#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kPeripherals = 0x40000000;
// ADC1, ADC2, ADC3 and what they share, 100h each: clocks in this order.
constexpr std::uint32_t kAdcs = 0x40012000, kAdcBytes = 0x100;
constexpr double kCountsPerTurn = 51200;
constexpr std::uint32_t kUniqueIdOffset = 0x7A10 - 0x7800;

double turns_of(double counts) {
  return counts / kCountsPerTurn;
}

}  // namespace

Board::Board(const ElfImage& image, const BoardOptions& options)
    : image_(image),
      options_(options),
      cpu_(*this),
      flash_(cpu_.flash().first(CortexM4::kFlashSize)),
      exti_(cpu_.nvic()),
      sysconfig_(exti_),
      tim1_(cpu_.nvic(), {.update_irq = 25, .break_irq = 24}),
      tim8_(cpu_.nvic(), {.update_irq = 44, .break_irq = 43}),
      tim2_(cpu_.nvic(), {.update_irq = 28, .cycles_per_tick = 2, .advanced = false}),
      adc_(cpu_.nvic()),
      spi1_(cpu_.nvic(), 35, kApb2Divider, encoders_[0]),
      spi3_(cpu_.nvic(), 51, kApb1Divider, encoders_[1]),
      can_(cpu_.nvic()),
      usart_(cpu_.nvic(), 37, kApb2Divider),
      usb_(cpu_.nvic()),
      motors_{StepperMotor(options.motors[0]), StepperMotor(options.motors[1])},
      temperature_c_{options.temperature_c, options.temperature_c} {
  const auto ahb1 = [](int bit) { return Rcc::Clock{0x30, bit}; };
  const auto apb1 = [](int bit) { return Rcc::Clock{0x40, bit}; };
  const auto apb2 = [](int bit) { return Rcc::Clock{0x44, bit}; };
  map(0x40000000, 0x400, tim2_, apb1(0));
  map(0x40003000, 0x400, watchdog_);
  map(0x40003C00, 0x400, spi3_, apb1(15));
  map(0x40006400, 0x400, can_, apb1(25));
  map(0x40007000, 0x400, power_control_, apb1(28));
  map(0x40010000, 0x400, tim1_, apb2(0));
  map(0x40010400, 0x400, tim8_, apb2(1));
  map(0x40011000, 0x400, usart_, apb2(4));
  map(kAdcs, 0x400, adc_, apb2(8));
  map(0x40013000, 0x400, spi1_, apb2(12));
  map(0x40013800, 0x400, sysconfig_, apb2(14));
  map(0x40013C00, 0x400, exti_);
  for (std::uint32_t port = 0; port < ports_.size(); ++port)
    map(0x40020000 + 0x400 * port, 0x400, ports_[port], ahb1(static_cast<int>(port)));
  map(0x40023800, 0x400, rcc_);
  map(0x40023C00, 0x400, flash_);
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
  tim1_.on_trigger = [this](Cycle at) { adc_.on_trigger(1, at); };
  adc_.sample = [this](int channel, Cycle at) { return analogue(channel, at); };
  for (GpioPort& port : ports_) port.on_change = [this](Cycle at) { on_pins(at); };

  std::memcpy(cpu_.system_memory().data() + kUniqueIdOffset, options.unique_id.data(),
              sizeof options.unique_id);
  cpu_.load(image);
  // A boot loader begins at the start of flash; without one the program begins by itself.
  boot_ = cpu_.peek(CortexM4::kFlash) != 0xFFFFFFFF ? CortexM4::kFlash : board::kProgramAddress;
  power_cycle();
  resets_ = 0;
}

Board::~Board() = default;

void Board::map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
                std::optional<Rcc::Clock> clock) {
  for (std::uint32_t at = base; at < base + size; at += 0x400)
    places_[(at - kPeripherals) / 0x400] = {&peripheral, base, clock};
}

// As on the chip: without its clock a peripheral takes nothing and says 0.
bool Board::reached(const Place& place, std::uint32_t address, Cycle now) {
  if (place.peripheral == nullptr) return false;
  if (!place.clock) return true;
  Rcc::Clock clock = *place.clock;
  if (place.base == kAdcs && address < kAdcs + 3 * kAdcBytes)
    clock.bit += static_cast<int>((address - kAdcs) / kAdcBytes);
  if (rcc_.live(clock, now)) return true;
  if (lost_.size() < 100) lost_.push_back(address);
  return false;
}

void Board::power_cycle() {
  std::ranges::fill(cpu_.sram(), std::uint8_t{0xA5});
  reset(Rcc::ResetCause::kPowerOn);
}

void Board::reset(Rcc::ResetCause cause) {
  const Cycle now = cpu_.now();
  ++resets_;
  rcc_.reset(cause);
  power_control_.reset();
  flash_.reset();
  for (GpioPort& port : ports_) port.reset();
  exti_.reset();
  tim1_.reset(now);
  tim8_.reset(now);
  tim2_.reset(now);
  adc_.reset();
  spi1_.reset();
  spi3_.reset();
  can_.reset();
  usart_.reset();
  watchdog_.reset();
  usb_.reset();
  on_pins(now);
  cpu_.reset(boot_);
  schedule();
}

void Board::run(Cycle limit) {
  schedule();
  while (cpu_.now() < limit) {
    cpu_.run(limit);
    if (watchdog_.expired(cpu_.now())) {
      ++watchdog_resets_;
      reset(Rcc::ResetCause::kWatchdog);
    } else if (cpu_.nvic().take_reset_request()) {
      reset(Rcc::ResetCause::kSoftware);
    }
  }
  for (const auto& stage : stages_) stage->advance(cpu_.now());
}

void Board::advance(Cycle now) {
  if (cpu_.nvic().reset_requested()) cpu_.stop();
  if (now < next_event_) return;
  while (!incoming_.empty() && incoming_.front().at <= now) {
    const Incoming in = incoming_.front();
    incoming_.pop_front();
    if (in.sent_mailbox >= 0)
      can_.on_sent(in.sent_mailbox);
    else
      can_.on_frame(in.frame, now);
  }
  tim1_.advance(now);
  tim8_.advance(now);
  tim2_.advance(now);
  adc_.advance(now);
  spi1_.advance(now);
  spi3_.advance(now);
  can_.advance(now);
  usart_.advance(now);
  if (watchdog_.expired(now)) cpu_.stop();
  look_at_switches(now);
  schedule();
}

void Board::schedule() {
  next_event_ = std::min({tim1_.next_event(), tim8_.next_event(), tim2_.next_event(), adc_.next_event(),
                          spi1_.next_event(), spi3_.next_event(), can_.next_event(), usart_.next_event(),
                          watchdog_.next_event(), incoming_.empty() ? kNever : incoming_.front().at});
}

Board::Place Board::find(std::uint32_t address) {
  const std::uint32_t page = (address - kPeripherals) / 0x400;
  if (page < places_.size() && places_[page].peripheral != nullptr) return places_[page];
  if (strange_.size() < 100) strange_.push_back(address);
  return {};
}

std::uint32_t Board::read(std::uint32_t address, int size, Cycle now) {
  const Place place = find(address);
  if (!reached(place, address, now)) return 0;
  const std::uint32_t word = place.peripheral->read((address - place.base) & ~3u, now) >> (8 * (address & 3));
  return size == 4 ? word : word & ((1u << (8 * size)) - 1);
}

void Board::write(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  const Place place = find(address);
  if (!reached(place, address, now)) return;
  const std::uint32_t kept = size == 4 ? value : value & ((1u << (8 * size)) - 1);
  place.peripheral->write((address - place.base) & ~3u, kept << (8 * (address & 3)), now);
  if (place.peripheral == &flash_ && flash_.take_erased()) {
    cpu_.forget_code();
    cpu_.stall_until(flash_.busy_until());
  }
  schedule();
}

bool Board::write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  const bool changed = flash_.program(address, value, size, now);
  if (changed) cpu_.stall_until(flash_.busy_until());
  return changed;
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

void Board::drive_input(int input, bool level) {
  const board::SwitchPin pin = board::kSwitchPins[static_cast<std::size_t>(input)];
  ports_[static_cast<std::size_t>(pin.port)].drive(pin.line, level);
  exti_.on_level(static_cast<int>(pin.port), pin.line, level);
}

void Board::set_input(int input, bool level) {
  drive_input(input, level);
}

void Board::look_at_switches(Cycle) {
  for (std::size_t a = 0; a < 2; ++a) {
    const VirtualAxis& axis = options_.axes[a];
    if (axis.switch_input == 0) continue;
    const double above = true_counts(static_cast<int>(a)) - axis.switch_counts;
    const bool active = axis.active_above ? above >= 0 : above <= 0;
    const int level = active != axis.active_low ? 1 : 0;
    if (level == switch_level_[a]) continue;
    switch_level_[a] = level;
    drive_input(axis.switch_input - 1, level == 1);
  }
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

void Board::set_chip_supply(double volts) {
  power_control_.set_supply(volts);
  exti_.on_inner_level(PowerControl::kDetectorLine, power_control_.supply_low());
  if (volts < flash_.brown_out_volts()) reset(Rcc::ResetCause::kBrownOut);
}

void Board::set_crystal(bool swings) {
  if (rcc_.set_crystal(swings)) cpu_.nvic().pend(kNmi);
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
