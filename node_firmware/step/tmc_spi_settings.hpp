#pragma once
// Registers of the TMC5160 (datasheet rev. 1.01) and the TMC2130 (rev. 1.09), and what is written into them.

#include <array>
#include <cstdint>

#include "node_firmware/step/stepper_driver.hpp"

namespace kinebus::tmc_spi {

namespace reg {
inline constexpr std::uint8_t kGconf = 0x00, kGstat = 0x01, kIoin = 0x04, kShortConf = 0x09, kDrvConf = 0x0A,
                              kGlobalScaler = 0x0B, kIholdIrun = 0x10, kTpowerdown = 0x11, kTpwmthrs = 0x13,
                              kTcoolthrs = 0x14, kThigh = 0x15, kChopconf = 0x6C, kCoolconf = 0x6D,
                              kDrvStatus = 0x6F, kPwmconf = 0x70;
}  // namespace reg

namespace gstat {
inline constexpr std::uint32_t kReset = 1, kDriverError = 2, kChargePumpLow = 4, kAll = 7;
}  // namespace gstat

namespace drv_status {
inline constexpr std::uint32_t kStallGuard = 0x3FF, kShortToSupply = 3u << 12, kTooHot = 1u << 25,
                               kPreWarning = 1u << 26, kShortToGround = 3u << 27, kOpenLoad = 3u << 29,
                               kStandstill = 1u << 31;
}  // namespace drv_status

struct Register {
  std::uint8_t address = 0;
  std::uint32_t value = 0;
};
inline constexpr std::size_t kMostRegisters = 12;
/// Everything that is written, in order; the chopper last, so that nothing is on before its current is right.
struct Registers {
  std::array<Register, kMostRegisters> all{};
  std::uint8_t count = 0;
  constexpr void add(std::uint8_t address, std::uint32_t value) { all[count++] = {address, value}; }
  constexpr const Register& chopper() const { return all[count - 1u]; }
};

/// How one chip differs from the other.
struct Chip {
  std::uint8_t version = 0;  ///< IOIN, bits 31 to 24
  std::uint16_t number = 0;
  bool clears_by_write = false;  ///< GSTAT; else reading it clears it
  step::StatusBits status;
  Registers (*registers_of)(const step::DriverSettings&) = nullptr;
};
/// None: no chip of this kind.
const Chip* chip_of(std::uint8_t version);

Registers tmc5160_registers(const step::DriverSettings& settings);
Registers tmc2130_registers(const step::DriverSettings& settings);

/// Currents of a TMC5160: 32nds (IRUN, IHOLD) of 256ths (GLOBALSCALER, 32 to 256) of 325 mV at the resistors.
struct GlobalScale {
  std::uint32_t scaler = 256;
  std::uint8_t run = 0, hold = 0;
};
/// Never more than asked for, but for the smallest that there is.
GlobalScale global_scale_of(std::uint32_t run_ma, std::uint32_t hold_ma, std::uint32_t sense_milliohm);

}  // namespace kinebus::tmc_spi
