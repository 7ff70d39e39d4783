#include "vcan_tests/emulator/octopus_board.hpp"

#include <algorithm>

#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace kinebus::emulator {
namespace {

// The maker's boot loader, where the start of flash is left to it, starts what comes first behind it.
std::uint32_t first_address(const ElfImage& image) {
  return std::ranges::min(image.pieces, {}, &ElfImage::Piece::address).address;
}

ChipFacts facts(const ElfImage& image, std::uint32_t device_id) {
  return {.device_id = device_id,
          .flash_bytes = 512 * 1024,
          .core_coupled_memory = false,
          .clocks = {.crystal_hz = octopus::kCrystals[0], .pll_r = true},
          .ports = 8,
          .axes = octopus::kDrivers.size(),
          .program = first_address(image)};
}

}  // namespace

void StepDriver::on_pins(bool step, bool direction, bool enabled, Cycle now) {
  enabled_ = enabled;
  if (direction != direction_) {
    if (stepped_) shortest_.hold = std::min(shortest_.hold, now - rose_);
    turned_ = now;
    direction_ = direction;
  }
  if (step == step_) return;
  step_ = step;
  if (!step) {
    shortest_.high = std::min(shortest_.high, now - rose_);
    fell_ = now;
    return;
  }
  if (stepped_) shortest_.low = std::min(shortest_.low, now - fell_);
  shortest_.set_up = std::min(shortest_.set_up, now - turned_);
  rose_ = now;
  stepped_ = true;
  if (!enabled) {
    ++while_disabled_;
    return;
  }
  steps_ += direction ? 1 : -1;
  if (on_step) on_step(direction, now);
  edges_.push_back({now, steps_, direction});
}

OctopusBoard::OctopusBoard(const ElfImage& image, const BoardOptions& options)
    : OctopusBoard(image, options, kF446) {}

OctopusBoard::OctopusBoard(const ElfImage& image, const BoardOptions& options, std::uint32_t device_id)
    : Stm32f4Chip(image, options, facts(image, device_id)),
      tim1_(cpu_.nvic(), {.update_irq = 25, .break_irq = 24}),
      tim4_(cpu_.nvic(), {.cycles_per_tick = 2, .advanced = false}),
      tim8_(cpu_.nvic(), {.update_irq = 44, .break_irq = 43}),
      dma2_(cpu_.nvic(), {56, 57, 58, 59, 60, 68, 69, 70}),
      adc_(cpu_.nvic()),
      makers_loader_(first_address(image) != CortexM4::kFlash),
      usb_(cpu_.nvic(), {.irq = 67, .memory_words = 320, .endpoints = 6, .later_core = true}),
      spi1_(cpu_.nvic(), 35, 2, spi_bus_) {
  map(0x40013000, 0x400, spi1_, apb2(12));
  map(0x50000000, 0x40000, usb_, ahb2(7));
  map(0x40000800, 0x400, tim4_, apb1(2));
  map(0x40010000, 0x400, tim1_, apb2(0));
  map(0x40010400, 0x400, tim8_, apb2(1));
  map(AdcBlock::kAddress, 0x400, adc_, apb2(8));
  map(0x40026400, 0x400, dma2_, ahb1(22));
  // Nothing is connected: the inputs are pulled up.
  for (const stm32::SwitchPin& pin : octopus::kSwitchPins)
    exti_.on_level(static_cast<int>(pin.port), pin.line, true);
  dma2_.fetch = [this](std::uint32_t address) { return cpu_.peek(address); };
  dma2_.put = [this](std::uint32_t address, std::uint32_t word, Cycle at) { write(address, word, 4, at); };
  dma2_.take = [this](std::uint32_t address, Cycle at) { return read(address, 4, at); };
  dma2_.keep = [this](std::uint32_t address, std::uint32_t half) {
    const unsigned shift = (address & 2) * 8;
    const std::uint32_t word = cpu_.peek(address & ~3u);
    cpu_.poke(address & ~3u, (word & ~(0xFFFFu << shift)) | half << shift);
  };
  // ADC3 is channel 2 of stream 0.
  adc_.on_request = [this](int converter, Cycle at) {
    if (converter == 3) dma2_.on_request(0, 2, at);
  };
  adc_.sample = [this](int channel, Cycle) { return analogue(channel); };
  // RM0390, DMA2 request mapping, channel 6: TIM1_UP is stream 5, CH1 streams 1 and 3, CH2 2, CH3 6, CH4 4. A
  // request that two streams wait for is answered by the first of them.
  tim1_.on_request = [this](int event, Cycle at) {
    constexpr std::array kStreams{5, 1, 2, 6, 4};
    dma2_.on_request(kStreams[static_cast<std::size_t>(event)], 6, at);
  };
  // Channel 7: TIM8_UP is stream 1, CH1 2, CH2 3, CH3 4, CH4 7.
  tim8_.on_request = [this](int event, Cycle at) {
    constexpr std::array kStreams{1, 2, 3, 4, 7};
    dma2_.on_request(kStreams[static_cast<std::size_t>(event)], 7, at);
  };
  for (std::size_t axis = 0; axis < drivers_.size(); ++axis)
    drivers_[axis].on_step = [this, axis](bool direction, Cycle at) { socket(axis).on_step(direction, at); };
  spi_bus_.clock = [this] { return TmcSpiChip::Clock{spi1_.mode(), spi1_.clock_hz()}; };
  spi_bus_.connected = [this] {
    constexpr int kSpi1Function = 5;
    return std::ranges::all_of(std::array{5, 6, 7}, [this](int pin) {
      return ports_[0].mode(pin) == GpioPort::Mode::kAlternate && ports_[0].alternate(pin) == kSpi1Function;
    });
  };
  for (GpioPort& port : ports_) port.on_change = [this](Cycle at) { on_pins(at); };
  start();
}

OctopusBoard::~OctopusBoard() = default;

std::uint32_t OctopusBoard::product_code() const {
  return Stm32f446OctopusBoard::kFacts.product_code;
}

std::uint16_t DriverSpiBus::exchange(std::uint16_t sent, Cycle now) {
  std::uint8_t answer = 0xFF;
  int driving = 0;
  for (std::optional<TmcSpiChip>& chip : chips_) {
    if (!chip || !chip->drives_line() || !connected()) continue;
    answer &= chip->exchange(static_cast<std::uint8_t>(sent), clock(), now);
    ++driving;
  }
  if (driving > 1) ++fights_;
  return driving == 0 ? floating : answer;
}

void OctopusBoard::plug(int axis, const SpiDriverParameters& parameters) {
  const auto i = static_cast<std::size_t>(axis);
  chips_[i].set_supply(false);
  spi_chips_[i].emplace(parameters);
}

SocketedDriver& OctopusBoard::socket(std::size_t axis) {
  if (spi_chips_[axis]) return *spi_chips_[axis];
  return chips_[axis];
}
const SocketedDriver& OctopusBoard::socket(std::size_t axis) const {
  if (spi_chips_[axis]) return *spi_chips_[axis];
  return chips_[axis];
}

double OctopusBoard::true_counts(int axis) const {
  return socket(static_cast<std::size_t>(axis)).rotor_counts() + start_counts(axis);
}

void OctopusBoard::set_input(int input, bool level) {
  const stm32::SwitchPin pin = octopus::kSwitchPins[static_cast<std::size_t>(input)];
  ports_[static_cast<std::size_t>(pin.port)].drive(pin.line, level);
  exti_.on_level(static_cast<int>(pin.port), pin.line, level);
}

bool OctopusBoard::heater_on(int heater) const {
  const stm32::OutputPin pin = octopus::kHeaterPins[static_cast<std::size_t>(heater)];
  return ports_[static_cast<std::size_t>(pin.port)].output_high(pin.number);
}

bool OctopusBoard::fan_on(int fan) const {
  const stm32::OutputPin pin = octopus::kFanPins[static_cast<std::size_t>(fan)];
  return ports_[static_cast<std::size_t>(pin.port)].output_high(pin.number);
}

ServoPulses OctopusBoard::servo() {
  constexpr int kServoPort = 1, kServoPin = 6, kTim4 = 2;
  return servo_pulses(tim4_, ports_[kServoPort], kServoPin, kTim4, false, cpu_.now());
}

bool OctopusBoard::anything_on() const {
  return std::ranges::any_of(octopus::kPowerPins, [&](const octopus::PowerPin& power) {
    const GpioPort& port = ports_[static_cast<std::size_t>(power.pin.port)];
    return port.mode(power.pin.number) == GpioPort::Mode::kOutput &&
           port.output_high(power.pin.number) != power.off;
  });
}

int OctopusBoard::outputs() const {
  int count = 0;
  for (const GpioPort& port : ports_)
    for (int pin = 0; pin < 16; ++pin) count += port.mode(pin) == GpioPort::Mode::kOutput ? 1 : 0;
  return count;
}

void OctopusBoard::set_usb_cable(bool plugged) {
  constexpr Cycle kUntilAsleep = 3 * kCoreHz / 1000;
  cable_ = plugged;
  sleeps_ = plugged ? kNever : cpu_.now() + kUntilAsleep;
  schedule();
}

bool OctopusBoard::usb_device_seen() {
  constexpr std::uint32_t kAhb2Enable = 0x34;
  constexpr int kUsb = 7, kUsbFunction = 10;
  const GpioPort& a = ports_[0];
  const bool pins = a.mode(11) == GpioPort::Mode::kAlternate && a.alternate(11) == kUsbFunction &&
                    a.mode(12) == GpioPort::Mode::kAlternate && a.alternate(12) == kUsbFunction;
  return cable_ && pins && rcc_.clock_enabled(kAhb2Enable, kUsb) && rcc_.usb_hz() == 48'000'000u &&
         usb_.pulled_up(cpu_.now());
}

int OctopusBoard::clock_offset(std::uint32_t base, std::uint32_t address) const {
  return base == AdcBlock::kAddress ? AdcBlock::clock_offset(address) : 0;
}

// Dividers to 3.3 V: what is not plugged in is open.
double OctopusBoard::analogue(int channel) {
  if (channel == octopus::kThermistors[0].channel) return heated_.hot_end().voltage();
  if (channel == octopus::kThermistors[1].channel) return heated_.bed().voltage();
  return 1;
}

void OctopusBoard::reset_devices(Cycle now) {
  if (makers_loader_) std::ranges::fill(cpu_.sram(), std::uint8_t{0x5A});
  tim1_.reset(now);
  tim4_.reset(now);
  tim8_.reset(now);
  dma2_.reset();
  adc_.reset();
  usb_.reset();
  spi1_.reset();
  on_pins(now);
}

void OctopusBoard::advance_devices(Cycle now) {
  tim1_.advance(now);
  tim4_.advance(now);
  tim8_.advance(now);
  spi1_.advance(now);
  wires_next_ = kNever;
  for (std::size_t axis = 0; axis < chips_.size(); ++axis) {
    Tmc2209& chip = chips_[axis];
    const Wire& wire = wires_[axis];
    const bool moves = chip.next_event() <= now;
    if (moves) chip.advance(now);
    if (moves || wire.level.next_event() <= now || chip.pulls_low() != wire.chip_low) look_at_wire(axis, now);
    wires_next_ = std::min({wires_next_, chip.next_event(), wire.level.next_event()});
    if (spi_chips_[axis]) spi_chips_[axis]->advance(now);
  }
  look_at_diag();
  adc_.advance(now);
  heated_.advance(now);
  if (sleeps_ > now) return;
  sleeps_ = kNever;
  usb_.suspend();
}

Cycle OctopusBoard::next_of_devices() const {
  return std::min({tim1_.next_event(), tim4_.next_event(), tim8_.next_event(), adc_.next_event(),
                   heated_.next_event(), spi1_.next_event(), sleeps_, wires_next_});
}

void OctopusBoard::on_pins(Cycle now) {
  const auto high = [&](const stm32::OutputPin& pin) {
    return ports_[static_cast<std::size_t>(pin.port)].output_high(pin.number);
  };
  for (std::size_t axis = 0; axis < drivers_.size(); ++axis) {
    const octopus::DriverPins& pins = octopus::kDrivers[axis];
    // A pin that nobody drives leaves the driver disabled: pulled up on the board.
    const GpioPort& port = ports_[static_cast<std::size_t>(pins.enable.port)];
    const bool enabled = port.mode(pins.enable.number) == GpioPort::Mode::kOutput && !high(pins.enable);
    socket(axis).on_enable(enabled);
    look_at_wire(axis, now);
    drivers_[axis].on_pins(high(pins.step), high(pins.direction), enabled, now);
    wires_next_ = std::min({wires_next_, chips_[axis].next_event(), wires_[axis].level.next_event()});
  }
  // MOSFETs with a pull-down: a pin that nobody drives is off.
  heated_.set_power(high(octopus::kHeaterPins[0]), high(octopus::kHeaterPins[1]), now);
  heated_.set_contactor(high(octopus::kContactorPin));
}

// Open drain at both ends.
void OctopusBoard::look_at_wire(std::size_t axis, Cycle now) {
  const stm32::OutputPin& pin = octopus::kDrivers[axis].uart;
  GpioPort& port = ports_[static_cast<std::size_t>(pin.port)];
  Wire& wire = wires_[axis];
  const bool output = port.mode(pin.number) == GpioPort::Mode::kOutput, high = port.output_high(pin.number);
  const bool forced = output && high && !port.open_drain(pin.number);
  wire.chip_low = chips_[axis].pulls_low();
  if (forced && wire.chip_low && !wire.level.low()) ++wire_fights_;
  if (!wire.level.look(wire.chip_low || (output && !high), forced, true, now)) return;
  const bool level = wire.level.high();
  port.drive(pin.number, level);
  if (spi_chips_[axis])
    spi_chips_[axis]->on_select(!level, now);
  else
    chips_[axis].on_wire(level, now);
}

void OctopusBoard::look_at_diag() {
  for (std::size_t axis = 0; axis < chips_.size(); ++axis) {
    const bool level = socket(axis).diag();
    if (!diag_wired_[axis] || level == diag_level_[axis]) continue;
    diag_level_[axis] = level;
    set_input(static_cast<int>(axis), level);
  }
}

}  // namespace kinebus::emulator
