#pragma once
// An emulated STM32F4 with what every board needs of it: clocks, flash, pins, local time, CAN.

#include <algorithm>
#include <array>
#include <cstdint>

#include "vcan_tests/emulator/chip.hpp"
#include "vcan_tests/emulator/peripherals/backup_registers.hpp"
#include "vcan_tests/emulator/peripherals/bxcan.hpp"
#include "vcan_tests/emulator/peripherals/crystal_meter.hpp"
#include "vcan_tests/emulator/peripherals/flash.hpp"
#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/power_control.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"

namespace kinebus::emulator {

/// How one STM32F4 differs from another.
struct ChipFacts {
  std::uint32_t device_id = 0;  ///< DBGMCU_IDCODE
  std::uint32_t flash_bytes = 0;
  bool core_coupled_memory = false;
  Rcc::Facts clocks{};
  std::uint32_t ports = 0;    ///< GPIO ports from A on
  std::size_t axes = 2;       ///< motors on the board
  std::uint32_t program = 0;  ///< where the first vectors are, when there are none at the start of flash
};

class Stm32f4Chip : public Chip {
 public:
  ~Stm32f4Chip() override;

  BxCan& can() override { return can_; }
  std::uint32_t local_counts(Cycle at) override { return tim2_.read(0x24, std::max(at, cpu_.now())); }

  /// The chip's own supply, 3.3 V by itself: what the detector (PVD) makes of it, and a reset below the
  /// brown-out level of the option bytes; RAM keeps. Not what flash and core do below 2.7 V.
  void set_chip_supply(double volts);
  void set_crystal(bool swings);

  Rcc& rcc() { return rcc_; }
  FlashController& flash() { return flash_; }

  bool write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;

 protected:
  Stm32f4Chip(const ElfImage& image, const BoardOptions& options, const ChipFacts& facts);
  /// A board calls start() when its own parts are there.
  void start();

  static constexpr Rcc::Clock ahb1(int bit) { return {0x30, bit}; }
  static constexpr Rcc::Clock ahb2(int bit) { return {0x34, bit}; }
  static constexpr Rcc::Clock apb1(int bit) { return {0x40, bit}; }
  static constexpr Rcc::Clock apb2(int bit) { return {0x44, bit}; }

  Rcc rcc_;
  FlashController flash_;
  PowerControl power_control_;
  BackupRegisters backup_{power_control_};
  std::array<GpioPort, 8> ports_;
  Exti exti_;
  SysConfig sysconfig_;
  Timer tim2_;
  CrystalMeter tim11_;
  BxCan can_;

 private:
  void reset_chip(Rcc::ResetCause cause, Cycle now) override;
  void advance_chip(Cycle now) override;
  Cycle next_of_chip() const override { return std::min(tim2_.next_event(), can_.next_event()); }
  bool live(const Rcc::Clock& clock, Cycle now) override { return rcc_.live(clock, now); }
  void after_write(Peripheral& written) override;

  ChipFacts facts_;
};

}  // namespace kinebus::emulator
