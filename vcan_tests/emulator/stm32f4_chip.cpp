#include "vcan_tests/emulator/stm32f4_chip.hpp"

#include <cstring>

namespace kinebus::emulator {
namespace {

Rcc::Facts with_crystal(Rcc::Facts facts, std::uint32_t hz) {
  if (hz != 0) facts.crystal_hz = hz;
  return facts;
}

constexpr std::uint32_t kUniqueIdOffset = 0x7A10 - 0x7800;

}  // namespace

Stm32f4Chip::Stm32f4Chip(const ElfImage& image, const BoardOptions& options, const ChipFacts& facts)
    : Chip(image, options, {.core_coupled_memory = facts.core_coupled_memory}),
      rcc_(with_crystal(facts.clocks, options.crystal_hz)),
      flash_(cpu_.flash().first(facts.flash_bytes), cpu_.system_memory().first(CortexM4::kOneTimeMemorySize)),
      exti_(cpu_.nvic()),
      sysconfig_(exti_),
      tim2_(cpu_.nvic(), {.update_irq = 28, .cycles_per_tick = 2, .advanced = false}),
      tim11_(rcc_, options.measures_crystal),
      can_(cpu_.nvic()),
      facts_(facts) {
  cpu_.nvic().set_device_id(facts.device_id);
  map(0x40000000, 0x400, tim2_, apb1(0));
  map(0x40002800, 0x400, backup_);
  map(0x40003000, 0x400, watchdog_);
  map(0x40006400, 0x400, can_, apb1(25));
  map(0x40007000, 0x400, power_control_, apb1(28));
  map(0x40013800, 0x400, sysconfig_, apb2(14));
  map(0x40014800, 0x400, tim11_, apb2(18));
  map(0x40013C00, 0x400, exti_);
  for (std::uint32_t port = 0; port < facts.ports; ++port)
    map(0x40020000 + 0x400 * port, 0x400, ports_[port], ahb1(static_cast<int>(port)));
  map(0x40023800, 0x400, rcc_);
  map(0x40023C00, 0x400, flash_);
}

Stm32f4Chip::~Stm32f4Chip() = default;

void Stm32f4Chip::start() {
  std::ranges::fill(cpu_.system_memory().first(CortexM4::kOneTimeMemorySize), std::uint8_t{0xFF});
  std::memcpy(cpu_.system_memory().data() + kUniqueIdOffset, options_.unique_id.data(),
              sizeof options_.unique_id);
  Chip::start(facts_.program, facts_.axes);
}

void Stm32f4Chip::reset_chip(Rcc::ResetCause cause, Cycle now) {
  rcc_.reset(cause);
  power_control_.reset();
  if (cause == Rcc::ResetCause::kPowerOn) backup_.lose_power();
  flash_.reset();
  for (GpioPort& port : ports_) port.reset();
  exti_.reset();
  tim2_.reset(now);
  tim11_.reset();
  can_.reset();
}

void Stm32f4Chip::advance_chip(Cycle now) {
  tim2_.advance(now);
  can_.advance(now);
}

void Stm32f4Chip::after_write(Peripheral& written) {
  if (&written != &flash_ || !flash_.take_erased()) return;
  cpu_.forget_code();
  cpu_.stall_until(flash_.busy_until());
}

bool Stm32f4Chip::write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) {
  const bool changed = flash_.program(address, value, size, now);
  if (changed) cpu_.stall_until(flash_.busy_until());
  return changed;
}

void Stm32f4Chip::set_chip_supply(double volts) {
  power_control_.set_supply(volts);
  exti_.on_inner_level(PowerControl::kDetectorLine, power_control_.supply_low());
  if (volts < flash_.brown_out_volts()) reset(Rcc::ResetCause::kBrownOut);
}

void Stm32f4Chip::set_crystal(bool swings) {
  if (rcc_.set_crystal(swings)) cpu_.nvic().pend(kNmi);
}

}  // namespace kinebus::emulator
