#include "vcan_tests/emulator/chip.hpp"

#include <algorithm>
#include <cstring>

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kPeripherals = 0x40000000;
constexpr std::uint32_t kUniqueIdOffset = 0x7A10 - 0x7800;

}  // namespace

Chip::Chip(const ElfImage& image, const BoardOptions& options, const ChipFacts& facts)
    : image_(image),
      options_(options),
      facts_(facts),
      cpu_(*this, facts.core_coupled_memory),
      rcc_(facts.clocks),
      flash_(cpu_.flash().first(facts.flash_bytes)),
      exti_(cpu_.nvic()),
      sysconfig_(exti_),
      tim2_(cpu_.nvic(), {.update_irq = 28, .cycles_per_tick = 2, .advanced = false}),
      can_(cpu_.nvic()) {
  cpu_.nvic().set_device_id(facts.device_id);
  map(0x40000000, 0x400, tim2_, apb1(0));
  map(0x40003000, 0x400, watchdog_);
  map(0x40006400, 0x400, can_, apb1(25));
  map(0x40007000, 0x400, power_control_, apb1(28));
  map(0x40013800, 0x400, sysconfig_, apb2(14));
  map(0x40013C00, 0x400, exti_);
  for (std::uint32_t port = 0; port < facts.ports; ++port)
    map(0x40020000 + 0x400 * port, 0x400, ports_[port], ahb1(static_cast<int>(port)));
  map(0x40023800, 0x400, rcc_);
  map(0x40023C00, 0x400, flash_);
}

Chip::~Chip() = default;

void Chip::start() {
  std::memcpy(cpu_.system_memory().data() + kUniqueIdOffset, options_.unique_id.data(),
              sizeof options_.unique_id);
  cpu_.load(image_);
  // A boot loader begins at the start of flash; without one the program begins by itself.
  boot_ = cpu_.peek(CortexM4::kFlash) != 0xFFFFFFFF ? CortexM4::kFlash : facts_.program;
  power_cycle();
  resets_ = 0;
}

int Chip::clock_offset(std::uint32_t, std::uint32_t) const {
  return 0;
}

void Chip::map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
               std::optional<Rcc::Clock> clock) {
  for (std::uint32_t at = base; at < base + size; at += 0x400)
    places_[(at - kPeripherals) / 0x400] = {&peripheral, base, clock};
}

// As on the chip: without its clock a peripheral takes nothing and says 0.
bool Chip::reached(const Place& place, std::uint32_t address, Cycle now) {
  if (place.peripheral == nullptr) return false;
  if (!place.clock) return true;
  Rcc::Clock clock = *place.clock;
  clock.bit += clock_offset(place.base, address);
  if (rcc_.live(clock, now)) return true;
  if (lost_.size() < 100) lost_.push_back(address);
  return false;
}

void Chip::power_cycle() {
  std::ranges::fill(cpu_.sram(), std::uint8_t{0xA5});
  reset(Rcc::ResetCause::kPowerOn);
}

void Chip::reset(Rcc::ResetCause cause) {
  const Cycle now = cpu_.now();
  ++resets_;
  rcc_.reset(cause);
  power_control_.reset();
  flash_.reset();
  for (GpioPort& port : ports_) port.reset();
  exti_.reset();
  tim2_.reset(now);
  can_.reset();
  watchdog_.reset();
  reset_devices(now);
  cpu_.reset(boot_);
  schedule();
}

void Chip::run(Cycle limit) {
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
  after_run();
}

void Chip::advance(Cycle now) {
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
  tim2_.advance(now);
  can_.advance(now);
  advance_devices(now);
  if (watchdog_.expired(now)) cpu_.stop();
  look_at_switches();
  schedule();
}

void Chip::schedule() {
  next_event_ = std::min({tim2_.next_event(), can_.next_event(), watchdog_.next_event(), next_of_devices(),
                          incoming_.empty() ? kNever : incoming_.front().at});
}

Chip::Place Chip::find(std::uint32_t address) {
  const std::uint32_t page = (address - kPeripherals) / 0x400;
  if (page < places_.size() && places_[page].peripheral != nullptr) return places_[page];
  if (strange_.size() < 100) strange_.push_back(address);
  return {};
}

std::uint32_t Chip::read(std::uint32_t address, int size, Cycle now) {
  const Place place = find(address);
  if (!reached(place, address, now)) return 0;
  const std::uint32_t word = place.peripheral->read((address - place.base) & ~3u, now) >> (8 * (address & 3));
  return size == 4 ? word : word & ((1u << (8 * size)) - 1);
}

void Chip::write(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
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

bool Chip::write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  const bool changed = flash_.program(address, value, size, now);
  if (changed) cpu_.stall_until(flash_.busy_until());
  return changed;
}

void Chip::look_at_switches() {
  for (std::size_t a = 0; a < facts_.axes; ++a) {
    const VirtualAxis& axis = options_.axes[a];
    if (axis.switch_input == 0) continue;
    const double above = true_counts(static_cast<int>(a)) - axis.switch_counts;
    const bool active = axis.active_above ? above >= 0 : above <= 0;
    const int level = active != axis.active_low ? 1 : 0;
    if (level == switch_level_[a]) continue;
    switch_level_[a] = level;
    set_input(axis.switch_input - 1, level == 1);
  }
}

void Chip::set_chip_supply(double volts) {
  power_control_.set_supply(volts);
  exti_.on_inner_level(PowerControl::kDetectorLine, power_control_.supply_low());
  if (volts < flash_.brown_out_volts()) reset(Rcc::ResetCause::kBrownOut);
}

void Chip::set_crystal(bool swings) {
  if (rcc_.set_crystal(swings)) cpu_.nvic().pend(kNmi);
}

}  // namespace kinebus::emulator
