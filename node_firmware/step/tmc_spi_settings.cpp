#include "node_firmware/step/tmc_spi_settings.hpp"

#include <algorithm>

#include "node_firmware/step/current_scale.hpp"

namespace kinebus::tmc_spi {
namespace {

using step::DriverSettings;

// Their own oscillators; TSTEP is a microstep's time in its periods, and counts are microsteps of 1/256.
constexpr std::uint32_t kClock5160 = 12'000'000, kClock2130 = 13'200'000;
constexpr std::uint32_t tstep_of(std::uint32_t counts_per_s, std::uint32_t clock_hz) {
  constexpr std::uint32_t kLongest = 0xF'FFFF;
  return counts_per_s == 0 ? kLongest : std::min(clock_hz / counts_per_s, kLongest);
}

// GCONF
constexpr std::uint32_t kStealthChop = 1u << 2, kStepFilter = 1u << 3, kStallToDiag1 = 1u << 8,
                        kDiag1PushPull = 1u << 13;
// CHOPCONF: off time 3, hysteresis 4 and 1, blank time 36 clocks; 16 microsteps, interpolated to 256.
constexpr std::uint32_t kChopper = 3u | 4u << 4 | 1u << 7 | 2u << 15 | 4u << 24 | 1u << 28;
constexpr std::uint32_t kDamping = 4u << 20;  // TMC5160, TPFD: of resonances in the middle range
constexpr std::uint32_t kFine = 1u << 17;     // TMC2130, VSENSE
// From run to hold current: 0.44 s after the last step (TPOWERDOWN, units of 2^18 clocks), in 8 * 2^18 clocks
// a 32nd.
constexpr std::uint32_t kHoldDelay = 8u << 16, kPowerDown = 20;

bool looks_for_stall(const DriverSettings& s) {
  return s.homing && s.stall_threshold != 0;
}
// StallGuard2 sees the load in SpreadCycle only.
std::uint32_t general(const DriverSettings& s) {
  if (looks_for_stall(s)) return kStallToDiag1 | kDiag1PushPull;
  return s.spread_above != 0 ? kStealthChop : 0;
}
// COOLCONF, SGT: -64 the lightest load, 63 the heaviest.
std::uint32_t stall_at(const DriverSettings& s) {
  if (!looks_for_stall(s)) return 0;
  return static_cast<std::uint32_t>(63 - s.stall_threshold / 2) << 16 & 0x7Fu << 16;
}
void add_velocities(Registers& r, const DriverSettings& s, std::uint32_t clock_hz) {
  r.add(reg::kTpowerdown, kPowerDown);
  r.add(reg::kTpwmthrs, tstep_of(s.spread_above, clock_hz));
  r.add(reg::kTcoolthrs, looks_for_stall(s) ? tstep_of(s.stall_above, clock_hz) : 0);
  r.add(reg::kThigh, 0);  // no full steps
  r.add(reg::kCoolconf, stall_at(s));
}

constexpr step::StatusBits status_bits(std::uint32_t short_to_supply) {
  return {.pre_warning = drv_status::kPreWarning,
          .too_hot = drv_status::kTooHot,
          .short_to_ground = drv_status::kShortToGround,
          .short_to_supply = short_to_supply,
          .open_phase = drv_status::kOpenLoad,
          .standstill = drv_status::kStandstill};
}
constexpr std::array kChips{
    Chip{.version = 0x30,
         .number = 5160,
         .clears_by_write = true,
         .status = status_bits(drv_status::kShortToSupply),
         .registers_of = &tmc5160_registers},
    Chip{.version = 0x11, .number = 2130, .status = status_bits(0), .registers_of = &tmc2130_registers},
};

}  // namespace

const Chip* chip_of(std::uint8_t version) {
  const auto* chip = std::ranges::find(kChips, version, &Chip::version);
  return chip == kChips.end() ? nullptr : chip;
}

GlobalScale global_scale_of(std::uint32_t run_ma, std::uint32_t hold_ma, std::uint32_t sense_milliohm) {
  constexpr std::uint32_t kWhole = 256, kSmallest = 32;
  const std::uint32_t full_ma = std::max(325'000 / sense_milliohm, std::uint32_t{1});
  GlobalScale scale;
  scale.scaler = std::clamp(std::max(run_ma, hold_ma) * kWhole / full_ma, kSmallest, kWhole);
  const auto part = [&](std::uint32_t ma) {
    return static_cast<std::uint8_t>(
        std::clamp<std::uint32_t>(ma * (32 * kWhole) / (full_ma * scale.scaler), 1, 32) - 1);
  };
  scale.run = part(run_ma);
  scale.hold = part(hold_ma);
  return scale;
}

Registers tmc5160_registers(const DriverSettings& s) {
  constexpr std::uint32_t kUsualSense = 75;
  // As they come: shorts are told at level 6, and after 1 us; gate drivers of middle strength.
  constexpr std::uint32_t kShorts = 0x1'0606, kGates = 0x8'0400;
  constexpr std::uint32_t kPwm = 0xC40C'001E;  // as it comes: scaled and graded by itself
  const GlobalScale scale =
      global_scale_of(s.run_ma, s.hold_ma, s.sense_milliohm != 0 ? s.sense_milliohm : kUsualSense);
  Registers r;
  r.add(reg::kGconf, general(s) | kStepFilter);
  r.add(reg::kShortConf, kShorts);
  r.add(reg::kDrvConf, kGates);
  r.add(reg::kGlobalScaler, scale.scaler % 256);  // 0: 256
  r.add(reg::kIholdIrun, scale.hold | std::uint32_t{scale.run} << 8 | kHoldDelay);
  add_velocities(r, s, kClock5160);
  r.add(reg::kPwmconf, kPwm);
  r.add(reg::kChopconf, kChopper | kDamping);
  return r;
}

Registers tmc2130_registers(const DriverSettings& s) {
  constexpr std::uint32_t kUsualSense = 110, kBond = 20;
  // Scaled by itself; amplitude 200, gradient 1, 2/1024 of the clock.
  constexpr std::uint32_t kPwm = 0x4'01C8;
  const std::uint32_t sense = (s.sense_milliohm != 0 ? s.sense_milliohm : kUsualSense) + kBond;
  const step::CurrentScale scale =
      step::scale_of(s.run_ma, s.hold_ma, {.coarse_ma = 320'000 / sense, .fine_ma = 180'000 / sense});
  Registers r;
  r.add(reg::kGconf, general(s));
  r.add(reg::kIholdIrun, scale.hold | std::uint32_t{scale.run} << 8 | kHoldDelay);
  add_velocities(r, s, kClock2130);
  r.add(reg::kPwmconf, kPwm);
  r.add(reg::kChopconf, kChopper | (scale.fine ? kFine : 0));
  return r;
}

}  // namespace kinebus::tmc_spi
