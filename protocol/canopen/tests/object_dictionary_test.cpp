#include "protocol/canopen/object_dictionary.hpp"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace kinebus {
namespace {

class Owner : public ObjectOwner {
 public:
  AbortCode read(const ObjectEntry& entry, std::int64_t& value) override {
    value = live[entry.address.key()];
    return AbortCode::kNone;
  }
  AbortCode write(const ObjectEntry& entry, std::int64_t value) override {
    if (refusal != AbortCode::kNone) return refusal;
    live[entry.address.key()] = value;
    return AbortCode::kNone;
  }
  std::map<std::uint32_t, std::int64_t> live;
  AbortCode refusal = AbortCode::kNone;
};

AbortCode read(ObjectDictionary& objects, ObjectAddress address, std::uint64_t& value) {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t length = 0;
  const AbortCode code = objects.read(address, bytes, length);
  value = 0;
  for (std::size_t i = 0; i < length && i < 8; ++i) value |= static_cast<std::uint64_t>(bytes[i]) << (8 * i);
  return code;
}

TEST(ObjectTable, IsConsistent) {
  for (const ObjectEntry& e : kNodeObjects) {
    const auto where = std::string(names_of(e).object) + " / " + std::string(names_of(e).name);
    EXPECT_FALSE(names_of(e).name.empty()) << where;
    EXPECT_GE(find_object({e.address.index, 0}), 0) << where;
    EXPECT_EQ(names_of(e).object,
              kNodeObjectNames[static_cast<std::size_t>(find_object({e.address.index, 0}))].object)
        << where;
    if (e.limited) {
      EXPECT_LE(e.low(), e.high()) << where;
      EXPECT_TRUE(e.binding == Binding::kLive || (e.initial() >= e.low() && e.initial() <= e.high()))
          << where;
    }
    EXPECT_TRUE(e.binding != Binding::kConstant || !e.writable()) << where;
    EXPECT_TRUE(e.binding != Binding::kParameter || e.writable()) << where;
    EXPECT_TRUE(!e.maps_to(Mapping::kRpdo) || e.writable()) << where;
    EXPECT_TRUE(!e.maps_to(Mapping::kTpdo) || e.readable()) << where;
    EXPECT_TRUE(e.mapping == Mapping::kNone || e.type != DataType::kString) << where;
    EXPECT_TRUE(e.type == DataType::kString ||
                value_of(e.type, static_cast<std::uint64_t>(e.initial())) == e.initial())
        << where;
    if (e.axis == 0) {
      const int twin =
          find_object({static_cast<std::uint16_t>(e.address.index + kAxisOffset), e.address.subindex});
      ASSERT_GE(twin, 0) << where;
      EXPECT_EQ(kNodeObjects[static_cast<std::size_t>(twin)].base(), e.address);
      EXPECT_EQ(kNodeObjects[static_cast<std::size_t>(twin)].axis, 1);
    }
  }
}

// The axis pair's units, and one more of its own in between by address.
struct WiderBoard {
  static constexpr BoardFacts kFacts{.name = "wider", .device_name = "Wider", .product_code = 7};
  static constexpr void compose(object_table::Rows& t) {
    Stm32f405Board::compose(t);
    t.head(0x2300, "Lamps", ObjectCode::kArray, 1);
    t.sub(1, "Lamp 1", DataType::kU8, Access::kReadWrite, Binding::kParameter, 3).between(0, 5);
  }
};
// No axis, no PDO.
struct BareBoard {
  static constexpr BoardFacts kFacts{.name = "bare", .device_name = "Bare", .product_code = 8};
  static constexpr void compose(object_table::Rows& t) {
    t.var(0x2300, "Lamp", DataType::kU8, Access::kReadWrite, Binding::kParameter, 1);
    object_table::communication(t, kFacts);
  }
};

TEST(ObjectTable, IsComposedOfUnitsByBoard) {
  constexpr const ObjectTable& wider = BoardObjects<WiderBoard>::kTable;
  constexpr const ObjectTable& bare = BoardObjects<BareBoard>::kTable;
  EXPECT_EQ(wider.entries.size(), kNodeObjectCount + 2);
  static_assert(shares_slots(kNodeTable, wider), "the axis pair's core serves it");
  static_assert(!shares_slots(kNodeTable, bare));
  EXPECT_EQ(wider[wider.find({0x2300, 1})].high(), 5);
  EXPECT_EQ(BoardObjects<WiderBoard>::kNames[static_cast<std::size_t>(wider.find({0x2300, 1}))].name,
            "Lamp 1");
  EXPECT_LT(wider.find({0x2300, 1}), wider.find({0x6040, 0})) << "by address";
  EXPECT_GE(bare.find({0x1018, 2}), 0);
  EXPECT_LT(bare.find({0x6040, 0}), 0);
}

TEST(ObjectDictionary, ServesTheTableOfAnyBoard) {
  Owner owner;
  SizedDictionary<kNodeObjectCount + 2> wider(owner, 4, BoardObjects<WiderBoard>::kTable);
  EXPECT_EQ(wider.value(slot_of(object::kStopRamp)), 100) << "where the axis pair's core looks";
  std::uint64_t value = 0;
  EXPECT_EQ(read(wider, {0x2300, 1}, value), AbortCode::kNone);
  EXPECT_EQ(value, 3u);
  SizedDictionary<64> bare(owner, 4, BoardObjects<BareBoard>::kTable);
  EXPECT_EQ(read(bare, {0x2300, 0}, value), AbortCode::kNone);
  EXPECT_EQ(value, 1u);
  EXPECT_EQ(read(bare, {0x1200, 1}, value), AbortCode::kNone);
  EXPECT_EQ(value, 0x604u);
  EXPECT_EQ(read(bare, {0x6040, 0}, value), AbortCode::kNoObject);
}

TEST(ObjectTable, HighestSubindexIsTrue) {
  for (const ObjectEntry& head : kNodeObjects) {
    if (head.code == ObjectCode::kVar || head.address.subindex != 0 || head.writable()) continue;
    int highest = 0;
    for (const ObjectEntry& e : kNodeObjects)
      if (e.address.index == head.address.index) highest = e.address.subindex;
    EXPECT_EQ(head.initial(), highest) << names_of(head).object;
  }
}

TEST(ObjectTable, DefaultPdosMapWhatMayBeMapped) {
  using namespace object_table;
  const auto check = [](std::uint32_t mapping, Mapping kind) {
    const int slot =
        find_object({static_cast<std::uint16_t>(mapping >> 16), static_cast<std::uint8_t>(mapping >> 8)});
    ASSERT_GE(slot, 0) << std::hex << mapping;
    const ObjectEntry& entry = kNodeObjects[static_cast<std::size_t>(slot)];
    EXPECT_TRUE(entry.maps_to(kind)) << names_of(entry).name;
    EXPECT_EQ(entry.size() * 8u, mapping & 0xFF) << names_of(entry).name;
  };
  for (const auto& pdo : kAxisPairRpdos)
    for (const auto m : pdo.map)
      if (m != 0) check(m, Mapping::kRpdo);
  for (const auto& pdo : kAxisPairTpdos)
    for (const auto m : pdo.map)
      if (m != 0) check(m, Mapping::kTpdo);
}

TEST(ObjectDictionary, ReadsConstantsStringsParametersAndLiveValues) {
  Owner owner;
  owner.live[object::kErrorRegister.key()] = 0x11;
  NodeDictionary objects(owner, 3);
  std::uint64_t value = 0;
  EXPECT_EQ(read(objects, object::kDeviceType, value), AbortCode::kNone);
  EXPECT_EQ(value, 0xFFFF0192u);
  EXPECT_EQ(read(objects, object::kErrorRegister, value), AbortCode::kNone);
  EXPECT_EQ(value, 0x11u);
  EXPECT_EQ(read(objects, {0x1200, 1}, value), AbortCode::kNone);
  EXPECT_EQ(value, 0x603u) << "relative to the node id";
  std::array<std::uint8_t, 64> bytes{};
  std::size_t length = 0;
  EXPECT_EQ(objects.read({0x1008, 0}, bytes, length), AbortCode::kNone);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)),
            "Kinebus two-axis node");
}

TEST(ObjectDictionary, RefusesAsCiaSays) {
  Owner owner;
  NodeDictionary objects(owner, 1);
  std::uint64_t value = 0;
  const std::array<std::uint8_t, 8> eight{};
  const auto zeros = [&](std::size_t n) { return std::span(eight).first(n); };
  EXPECT_EQ(read(objects, {0x5000, 0}, value), AbortCode::kNoObject);
  EXPECT_EQ(read(objects, {0x1018, 9}, value), AbortCode::kNoSubindex);
  EXPECT_EQ(read(objects, object::kSegmentRecord, value), AbortCode::kWriteOnly);
  EXPECT_EQ(objects.write(object::kDeviceType, zeros(4)), AbortCode::kReadOnly);
  EXPECT_EQ(objects.write(object::kStopRamp, zeros(1)), AbortCode::kTooShort);
  EXPECT_EQ(objects.write(object::kStopRamp, zeros(4)), AbortCode::kTooLong);
  EXPECT_EQ(objects.write(object::kStopRamp, zeros(2)), AbortCode::kTooLow);
  const std::array<std::uint8_t, 2> high{0xFF, 0xFF};
  EXPECT_EQ(objects.write(object::kStopRamp, high), AbortCode::kTooHigh);
  owner.refusal = AbortCode::kDeviceState;
  const std::array<std::uint8_t, 2> good{200, 0};
  EXPECT_EQ(objects.write(object::kStopRamp, good), AbortCode::kDeviceState);
  EXPECT_EQ(objects.value(slot_of(object::kStopRamp)), 100);
  owner.refusal = AbortCode::kNone;
  EXPECT_EQ(objects.write(object::kStopRamp, good), AbortCode::kNone);
  EXPECT_EQ(objects.value(slot_of(object::kStopRamp)), 200);
}

TEST(ObjectDictionary, SignedValuesKeepTheirSign) {
  Owner owner;
  NodeDictionary objects(owner, 1);
  const std::array<std::uint8_t, 4> minus_five{0xFB, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(objects.write({0x687A, 0}, minus_five), AbortCode::kNone);
  EXPECT_EQ(objects.value(slot_of_axes(object::kTargetPosition)[1]), -5);
  EXPECT_EQ(objects.value(slot_of_axes(object::kTargetPosition)[0]), 0);
}

TEST(ObjectDictionary, FingerprintTellsParametersNotNodesOrVariables) {
  Owner owner;
  NodeDictionary one(owner, 1), two(owner, 2);
  EXPECT_EQ(one.fingerprint(), two.fingerprint());
  two.set_value(slot_of_axes(object::kTargetPosition)[0], 12345);
  EXPECT_EQ(one.fingerprint(), two.fingerprint());
  two.set_value(slot_of(object::kStopRamp), 101);
  EXPECT_NE(one.fingerprint(), two.fingerprint());
  two.restore(2);
  EXPECT_EQ(one.fingerprint(), two.fingerprint());
}

}  // namespace
}  // namespace kinebus
