// Exception entry and return of the processor, with the floating-point context, and what each of them cost.

#include <algorithm>
#include <cstring>

#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/cpu/unicorn_registers.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kEntryCycles = 12, kReturnCycles = 10;
constexpr std::uint32_t kSmallEntryCycles = 15, kSmallReturnCycles = 13;
constexpr std::uint32_t kControlFpca = 4, kControlSpsel = 2;
constexpr std::uint32_t kXpsrException = 0x1FF, kXpsrAligned = 1u << 9, kXpsrThumb = 1u << 24,
                        kXpsrFlags = 0xF80F0000u;
constexpr std::uint32_t kBasicFrame = 32, kFloatFrame = 104;
constexpr std::uint32_t kExcReturn = 0xFFFFFF00;

std::array<int, 17> float_registers() {
  std::array<int, 17> ids{};
  for (int i = 0; i < 16; ++i) ids[static_cast<std::size_t>(i)] = UC_ARM_REG_S0 + i;
  ids[16] = UC_ARM_REG_FPSCR;
  return ids;
}

}  // namespace

bool CortexM4::take_exception(std::uint32_t return_address) {
  if (nvic_.next_exception({}) == kThread) return false;
  static std::array<int, 3> ids{UC_ARM_REG_PRIMASK, UC_ARM_REG_BASEPRI, UC_ARM_REG_FAULTMASK};
  std::array<std::uint32_t, 3> masks{};
  read_registers(uc_, ids, masks);
  const int exception = nvic_.next_exception({masks[0], masks[1], masks[2]});
  if (exception == kThread) return false;
  enter(exception, return_address);
  return true;
}

void CortexM4::begin_count(int exception) {
  running_.push_back({exception, 0, facts_.small ? kSmallEntryCycles : kEntryCycles});
  ExceptionCost& cost = costs_[static_cast<std::size_t>(exception)];
  if (pending_since_ != kNever) cost.worst_latency = std::max(cost.worst_latency, now_ - pending_since_);
}

void CortexM4::end_count() {
  const Running done = running_.back();
  running_.pop_back();
  ExceptionCost& cost = costs_[static_cast<std::size_t>(done.exception)];
  cost.calls += 1;
  cost.instructions += done.instructions;
  cost.cycles += done.cycles;
  cost.worst_instructions = std::max(cost.worst_instructions, static_cast<std::uint32_t>(done.instructions));
  cost.worst_cycles = std::max(cost.worst_cycles, static_cast<std::uint32_t>(done.cycles));
}

void CortexM4::enter(int exception, std::uint32_t return_address) {
  static std::array<int, 9> ids{UC_ARM_REG_R0, UC_ARM_REG_R1,      UC_ARM_REG_R2,
                                UC_ARM_REG_R3, UC_ARM_REG_R12,     UC_ARM_REG_LR,
                                UC_ARM_REG_SP, UC_ARM_REG_CONTROL, UC_ARM_REG_XPSR};
  std::array<std::uint32_t, 9> values{};
  read_registers(uc_, ids, values);
  const std::uint32_t control = values[7];
  if ((control & kControlSpsel) != 0) failure_ = "the process stack is not modelled";
  const bool with_float = (control & kControlFpca) != 0;
  if (with_float && !nvic_.fpu_enabled()) failure_ = "floating point used, but CPACR does not enable it";

  std::uint32_t sp = values[6];
  const std::uint32_t aligned = (sp & 4) != 0 ? kXpsrAligned : 0;
  sp = (sp - (with_float ? kFloatFrame : kBasicFrame)) & ~7u;
  lowest_stack_ = std::min(lowest_stack_, sp);
  std::uint8_t* frame = host(sp, with_float ? kFloatFrame : kBasicFrame);
  if (frame == nullptr) {
    failure_ = "stack pointer outside RAM at exception entry";
    return;
  }
  // Flags and the state of an IT block in progress (blocks of the emulation end in the middle of one at page
  // ends).
  const std::uint32_t xpsr = (values[8] & ~(kXpsrException | kXpsrAligned)) | kXpsrThumb | aligned |
                             static_cast<std::uint32_t>(nvic_.active_exception());
  std::array<std::uint32_t, 8> words{values[0], values[1], values[2],      values[3],
                                     values[4], values[5], return_address, xpsr};
  std::memcpy(frame, words.data(), kBasicFrame);
  if (with_float) {
    static std::array<int, 17> float_ids = float_registers();
    std::array<std::uint32_t, 17> floats{};
    read_registers(uc_, float_ids, floats);
    std::memcpy(frame + kBasicFrame, floats.data(), sizeof floats);
  }
  const std::uint32_t exc_return = 0xFFFFFFE1u | (with_float ? 0 : 0x10u) | (nvic_.depth() == 0 ? 0x8u : 0);
  begin_count(exception);
  nvic_.enter(exception);
  pending_since_ = nvic_.any_pending() ? now_ : kNever;
  elapse(facts_.small ? kSmallEntryCycles : kEntryCycles);

  const std::uint8_t* vector = host(nvic_.vector_table() + 4 * static_cast<std::uint32_t>(exception), 4);
  std::uint32_t handler = 0;
  if (vector != nullptr) std::memcpy(&handler, vector, 4);
  if ((handler & 1) == 0) failure_ = "no handler for exception " + std::to_string(exception);
  static std::array<int, 5> to{UC_ARM_REG_SP, UC_ARM_REG_LR, UC_ARM_REG_CONTROL, UC_ARM_REG_XPSR,
                               UC_ARM_REG_PC};
  std::array<std::uint32_t, 5> set{
      sp, exc_return, control & ~kControlFpca,
      (values[8] & kXpsrFlags) | kXpsrThumb | static_cast<std::uint32_t>(exception), handler | 1};
  write_registers(uc_, to, set);
  pc_ = handler & ~1u;
  next_stop_ = 0;
}

void CortexM4::return_from_exception(std::uint32_t exc_return) {
  if (nvic_.depth() == 0) {
    failure_ = "exception return outside an exception";
    return;
  }
  const int exception = nvic_.active_exception();
  nvic_.leave(exception);
  count(0, facts_.small ? kSmallReturnCycles : kReturnCycles);
  end_count();

  const bool with_float = (exc_return & 0x10) == 0;
  std::uint32_t sp = read_register(uc_, UC_ARM_REG_SP);
  const std::uint32_t size = with_float ? kFloatFrame : kBasicFrame;
  const std::uint8_t* frame = host(sp, size);
  if (frame == nullptr) {
    failure_ = "stack pointer outside RAM at exception return";
    return;
  }
  std::array<std::uint32_t, 8> words{};
  std::memcpy(words.data(), frame, kBasicFrame);
  if (with_float) {
    static std::array<int, 17> float_ids = float_registers();
    std::array<std::uint32_t, 17> floats{};
    std::memcpy(floats.data(), frame + kBasicFrame, sizeof floats);
    write_registers(uc_, float_ids, floats);
  }
  const std::uint32_t xpsr = words[7];
  sp += size;
  if ((xpsr & kXpsrAligned) != 0) sp |= 4;
  std::uint32_t control = read_register(uc_, UC_ARM_REG_CONTROL);
  control = with_float ? control | kControlFpca : control & ~kControlFpca;
  if ((xpsr & kXpsrException) != static_cast<std::uint32_t>(nvic_.active_exception()))
    failure_ = "exception return to a wrong frame";

  static std::array<int, 10> ids{UC_ARM_REG_R0,   UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3,
                                 UC_ARM_REG_R12,  UC_ARM_REG_LR, UC_ARM_REG_SP, UC_ARM_REG_CONTROL,
                                 UC_ARM_REG_XPSR, UC_ARM_REG_PC};
  std::array<std::uint32_t, 10> set{
      words[0],    words[1], words[2], words[3], words[4], words[5], sp, control, xpsr & ~kXpsrAligned,
      words[6] | 1};
  write_registers(uc_, ids, set);
  pc_ = words[6] & ~1u;
  next_stop_ = 0;
}

void CortexM4::on_intr(std::uint32_t number) {
  const std::uint32_t pc = read_register(uc_, UC_ARM_REG_PC);
  if (call_ != Call::kNone) {
    if ((number == 3 || number == 8) && (pc | 1) == kCallReturn) call_ = Call::kDone;
    uc_emu_stop(engine(uc_));
    return;
  }
  if ((number == 3 || number == 8) && (pc | 1) >= kExcReturn) {
    return_from_exception(pc | 1);
    return;
  }
  if (number == 2) {
    nvic_.pend(kSvCall);
    next_stop_ = 0;
    return;
  }
  failure_ =
      number == 7 ? "breakpoint instruction" : "exception " + std::to_string(number) + " of the processor";
  pc_ = pc & ~1u;
  stopped_ = true;
  uc_emu_stop(engine(uc_));
}

bool CortexM4::wakes() const {
  // WFI goes on for whatever would preempt if PRIMASK were clear.
  return nvic_.next_exception({0, read_register(uc_, UC_ARM_REG_BASEPRI), 0}) != kThread;
}

}  // namespace kinebus::emulator
