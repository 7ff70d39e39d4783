#pragma once
// Filters as bxCAN's banks of 16-bit filters take them: two identifiers with masks a bank, or four without.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "node_firmware/board/drivers.hpp"

namespace kinebus::stm32 {

struct CanBanks {
  static constexpr std::size_t kBanks = 14;  ///< the others are CAN2's
  std::array<std::array<std::uint32_t, 2>, kBanks> words{};
  std::uint32_t used = 0, lists = 0;  ///< FA1R, FM1R
};

/// Whatever the bus carries.
inline constexpr CanBanks kEveryFrame{.words = {}, .used = 1, .lists = 0};

/// Standard identifiers alone. More than there is room for: everything is heard, and sorted
/// out later.
constexpr CanBanks pack_filters(std::span<const CanAccept> filters) {
  // Identifier, RTR, IDE, three bits of an extended identifier.
  constexpr std::uint32_t kKinds = 3u << 3, kRemote = 1u << 4;
  CanBanks banks;
  std::size_t bank = 0;
  for (const bool list : {false, true}) {
    const std::size_t most = list ? 4 : 2;
    std::size_t held = 0;
    for (const CanAccept& accept : filters) {
      if ((accept.mask == 0x7FF) != list) continue;
      if (bank == CanBanks::kBanks) return kEveryFrame;
      auto& words = banks.words[bank];
      const std::uint32_t id = std::uint32_t{accept.value} << 5 | (accept.remote ? kRemote : 0);
      const std::uint32_t word = list ? id << 16 | id : (std::uint32_t{accept.mask} << 5 | kKinds) << 16 | id;
      // What is left of a bank repeats its last one.
      if (held == 0) words = {word, word};
      if (list && held % 2 == 1) words[held / 2] = id << 16 | (words[held / 2] & 0xFFFF);
      if (held == most / 2) words[1] = word;
      banks.used |= 1u << bank;
      if (list) banks.lists |= 1u << bank;
      if (++held < most) continue;
      held = 0;
      ++bank;
    }
    if (held != 0) ++bank;
  }
  return banks;
}

}  // namespace kinebus::stm32
