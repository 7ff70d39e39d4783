#pragma once
// Registers of the TMC2209 (datasheet rev. 1.09, register map), and what is written into them.

#include <algorithm>
#include <array>
#include <cstdint>

#include "node_firmware/step/current_scale.hpp"
#include "node_firmware/step/stepper_driver.hpp"

namespace kinebus::tmc2209 {

namespace reg {
inline constexpr std::uint8_t kGconf = 0x00, kGstat = 0x01, kIfcnt = 0x02, kIoin = 0x06, kIholdIrun = 0x10,
                              kTpowerdown = 0x11, kTpwmthrs = 0x13, kTcoolthrs = 0x14, kVactual = 0x22,
                              kSgthrs = 0x40, kSgResult = 0x41, kCoolconf = 0x42, kChopconf = 0x6C,
                              kDrvStatus = 0x6F, kPwmconf = 0x70;
}  // namespace reg

namespace gstat {
inline constexpr std::uint32_t kReset = 1, kDriverError = 2, kChargePumpLow = 4;
}  // namespace gstat

namespace drv_status {
inline constexpr std::uint32_t kPreWarning = 1u << 0, kTooHot = 1u << 1, kShortToGround = 3u << 2,
                               kShortToSupply = 3u << 4, kOpenLoad = 3u << 6, kStandstill = 1u << 31;
}  // namespace drv_status
inline constexpr step::StatusBits kStatusBits{.pre_warning = drv_status::kPreWarning,
                                              .too_hot = drv_status::kTooHot,
                                              .short_to_ground = drv_status::kShortToGround,
                                              .short_to_supply = drv_status::kShortToSupply,
                                              .open_phase = drv_status::kOpenLoad,
                                              .standstill = drv_status::kStandstill};

/// IOIN, bits 31 to 24.
inline constexpr std::uint32_t kVersion = 0x21;
/// Its own oscillator, within 4 %: TSTEP is a microstep's time in its periods.
inline constexpr std::uint32_t kClockHz = 12'000'000;
/// Counts of an axis are microsteps of 1/256, as TSTEP's are.
constexpr std::uint32_t tstep_of(std::uint32_t counts_per_s) {
  constexpr std::uint32_t kLongest = 0xF'FFFF;
  return counts_per_s == 0 ? kLongest : std::min(kClockHz / counts_per_s, kLongest);
}

using step::DriverSettings;

/// Full scale: 325 mV or 180 mV at the sense resistor, 0.11 ohm on most modules, and the chip's own 0.02 ohm.
constexpr step::CurrentScale scale_of(std::uint32_t run_ma, std::uint32_t hold_ma,
                                      std::uint32_t sense_milliohm = 0) {
  constexpr std::uint32_t kUsualSense = 110, kBond = 20;
  const std::uint32_t sense = (sense_milliohm != 0 ? sense_milliohm : kUsualSense) + kBond;
  return step::scale_of(run_ma, hold_ma, {.coarse_ma = 325'000 / sense, .fine_ma = 180'000 / sense});
}

struct Register {
  std::uint8_t address = 0;
  std::uint32_t value = 0;
};
/// Everything that is written, in order; the chopper last but one, so that nothing is on before its current
/// is right. The last takes back what GSTAT has kept.
inline constexpr std::size_t kRegisters = 11;
constexpr std::array<Register, kRegisters> registers_of(const DriverSettings& s) {
  // GCONF: current by the chip's own reference, not by the potentiometer (bit 0 off); the wire is for data
  // alone (6); microsteps by CHOPCONF (7); filter on STEP (8).
  constexpr std::uint32_t kGeneral = 1u << 6 | 1u << 7 | 1u << 8, kSpreadCycle = 1u << 2;
  // CHOPCONF: off time 3, hysteresis 5 and 0, blank time 32 clocks; 16 microsteps, interpolated to 256.
  constexpr std::uint32_t kChopper = 3u | 5u << 4 | 2u << 15 | 4u << 24 | 1u << 28, kFine = 1u << 17;
  // From run to hold current: 0.44 s after the last step (TPOWERDOWN, units of 2^18 clocks), in 8 * 2^18
  // clocks a 32nd.
  constexpr std::uint32_t kHoldDelay = 8, kPowerDown = 20;
  constexpr std::uint32_t kPwm = 0xC10D'0024;  // as it comes: scaled and graded by itself
  const step::CurrentScale scale = scale_of(s.run_ma, s.hold_ma, s.sense_milliohm);
  const bool stall = s.homing && s.stall_threshold != 0;
  const bool stealth = stall || s.spread_above != 0;
  return {{{reg::kGconf, kGeneral | (stealth ? 0 : kSpreadCycle)},
           {reg::kVactual, 0},
           {reg::kIholdIrun, scale.hold | std::uint32_t{scale.run} << 8 | kHoldDelay << 16},
           {reg::kTpowerdown, kPowerDown},
           // 0: no upper velocity.
           {reg::kTpwmthrs, stall ? 0 : tstep_of(s.spread_above)},
           {reg::kTcoolthrs, stall ? tstep_of(s.stall_above) : 0},
           {reg::kSgthrs, stall ? s.stall_threshold : std::uint32_t{0}},
           {reg::kCoolconf, 0},
           {reg::kPwmconf, kPwm},
           {reg::kChopconf, kChopper | (scale.fine ? kFine : 0)},
           {reg::kGstat, gstat::kReset | gstat::kDriverError}}};
}

}  // namespace kinebus::tmc2209
