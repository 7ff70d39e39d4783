#include "vcan_tests/emulator/cpu/cycle_estimate.hpp"

#include <bit>

namespace kinebus::emulator {
namespace {

constexpr std::uint32_t kTakenBranch = 3;  // 1, pipeline refill 1..3 less what prefetch hides, flash 1
constexpr std::uint32_t kConditionalBranch = 2;
constexpr std::uint32_t kIntegerDivision = 7;  // 2..12
constexpr std::uint32_t kFloatDivision = 14;

struct Cost {
  std::uint32_t cycles = 1;
  bool load = false;  // a load right after a load costs one cycle less
};

Cost narrow(std::uint16_t op) {
  const auto registers = [&](unsigned mask) { return static_cast<std::uint32_t>(std::popcount(op & mask)); };
  if ((op & 0xFE00) == 0xB400) return {1 + registers(0x1FF)};  // PUSH
  if ((op & 0xFE00) == 0xBC00) return {1 + registers(0x1FF) + ((op & 0x100) != 0 ? kTakenBranch : 0)};  // POP
  if ((op & 0xF000) == 0xC000) return {1 + registers(0xFF)};                            // LDM, STM
  if ((op & 0xFF00) == 0x4700) return {kTakenBranch};                                   // BX, BLX
  if ((op & 0xF800) == 0xE000) return {kTakenBranch};                                   // B
  if ((op & 0xF000) == 0xD000 && (op & 0xF00) < 0xE00) return {kConditionalBranch};     // Bcc
  if ((op & 0xF500) == 0xB100) return {kConditionalBranch};                             // CBZ
  if ((op & 0xF800) == 0x4800) return {2, true};                                        // LDR literal
  if ((op & 0xF000) == 0x5000) return (op & 0xE00) >= 0x600 ? Cost{2, true} : Cost{1};  // register offset
  if ((op & 0xE000) == 0x6000 || (op & 0xE000) == 0x8000)
    return (op & 0x800) != 0 && (op & 0xF000) != 0xA000 ? Cost{2, true} : Cost{1};
  return {1};
}

Cost wide(std::uint16_t first, std::uint16_t second) {
  if ((first & 0xFE40) == 0xE800) {  // LDM, STM
    const auto count = static_cast<std::uint32_t>(std::popcount(second));
    return {1 + count + ((first & 0x10) != 0 && (second & 0x8000) != 0 ? kTakenBranch : 0)};
  }
  if ((first & 0xFFF0) == 0xE8D0 && (second & 0xFFE0) == 0xF000) return {2 + kTakenBranch};  // TBB, TBH
  if ((first & 0xFE40) == 0xE840) return {3};  // LDRD, STRD, exclusives
  if ((first & 0xF800) == 0xF000 && (second & 0x8000) != 0) {
    const bool conditional = (second & 0x5000) == 0 && (first & 0x380) != 0x380;
    if ((second & 0x5000) == 0 && !conditional) return {2};  // MSR, MRS, barriers
    return {conditional ? kConditionalBranch : kTakenBranch};
  }
  if ((first & 0xFE00) == 0xF800)
    return (first & 0x10) != 0 ? Cost{2, true} : Cost{1};  // single load or store
  if ((first & 0xFFD0) == 0xFB90 && (second & 0xF0) == 0xF0) return {kIntegerDivision};
  if ((first & 0xEF00) == 0xEE00 && (second & 0xE00) == 0xA00) {  // floating point, data processing
    if ((second & 0x10) != 0) return {1};                         // VMOV to and from the core
    const unsigned operation = (first & 0xB0u) >> 4;
    if (operation == 8) return {kFloatDivision};
    if (operation == 0xB && (first & 0xF) == 1 && (second & 0xC0) == 0xC0) return {kFloatDivision};  // VSQRT
    if (operation <= 1 || operation == 9 || operation == 0xA) return {3};  // multiply with accumulate
    return {1};
  }
  if ((first & 0xFE00) == 0xEC00 && (second & 0xE00) == 0xA00) {  // VLDR, VSTR, VLDM, VSTM, VPUSH
    if ((first & 0x120) == 0x100) return (first & 0x10) != 0 ? Cost{2, true} : Cost{1};
    return {1 + (second & 0xFFu)};
  }
  return {1};
}

// Cortex-M0+: two stages, no divider, single-cycle multiplier.
constexpr std::uint32_t kFlashWaits = 2;
std::uint32_t small(std::uint16_t op, std::uint32_t waits) {
  const auto registers = [&](unsigned mask) { return static_cast<std::uint32_t>(std::popcount(op & mask)); };
  if ((op & 0xFE00) == 0xB400) return 1 + registers(0x1FF);                                        // PUSH
  if ((op & 0xFE00) == 0xBC00) return 1 + registers(0x1FF) + ((op & 0x100) != 0 ? 2 + waits : 0);  // POP
  if ((op & 0xF000) == 0xC000) return 1 + registers(0xFF);                                         // LDM, STM
  if ((op & 0xFF00) == 0x4700 || (op & 0xF800) == 0xE000) return 2 + waits;                        // BX, B
  if ((op & 0xFF87) == 0x4687) return 2 + waits;                                                   // MOV PC
  if ((op & 0xF000) == 0xD000 && (op & 0xF00) < 0xE00)
    return waits == 0 ? 2 : 3;                    // Bcc: 1, or 2 and the wait states when taken
  if ((op & 0xF800) == 0x4800) return 2 + waits;  // LDR literal
  if ((op & 0xF000) == 0x5000 || (op & 0xE000) == 0x6000) return 2;
  if ((op & 0xF000) == 0x8000 || (op & 0xF000) == 0x9000) return 2;
  return 1;
}

}  // namespace

bool small_core_runs(std::span<const std::uint16_t> code) {
  for (std::size_t i = 0; i < code.size();) {
    const std::uint16_t op = code[i];
    if (thumb_length(op) == 1) {
      const bool compare_branch = (op & 0xF500) == 0xB100;              // CBZ, CBNZ
      const bool if_then = (op & 0xFF00) == 0xBF00 && (op & 0xF) != 0;  // IT
      if (compare_branch || if_then) return false;
      ++i;
      continue;
    }
    if (i + 1 == code.size()) return true;
    const std::uint16_t second = code[i + 1];
    const bool link = (op & 0xF800) == 0xF000 && (second & 0xD000) == 0xD000;                 // BL
    const bool special = (op & 0xFFE0) == 0xF380 || (op & 0xFFF0) == 0xF3B0 || op == 0xF3EF;  // MSR, DSB, MRS
    if (!link && !special) return false;
    i += 2;
  }
  return true;
}

CodeCost estimate_small_cost(std::span<const std::uint16_t> code, bool in_flash) {
  const std::uint32_t waits = in_flash ? kFlashWaits : 0;
  CodeCost total;
  for (std::size_t i = 0; i < code.size(); ++total.instructions) {
    const bool two = thumb_length(code[i]) == 2 && i + 1 < code.size();
    total.cycles += two ? 3 + waits : small(code[i], waits);  // BL; barriers and special registers take 3
    i += two ? 2 : 1;
  }
  return total;
}

CodeCost estimate_cost(std::span<const std::uint16_t> code) {
  CodeCost total;
  bool after_load = false;
  for (std::size_t i = 0; i < code.size();) {
    const bool two = thumb_length(code[i]) == 2 && i + 1 < code.size();
    const Cost cost = two ? wide(code[i], code[i + 1]) : narrow(code[i]);
    total.cycles += cost.cycles - (cost.load && after_load ? 1 : 0);
    total.instructions += 1;
    after_load = cost.load;
    i += two ? 2 : 1;
  }
  return total;
}

}  // namespace kinebus::emulator
