#pragma once
// An emulated microcontroller as its board and the bus see it: processor, the places of its peripherals,
// their clocks, CAN, watchdog, resets. A kind of chip adds its peripherals (stm32f4_chip, stm32g0b1_chip), a
// board what is wired to them. One crystal: time is Cycles, whatever the core's clock.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"
#include "vcan_tests/emulator/board_options.hpp"
#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/peripherals/can_controller.hpp"
#include "vcan_tests/emulator/peripherals/rcc.hpp"
#include "vcan_tests/emulator/peripherals/watchdog.hpp"

namespace kinebus::emulator {

class Chip : public Devices {
 public:
  ~Chip() override;

  /// Runs up to `limit` and at most a basic block further.
  void run(Cycle limit);
  Cycle now() const { return cpu_.now(); }
  /// Power off and on again: RAM is lost, flash is kept.
  void power_cycle();

  // CAN, for who joins boards to a bus.
  virtual CanController& can() = 0;
  /// A frame ends on the bus at `at`, not before now().
  void deliver(Cycle at, const CanFrame& frame) { incoming_.push_back({at, frame}); }
  void sent(Cycle at, int mailbox) { incoming_.push_back({at, {}, mailbox}); }

  /// From power to its boot-up message, at most.
  virtual BusTime boot_time() const { return std::chrono::milliseconds{30}; }
  /// 1018h:2 of the program that is for this board.
  virtual std::uint32_t product_code() const = 0;
  /// True carriage position at the last run(), counts (51200 a turn) from the joint's zero.
  virtual double true_counts(int axis) const = 0;
  /// The level on switch input 0..6 from outside; inputs that an axis drives follow it.
  virtual void set_input(int input, bool level) = 0;
  double start_counts(int axis) const { return options_.axes[static_cast<std::size_t>(axis)].start_counts; }
  /// The count of local time at a time not long after now().
  virtual std::uint32_t local_counts(Cycle at) = 0;

  CortexM4& cpu() { return cpu_; }
  const CortexM4& cpu() const { return cpu_; }
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
  Cycle next_event() const override { return next_event_; }
  void advance(Cycle now) override;

 protected:
  Chip(const ElfImage& image, const BoardOptions& options, const CoreFacts& core);
  /// A board calls this when its own parts are there. program: where the program's vectors are, when no boot
  /// loader begins at the start of flash. axes: motors on the board.
  void start(std::uint32_t program, std::size_t axes);

  void map(std::uint32_t base, std::uint32_t size, Peripheral& peripheral,
           std::optional<Rcc::Clock> clock = std::nullopt);
  void reset(Rcc::ResetCause cause);
  void schedule();

  // What a kind of chip adds.
  virtual void reset_chip(Rcc::ResetCause cause, Cycle now) = 0;
  virtual void advance_chip(Cycle now) = 0;
  virtual Cycle next_of_chip() const = 0;
  virtual bool live(const Rcc::Clock& clock, Cycle now) = 0;
  virtual void after_write(Peripheral&) {}
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
  CortexM4 cpu_;
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

  std::array<Place, 512> places_{};     // by KiB from 0x40000000
  std::array<Place, 512> io_places_{};  // and from 0x50000000
  std::deque<Incoming> incoming_;
  std::array<int, 8> switch_level_{-1, -1, -1, -1, -1, -1, -1, -1};
  std::size_t axes_ = 0;
  Cycle next_event_ = 0;
  std::uint32_t boot_ = 0;
  std::uint64_t resets_ = 0, watchdog_resets_ = 0;
  std::vector<std::uint32_t> strange_, lost_;
};

}  // namespace kinebus::emulator
