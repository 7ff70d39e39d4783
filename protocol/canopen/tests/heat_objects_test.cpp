#include "protocol/canopen/heat_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace kinebus {
namespace {

TEST(HeatTable, HasItsProfileAndEveryHeadIsTrue) {
  const int type = kHeatTable.find({0x1000, 0});
  ASSERT_GE(type, 0);
  EXPECT_EQ(kHeatTable[type].initial() & 0xFFFF, 0x0194) << "CiA 404";
  EXPECT_LT(kHeatTable.find({0x6040, 0}), 0) << "no axis";
  for (const ObjectEntry& head : kHeatObjects) {
    EXPECT_TRUE(head.binding != Binding::kParameter || head.writable()) << head.address.index;
    if (head.code == ObjectCode::kVar || head.address.subindex != 0 || head.writable()) continue;
    int highest = 0;
    for (const ObjectEntry& e : kHeatObjects)
      if (e.address.index == head.address.index) highest = e.address.subindex;
    EXPECT_EQ(head.initial(), highest) << std::hex << head.address.index;
  }
}

TEST(HeatTable, ArraysLieInARow) {
  // What heat_slot_of(first) + n relies on.
  for (const ObjectEntry& e : kHeatObjects) {
    if (e.code != ObjectCode::kArray || e.address.subindex < 2) continue;
    const int before = kHeatTable.find({e.address.index, static_cast<std::uint8_t>(e.address.subindex - 1)});
    ASSERT_GE(before, 0);
    EXPECT_EQ(kHeatTable[before].slot + 1, e.slot) << std::hex << e.address.index;
  }
}

TEST(HeatTable, DefaultPdosMapWhatMayBeMapped) {
  const auto check = [](const object_table::PdoDefault& pdo, Mapping kind) {
    std::uint32_t bits = 0;
    for (const std::uint32_t mapping : pdo.map) {
      if (mapping == 0) break;
      const int place = kHeatTable.find(
          {static_cast<std::uint16_t>(mapping >> 16), static_cast<std::uint8_t>(mapping >> 8)});
      ASSERT_GE(place, 0) << pdo.name << std::hex << mapping;
      EXPECT_TRUE(kHeatTable[place].maps_to(kind)) << pdo.name;
      EXPECT_EQ(kHeatTable[place].size() * 8u, mapping & 0xFF) << pdo.name;
      bits += mapping & 0xFF;
    }
    EXPECT_LE(bits, 64u) << pdo.name;
  };
  for (const auto& pdo : object_table::kHeatRpdos) check(pdo, Mapping::kRpdo);
  for (const auto& pdo : object_table::kHeatTpdos) check(pdo, Mapping::kTpdo);
}

}  // namespace
}  // namespace kinebus
