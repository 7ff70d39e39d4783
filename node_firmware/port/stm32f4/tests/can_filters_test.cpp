// Filter banks, compared with frames as the controller does.

#include "node_firmware/port/stm32f4/can_filters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace kinebus::stm32 {
namespace {

/// As bxCAN compares a frame with a bank of 16-bit filters.
bool passes(const CanBanks& banks, std::uint32_t id, bool remote, bool extended) {
  const std::uint32_t seen = id << 5 | (remote ? 1u << 4 : 0) | (extended ? 1u << 3 : 0);
  for (std::size_t i = 0; i < CanBanks::kBanks; ++i) {
    if ((banks.used >> i & 1) == 0) continue;
    for (const std::uint32_t word : banks.words[i]) {
      if ((banks.lists >> i & 1) != 0) {
        if (seen == (word & 0xFFFF) || seen == word >> 16) return true;
      } else if (((seen ^ word) & word >> 16 & 0xFFFF) == 0) {
        return true;
      }
    }
  }
  return false;
}

TEST(CanFilters, LetThroughWhatIsWantedAndNothingElse) {
  for (std::size_t count = 0; count <= 53; ++count) {
    std::vector<CanAccept> wanted{{0x080, 0x780}, {0x000, 0x7FF}};
    for (std::size_t i = 0; i < count; ++i)
      wanted.push_back({static_cast<std::uint16_t>(0x201 + 13 * i), 0x7FF});
    const CanBanks banks = pack_filters(wanted);
    const bool fits = count + 1 <= 4 * 13;
    for (std::uint32_t id = 0; id < 0x800; ++id) {
      const bool in_list =
          std::ranges::any_of(wanted, [&](const CanAccept& a) { return (id & a.mask) == a.value; });
      EXPECT_EQ(passes(banks, id, false, false), in_list || !fits) << count << ", " << std::hex << id;
      if (fits) {
        EXPECT_FALSE(passes(banks, id, true, false) || passes(banks, id, false, true));
      }
    }
  }
}

// Of node guarding: remote frames of one identifier, and no data frames with it.
TEST(CanFilters, LetARemoteFrameThroughWhereThatIsWanted) {
  std::vector<CanAccept> wanted{{0x080, 0x780}, {0x000, 0x6FF}, {0x605, 0x7FF}, {0x705, 0x7FF, true}};
  for (int more = 0; more < 4; ++more) {
    const CanBanks banks = pack_filters(wanted);
    for (std::uint32_t id = 0; id < 0x800; ++id) {
      EXPECT_EQ(passes(banks, id, true, false), id == 0x705) << more << ", " << std::hex << id;
      EXPECT_EQ(passes(banks, id, false, false),
                std::ranges::any_of(
                    wanted, [&](const CanAccept& a) { return !a.remote && (id & a.mask) == a.value; }))
          << more << ", " << std::hex << id;
    }
    wanted.push_back({static_cast<std::uint16_t>(0x201 + more), 0x7FF});
  }
}

}  // namespace
}  // namespace kinebus::stm32
