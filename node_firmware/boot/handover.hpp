#pragma once
// What boot loader and program tell each other through a reset, in RAM that keeps its content.

#include <cstdint>

#include "node_firmware/boot/image_header.hpp"

namespace kinebus {

struct Handover {
  static constexpr std::uint32_t kMagic = 0x4B42'484F;
  /// A program that has not run well for its first seconds, so often in a row, is not started again.
  static constexpr std::uint32_t kMostStarts = 5;
  /// `stay`: the boot loader; the chip's own boot loader (USB DFU).
  static constexpr std::uint32_t kBootLoader = 1, kSystemBoot = 2;

  std::uint32_t magic = kMagic;
  std::uint32_t stay = 0;     ///< to whom the program was asked to give way
  std::uint32_t node_id = 0;  ///< of the program then, 0: none
  std::uint32_t starts = 0;   ///< since the program last proved itself
};

/// At reset, before anything else: was the chip's own boot loader asked for? Once.
constexpr bool start_system_boot(Handover& handover) {
  if (handover.magic != Handover::kMagic || handover.stay != Handover::kSystemBoot) return false;
  handover.stay = 0;
  return true;
}

/// At reset: start the program? Counts the start.
constexpr bool start_program(Handover& handover, ImageCheck image) {
  if (handover.magic != Handover::kMagic) handover = Handover{};
  const bool start =
      image == ImageCheck::kGood && handover.stay == 0 && handover.starts < Handover::kMostStarts;
  if (start) ++handover.starts;
  return start;
}

}  // namespace kinebus
