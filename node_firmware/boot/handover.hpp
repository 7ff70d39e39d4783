#pragma once
// What boot loader and program tell each other through a reset, in RAM that keeps its content.

#include <cstdint>

#include "node_firmware/boot/image_header.hpp"

namespace kinebus {

struct Handover {
  static constexpr std::uint32_t kMagic = 0x4B42'484F;
  /// A program that has not run well for its first seconds, so often in a row, is not started again.
  static constexpr std::uint32_t kMostStarts = 5;

  std::uint32_t magic = kMagic;
  std::uint32_t stay = 0;     ///< 1: the program was asked to give way to the boot loader
  std::uint32_t node_id = 0;  ///< of the program then, 0: none
  std::uint32_t starts = 0;   ///< since the program last proved itself
};

/// At reset, before anything else: start the program? Counts the start.
constexpr bool start_program(Handover& handover, ImageCheck image) {
  if (handover.magic != Handover::kMagic) handover = Handover{};
  const bool start =
      image == ImageCheck::kGood && handover.stay == 0 && handover.starts < Handover::kMostStarts;
  if (start) ++handover.starts;
  return start;
}

}  // namespace kinebus
