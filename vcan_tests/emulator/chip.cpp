#include "vcan_tests/emulator/chip.hpp"

#include <algorithm>

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kPeripherals = 0x40000000, kIoPorts = 0x50000000;

}  // namespace

Chip::Chip(const ElfImage& image, const BoardOptions& options, const CoreFacts& core)
    : image_(image), options_(options), cpu_(*this, core) {}

Chip::~Chip() = default;

void Chip::start(std::uint32_t program, std::size_t axes) {
  axes_ = axes;
  cpu_.load(image_);
  // A boot loader begins at the start of flash; without one the program begins by itself.
  boot_ = cpu_.peek(CortexM4::kFlash) != 0xFFFFFFFF ? CortexM4::kFlash : program;
  power_cycle();
  resets_ = 0;
}

int Chip::clock_offset(std::uint32_t, std::uint32_t) const {
  return 0;
}

void Chip::map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
               std::optional<Rcc::Clock> clock) {
  for (std::uint32_t at = base; at < base + size; at += 0x400)
    (at < kIoPorts ? places_[(at - kPeripherals) / 0x400] : io_places_[(at - kIoPorts) / 0x400]) = {
        &peripheral, base, clock};
}

// As on the chip: without its clock a peripheral takes nothing and says 0.
bool Chip::reached(const Place& place, std::uint32_t address, Cycle now) {
  if (place.peripheral == nullptr) return false;
  if (!place.clock) return true;
  Rcc::Clock clock = *place.clock;
  clock.bit += clock_offset(place.base, address);
  if (live(clock, now)) return true;
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
  reset_chip(cause, now);
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
      can().on_sent(in.sent_mailbox);
    else
      can().on_frame(in.frame, now);
  }
  advance_chip(now);
  advance_devices(now);
  if (watchdog_.expired(now)) cpu_.stop();
  look_at_switches();
  schedule();
}

void Chip::schedule() {
  next_event_ = std::min({next_of_chip(), watchdog_.next_event(), next_of_devices(),
                          incoming_.empty() ? kNever : incoming_.front().at});
}

Chip::Place Chip::find(std::uint32_t address) {
  const auto& places = address < kIoPorts ? places_ : io_places_;
  const std::uint32_t page = (address - (address < kIoPorts ? kPeripherals : kIoPorts)) / 0x400;
  if (page < places.size() && places[page].peripheral != nullptr) return places[page];
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
  after_write(*place.peripheral);
  schedule();
}

void Chip::look_at_switches() {
  for (std::size_t a = 0; a < axes_; ++a) {
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

}  // namespace kinebus::emulator
