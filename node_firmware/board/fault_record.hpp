#pragma once
// What a program that must end leaves for the next: why, and the registers then. It lies in RAM that a reset
// keeps (sections.ld) and that holds anything after power-on: hence the check.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "node_firmware/core/reset_report.hpp"

namespace kinebus {

struct FaultRecord {
  static constexpr std::uint32_t kMagic = 0x4B42'464C;

  std::uint32_t magic = 0;
  std::uint32_t reason = 0;
  std::array<std::uint32_t, 4> r{};  ///< r0 to r3
  std::uint32_t r12 = 0, lr = 0, pc = 0, psr = 0, sp = 0;
  std::uint32_t cfsr = 0, hfsr = 0, address = 0;
  std::uint32_t check = 0;

  constexpr void seal() {
    magic = kMagic;
    check = sum();
  }
  /// What is recorded; once.
  constexpr ResetReport take() {
    ResetReport report;
    if (magic == kMagic && check == sum())
      report = {.reason = static_cast<std::uint16_t>(reason),
                .pc = pc,
                .lr = lr,
                .cfsr = cfsr,
                .hfsr = hfsr,
                .address = address};
    magic = 0;
    return report;
  }

 private:
  constexpr std::uint32_t sum() const {
    std::uint32_t sum = 0;
    const auto words = std::bit_cast<std::array<std::uint32_t, 15>>(*this);
    for (std::size_t i = 0; i + 1 < words.size(); ++i) sum = std::rotl(sum, 1) + words[i];
    return sum;
  }
};
static_assert(sizeof(FaultRecord) <= 64, "as much room as sections.ld gives it");

}  // namespace kinebus
