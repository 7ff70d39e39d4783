// The processor as a debugger sees it: memory, calls of the program's functions, where its cycles go.

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "vcan_tests/emulator/cpu/cortex_m4.hpp"
#include "vcan_tests/emulator/cpu/unicorn_registers.hpp"

namespace kinebus::emulator {

void CortexM4::start_profile() {
  profile_.assign(kFlashSize / 2, 0);
}

std::uint64_t CortexM4::profiled_cycles(std::uint32_t begin, std::uint32_t end) const {
  std::uint64_t sum = 0;
  for (std::uint32_t at = begin; at < end && (at - kFlash) / 2 < profile_.size(); at += 2)
    sum += profile_[(at - kFlash) / 2];
  return sum;
}

void CortexM4::on_watched() {
  if (!running_.empty()) return;
  if (watch_at_ == watched_function_) {
    watch_began_ = now_;
    watch_began_own_ = own_cycles_;
    watch_at_ = read_register(uc_, UC_ARM_REG_LR) & ~1u;
    return;
  }
  ++watched_.calls;
  watched_.worst = std::max(watched_.worst, now_ - watch_began_);
  watched_.worst_own = std::max(watched_.worst_own, own_cycles_ - watch_began_own_);
  watch_at_ = watched_function_;
}

std::uint32_t CortexM4::lr() const {
  return read_register(uc_, UC_ARM_REG_LR);
}

std::uint32_t CortexM4::peek(std::uint32_t address) {
  const std::uint8_t* at = host(address, 4);
  if (at == nullptr) throw std::out_of_range("no memory there");
  std::uint32_t value = 0;
  std::memcpy(&value, at, 4);
  return value;
}

void CortexM4::poke(std::uint32_t address, std::uint32_t value) {
  std::uint8_t* at = host(address, 4);
  if (at == nullptr) throw std::out_of_range("no memory there");
  std::memcpy(at, &value, 4);
}

std::optional<std::uint64_t> CortexM4::call(std::uint32_t function, std::uint64_t argument) {
  uc_context* saved = nullptr;
  check(uc_context_alloc(engine(uc_), &saved), "context");
  check(uc_context_save(engine(uc_), saved), "context");
  // Below a frame that the interrupted code may use under its stack pointer.
  const std::uint32_t sp = (read_register(uc_, UC_ARM_REG_SP) - 256) & ~7u;
  write_register(uc_, UC_ARM_REG_SP, sp);
  write_register(uc_, UC_ARM_REG_R0, static_cast<std::uint32_t>(argument));
  write_register(uc_, UC_ARM_REG_R1, static_cast<std::uint32_t>(argument >> 32));
  write_register(uc_, UC_ARM_REG_LR, kCallReturn);
  // Flags and exception number stay; an IT block in progress, whose conditions would hold for the function's
  // first instructions, comes back with the context.
  constexpr std::uint32_t kItState = 0x0600FC00;
  write_register(uc_, UC_ARM_REG_XPSR, read_register(uc_, UC_ARM_REG_XPSR) & ~kItState);
  call_ = Call::kRunning;
  call_blocks_ = 0;
  uc_emu_start(engine(uc_), function | 1, 0, 0, 0);
  const bool good = call_ == Call::kDone;
  call_ = Call::kNone;
  const std::uint64_t result =
      std::uint64_t{read_register(uc_, UC_ARM_REG_R1)} << 32 | read_register(uc_, UC_ARM_REG_R0);
  check(uc_context_restore(engine(uc_), saved), "context");
  uc_context_free(saved);
  if (!good) return std::nullopt;
  return result;
}

}  // namespace kinebus::emulator
