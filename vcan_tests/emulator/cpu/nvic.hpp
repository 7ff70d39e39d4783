#pragma once
// The Cortex-M4's system control space: NVIC, SysTick, SCB, DWT and the enables of the FPU. Decides which
// exception runs next; the processor around it (cortex_m4) does the stacking. No Unicorn here.

#include <array>
#include <cstdint>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

/// Exception numbers as in IPSR; interrupt n is 16 + n.
enum Exception : int {
  kThread = 0,
  kNmi = 2,
  kHardFault = 3,
  kSvCall = 11,
  kPendSv = 14,
  kSysTick = 15,
  kFirstInterrupt = 16,
};

struct Masks {  // the processor's special registers
  std::uint32_t primask = 0, basepri = 0, faultmask = 0;
};

class Nvic final : public Peripheral, public InterruptLines {
 public:
  static constexpr std::uint32_t kBootVectors =
      0x08000000;  ///< flash, as it appears at address 0 after reset
  static constexpr int kInterrupts = 82;
  static constexpr int kExceptions = kFirstInterrupt + kInterrupts;

  // The register block at 0xE0001000 (DWT), 0xE000E000 (SCS): `offset` from 0xE0000000.
  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  /// A byte or half-word store (priorities are bytes).
  void write_part(std::uint32_t offset, std::uint32_t value, int size, Cycle now);
  Cycle next_event() const override { return systick_event_; }
  void advance(Cycle now) override;

  void set_line(int irq, bool level) override;
  void pend(int exception);
  /// What the fault status registers say of a fault that comes.
  void set_fault_status(std::uint32_t cfsr, std::uint32_t hfsr, std::uint32_t address) {
    cfsr_ = cfsr;
    hfsr_ = hfsr;
    bfar_ = address;
  }

  /// A Cortex-M0+ is less: two bits of priority, 32 interrupts, registers by whole words only, and none of
  /// the fault status, floating point and cycle counter.
  void set_small(bool small) { small_ = small; }
  /// DBGMCU_IDCODE, which lies among the core's registers.
  void set_device_id(std::uint32_t id) { device_id_ = id; }

  bool any_pending() const { return pending_count_ > 0; }
  /// The exception that preempts what runs now; kThread: none. WFI wakes for one that only PRIMASK holds
  /// back.
  int next_exception(const Masks& masks) const;
  void enter(int exception);
  /// Leaves the active exception. A line that is still high asks again.
  void leave(int exception);
  int active_exception() const {
    return depth_ == 0 ? kThread : stack_[static_cast<std::size_t>(depth_ - 1)];
  }
  int depth() const { return depth_; }

  std::uint32_t vector_table() const { return vtor_; }
  bool fpu_enabled() const { return (cpacr_ & 0x00F00000u) == 0x00F00000u; }
  bool take_reset_request();
  bool reset_requested() const { return reset_requested_; }
  /// The processor's reset: everything off, levels of the lines as they are.
  void reset(std::uint32_t vectors = kBootVectors);

 private:
  static constexpr int kNoPriority = 256;
  void find_best();
  void set_priority(std::uint32_t offset, std::uint32_t byte);
  int priority(int exception) const;
  int group_priority(int value) const;
  int running_priority() const;
  bool enabled(int exception) const;
  void set_pending(int exception, bool pending);
  void start_systick(Cycle now);
  std::uint32_t systick_value(Cycle now) const;

  std::array<std::uint8_t, kExceptions> priority_{};
  std::array<bool, kExceptions> enabled_{}, pending_{}, active_{}, line_{};
  std::array<int, kExceptions> stack_{};
  int depth_ = 0;
  int pending_count_ = 0;  // enabled and pending: what may preempt
  int best_ = kThread;     // of these the most urgent

  std::uint32_t vtor_ = kBootVectors, aircr_ = 0, ccr_ = 0x200, scr_ = 0, shcsr_ = 0, cpacr_ = 0,
                fpccr_ = 0xC0000000u;
  std::uint32_t cfsr_ = 0, hfsr_ = 0, bfar_ = 0, demcr_ = 0, dwt_control_ = 0x40000000u;
  Cycle dwt_zero_ = 0;
  std::uint32_t dwt_frozen_ = 0;
  std::uint32_t systick_control_ = 0, systick_reload_ = 0;
  Cycle systick_zero_ = 0;  // when the count was at its reload value
  Cycle systick_event_ = kNever;
  bool reset_requested_ = false;
  std::uint32_t device_id_ = 0;
  bool small_ = false;
};

}  // namespace kinebus::emulator
