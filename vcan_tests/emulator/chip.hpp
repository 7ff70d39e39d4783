#pragma once
// An emulated STM32F4 with what every board needs of it: processor, clocks, flash, pins, local time, CAN,
// watchdog. A board adds its other peripherals and what is wired to them. One crystal: time is the
// processor's cycles.

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/can/frame.hpp"
#include "vcan_tests/emulator/board_options.hpp"
#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/peripherals/bxcan.hpp"
#include "vcan_tests/emulator/peripherals/flash.hpp"
#include "vcan_tests/emulator/peripherals/gpio.hpp"
#include "vcan_tests/emulator/peripherals/power_control.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"
#include "vcan_tests/emulator/peripherals/timer.hpp"
#include "vcan_tests/emulator/peripherals/watchdog.hpp"

namespace kinebus::emulator {

/// How one STM32F4 differs from another.
struct ChipFacts {
  std::uint32_t device_id = 0;  ///< DBGMCU_IDCODE
  std::uint32_t flash_bytes = 0;
  bool core_coupled_memory = false;
  Rcc::Facts clocks{};
  std::uint32_t ports = 0;    ///< GPIO ports from A on
  std::size_t axes = 2;       ///< motors on the board
  std::uint32_t program = 0;  ///< where the program's vectors are, when no boot loader of ours is there
};

class Chip : public Devices {
 public:
  ~Chip() override;

  /// Runs up to `limit` and at most a basic block further.
  void run(Cycle limit);
  Cycle now() const { return cpu_.now(); }
  /// Power off and on again: RAM is lost, flash is kept.
  void power_cycle();

  // CAN, for who joins boards to a bus.
  BxCan& can() { return can_; }
  /// A frame ends on the bus at `at`, not before now().
  void deliver(Cycle at, const CanFrame& frame) { incoming_.push_back({at, frame}); }
  void sent(Cycle at, int mailbox) { incoming_.push_back({at, {}, mailbox}); }

  /// 1018h:2 of the program that is for this board.
  virtual std::uint32_t product_code() const = 0;
  /// True carriage position at the last run(), counts (51200 a turn) from the joint's zero.
  virtual double true_counts(int axis) const = 0;
  /// The level on switch input 0..6 from outside; inputs that an axis drives follow it.
  virtual void set_input(int input, bool level) = 0;
  double start_counts(int axis) const { return options_.axes[static_cast<std::size_t>(axis)].start_counts; }
  /// TIM2's count at a time not long after now().
  std::uint32_t local_counts(Cycle at) { return tim2_.read(0x24, std::max(at, cpu_.now())); }

  /// The chip's own supply, 3.3 V by itself: what the detector (PVD) makes of it, and a reset below the
  /// brown-out level of the option bytes; RAM keeps. Not what flash and core do below 2.7 V.
  void set_chip_supply(double volts);
  void set_crystal(bool swings);

  CortexM4& cpu() { return cpu_; }
  const CortexM4& cpu() const { return cpu_; }
  Rcc& rcc() { return rcc_; }
  FlashController& flash() { return flash_; }
  const ElfImage& image() const { return image_; }
  std::uint64_t resets() const { return resets_; }
  std::uint64_t watchdog_resets() const { return watchdog_resets_; }
  /// Accesses to addresses where the board has nothing: a mistake of the program, or of this emulation.
  const std::vector<std::uint32_t>& strange_accesses() const { return strange_; }
  /// Accesses to peripherals whose clock was off, or had been on for too short a time: what was written there
  /// is lost, and what was read is 0.
  const std::vector<std::uint32_t>& lost_accesses() const { return lost_; }

  // Devices.
  std::uint32_t read(std::uint32_t address, int size, Cycle now) override;
  void write(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;
  bool write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) override;
  Cycle next_event() const override { return next_event_; }
  void advance(Cycle now) override;

 protected:
  /// A board calls start() when its own parts are there.
  Chip(const ElfImage& image, const BoardOptions& options, const ChipFacts& facts);
  void start();

  void map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
           std::optional<Rcc::Clock> clock = std::nullopt);
  static constexpr Rcc::Clock ahb1(int bit) { return {0x30, bit}; }
  static constexpr Rcc::Clock apb1(int bit) { return {0x40, bit}; }
  static constexpr Rcc::Clock apb2(int bit) { return {0x44, bit}; }

  // What a board adds.
  virtual void reset_devices(Cycle now) = 0;
  virtual void advance_devices(Cycle now) = 0;
  virtual Cycle next_of_devices() const = 0;
  virtual void after_run() {}
  /// Bits of a clock register that a block of several peripherals has, by address.
  virtual int clock_offset(std::uint32_t base, std::uint32_t address) const;

  /// Drives the input pins of axes whose switch has changed.
  void look_at_switches();

  const ElfImage& image_;
  BoardOptions options_;
  ChipFacts facts_;
  CortexM4 cpu_;
  Rcc rcc_;
  FlashController flash_;
  PowerControl power_control_;
  std::array<GpioPort, 8> ports_;
  Exti exti_;
  SysConfig sysconfig_;
  Timer tim2_;
  BxCan can_;
  Watchdog watchdog_;

 private:
  struct Incoming {
    Cycle at = 0;
    CanFrame frame;
    int sent_mailbox = -1;
  };
  struct Place {
    Peripheral* peripheral = nullptr;
    std::uint32_t base = 0;
    std::optional<Rcc::Clock> clock;
  };
  bool reached(const Place& place, std::uint32_t address, Cycle now);
  Place find(std::uint32_t address);
  void reset(Rcc::ResetCause cause);
  void schedule();

  std::array<Place, 512> places_{};  // by KiB from 0x40000000
  std::deque<Incoming> incoming_;
  std::array<int, 8> switch_level_{-1, -1, -1, -1, -1, -1, -1, -1};
  Cycle next_event_ = 0;
  std::uint32_t boot_ = 0;
  std::uint64_t resets_ = 0, watchdog_resets_ = 0;
  std::vector<std::uint32_t> strange_, lost_;
};

}  // namespace kinebus::emulator
