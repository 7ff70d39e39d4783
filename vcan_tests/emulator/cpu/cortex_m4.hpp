#pragma once
// The processor: Unicorn executes Thumb-2 code, this class does what a Cortex-M4 does around it: time,
// exception entry and return with the floating-point context, WFI, reset. Deterministic: the same image and
// inputs give the same run, cycle for cycle.
//
// Time is the sum of estimated instruction timings (cycle_estimate.hpp), counted a basic block at a time;
// interrupts are taken between blocks.

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vcan_tests/emulator/cpu/elf_image.hpp"
#include "vcan_tests/emulator/cpu/nvic.hpp"
#include "vcan_tests/emulator/cycle.hpp"

namespace kinebus::emulator {

/// Everything outside the processor: registers and their life in time.
class Devices {
 public:
  virtual ~Devices() = default;
  virtual std::uint32_t read(std::uint32_t address, int size, Cycle now) = 0;
  virtual void write(std::uint32_t address, std::uint32_t value, int size, Cycle now) = 0;
  /// A store of the program to flash: the flash controller decides. True: memory has changed.
  virtual bool write_flash(std::uint32_t address, std::uint32_t value, int size, Cycle now) = 0;
  virtual Cycle next_event() const = 0;
  virtual void advance(Cycle now) = 0;
};

/// What an interrupt cost; preemption by others is not counted.
struct ExceptionCost {
  std::uint64_t calls = 0;
  std::uint64_t instructions = 0, cycles = 0;  ///< clocks of the core
  std::uint32_t worst_instructions = 0, worst_cycles = 0;
  Cycle worst_latency = 0;  ///< from pending (as the processor saw it) to the first instruction
};

/// What calls of a function cost outside interrupts.
struct CallCost {
  std::uint64_t calls = 0;
  Cycle worst = 0;      ///< from call to return, with the interrupts that came in between
  Cycle worst_own = 0;  ///< without them
};

/// How a core differs from that of the F405. The other one that is modelled is the Cortex-M0+, whose
/// instructions, exceptions and registers are a part of the Cortex-M4's.
struct CoreFacts {
  bool core_coupled_memory = true;  ///< the F405 has it, the F446 has not
  bool small = false;               ///< a Cortex-M0+
  Cycle cycles = 1, clocks = 1;     ///< so many Cycles are so many clocks of this core
  std::uint32_t system_memory = 0x1FFF7800;
};

class CortexM4 {
 public:
  static constexpr std::uint32_t kFlash = 0x08000000, kFlashSize = 1024 * 1024;
  static constexpr std::uint32_t kSram = 0x20000000, kSramSize = 128 * 1024;
  static constexpr std::uint32_t kCcm = 0x10000000, kCcmSize = 64 * 1024;
  static constexpr std::uint32_t kSystemMemorySize = 1024;
  /// Of an STM32F4, at the start of its system memory: programmed once, never erased.
  static constexpr std::uint32_t kOneTimeMemory = 0x1FFF7800, kOneTimeMemorySize = 512;
  /// Where the chip's own boot loader begins. Not its code: an endless loop, to see who arrives there.
  static constexpr std::uint32_t kSystemBoot = 0x1FFF0000, kSystemBootSize = 1024;

  explicit CortexM4(Devices& devices) : CortexM4(devices, CoreFacts{}) {}
  CortexM4(Devices& devices, const CoreFacts& facts);
  ~CortexM4();
  CortexM4(const CortexM4&) = delete;
  CortexM4& operator=(const CortexM4&) = delete;

  void load(const ElfImage& image);
  /// Starts with the vector table at `vectors`. RAM keeps what it has, as on the chip.
  void reset(std::uint32_t vectors = kFlash);
  /// Runs up to `limit` and at most a block further. Throws std::runtime_error with registers and reason when
  /// the program does what a processor would answer by a fault, or runs into a breakpoint.
  void run(Cycle limit);

  /// Ends run() before the next block: for devices that saw something that the processor must not outlive.
  void stop() {
    stop_asked_ = true;
    next_stop_ = 0;
  }
  /// The program stands still until then (flash is busy, and the program runs from it).
  void stall_until(Cycle until) {
    stalled_until_ = until;
    next_stop_ = 0;
  }
  /// Memory that may have been executed has changed under the processor.
  void forget_code() {
    flash_changed_ = true;
    next_stop_ = 0;
  }

  /// Calls a function of the program between two of its instructions, as a debugger does: no time passes, no
  /// interrupt comes, registers are as before. Empty: it ran into a fault or took more than a million
  /// instructions.
  std::optional<std::uint64_t> call(std::uint32_t function, std::uint64_t argument);
  bool asleep() const { return asleep_; }

  Cycle now() const { return now_; }
  std::uint64_t instructions() const { return instructions_; }
  const ExceptionCost& cost(int exception) const { return costs_[static_cast<std::size_t>(exception)]; }
  void clear_costs() {
    costs_ = {};
    watched_ = {};
    longest_pass_ = 0;
  }
  /// From now on the calls of the function at this address are measured.
  void watch(std::uint32_t function) { watched_function_ = watch_at_ = function & ~1u; }
  const CallCost& watched() const { return watched_; }
  /// The longest time from the end of one WFI to the next one, interrupts included.
  Cycle longest_pass() const { return longest_pass_; }
  /// From now on cycles are also counted by address.
  void start_profile();
  /// Estimated cycles spent in blocks that begin at begin .. end, in flash.
  std::uint64_t profiled_cycles(std::uint32_t begin, std::uint32_t end) const;
  /// Cycles spent asleep in WFI.
  Cycle idle() const { return idle_; }
  Nvic& nvic() { return nvic_; }
  const Nvic& nvic() const { return nvic_; }

  std::span<std::uint8_t> flash() { return flash_; }
  std::span<std::uint8_t> sram() { return {sram_, kSramSize}; }
  std::span<std::uint8_t> system_memory() { return {system_memory_, kSystemMemorySize}; }
  /// Where the program is, when it is not running.
  std::uint32_t pc() const { return pc_; }
  /// Its link register then: a return address, or whatever the compiler keeps in that register.
  std::uint32_t lr() const;
  /// As a debugger sees memory: flash, SRAM and CCM. Throws std::out_of_range.
  std::uint32_t peek(std::uint32_t address);
  void poke(std::uint32_t address, std::uint32_t value);
  /// Lowest stack pointer seen at any exception entry.
  std::uint32_t lowest_stack() const { return lowest_stack_; }

 private:
  struct Hooks;  // Unicorn's callbacks
  struct Running {
    int exception = 0;
    std::uint64_t instructions = 0;
    Cycle cycles = 0;
  };

  void on_block(std::uint32_t address, std::uint32_t size);
  void on_intr(std::uint32_t number);
  std::uint32_t mmio_read(std::uint32_t address, int size);
  void mmio_write(std::uint32_t address, std::uint32_t value, int size);
  void note_code(std::uint32_t address, std::uint32_t size);
  /// Whether anything near this place in flash was ever executed: else what is written there needs no new
  /// translation.
  bool has_run(std::uint32_t address) const { return code_pages_.test((address - kFlash) / kCodePage); }
  std::uint32_t code_cost(std::uint32_t address, std::uint32_t size);
  void serve_time();
  bool take_exception(std::uint32_t return_address);
  void return_from_exception(std::uint32_t exc_return);
  void enter(int exception, std::uint32_t return_address);
  void begin_count(int exception);
  void end_count();
  /// Returns the time that goes by.
  Cycle count(std::uint32_t instructions, std::uint32_t clocks);
  Cycle elapse(std::uint32_t clocks);
  void on_watched();
  bool wakes() const;
  std::uint8_t* host(std::uint32_t address, std::uint32_t size);
  [[noreturn]] void fail(const std::string& what);

  static constexpr std::uint32_t kCallReturn = 0xFFFFFF01;  // where a debugger's call returns to

  void* uc_ = nullptr;
  Devices& devices_;
  CoreFacts facts_;
  Cycle rest_ = 0;  // of elapse(), in parts of a Cycle
  Nvic nvic_;
  std::vector<std::uint8_t> flash_;
  std::uint8_t *sram_ = nullptr, *ccm_ = nullptr, *system_memory_ = nullptr, *system_boot_ = nullptr;
  std::vector<std::uint32_t>
      block_costs_;  // by flash half-word: instructions << 16 | cycles, 0: not yet known

  static constexpr std::uint32_t kCodePage = 1024;
  std::bitset<kFlashSize / kCodePage> code_pages_;  // in which a block began or ran on

  Cycle now_ = 0, limit_ = 0, next_stop_ = 0, idle_ = 0;
  std::uint64_t instructions_ = 0;
  std::uint32_t pc_ = 0;
  std::uint32_t skip_block_ = 1;  // a block that is begun again after a stop is not counted twice
  bool asleep_ = false;
  bool stop_asked_ = false;
  enum class Call : std::uint8_t { kNone, kRunning, kDone } call_ = Call::kNone;
  std::uint64_t call_blocks_ = 0;
  Cycle stalled_until_ = 0;
  bool stopped_ = false;  // by on_block, at a limit
  bool flash_changed_ = false;
  std::uint32_t lowest_stack_ = 0xFFFFFFFF;
  std::string failure_;

  std::array<ExceptionCost, Nvic::kExceptions> costs_{};
  std::vector<std::uint64_t> profile_;
  std::vector<Running> running_;
  Cycle pending_since_ = kNever;

  std::uint32_t watched_function_ = 1, watch_at_ = 1;  // an entry, or where the call returns to
  CallCost watched_;
  Cycle own_cycles_ = 0;  // outside exceptions
  Cycle watch_began_ = 0, watch_began_own_ = 0;
  Cycle pass_began_ = 0, longest_pass_ = 0;
};

}  // namespace kinebus::emulator
