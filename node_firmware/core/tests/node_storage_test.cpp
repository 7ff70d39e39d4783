// What a node takes from its memory, and what it gives to it: 1010h, 1011h, LSS, and images of other
// programs.

#include "node_firmware/core/tests/lone_bench.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kNotNow = 0x0800'0022, kNoStore = 0x0800'0020;
constexpr std::uint16_t kStorageEmcy = 0x5530;

struct StoredValue {
  std::uint16_t index;
  std::uint8_t sub;
  std::int64_t value;
};
using ImageBytes = std::vector<std::uint8_t>;

void finish_image(ImageBytes& bytes) {
  bytes.resize(bytes.size() + 4);
  Crc32 crc;
  crc.add(std::span(bytes).first(bytes.size() - 4));
  put_u32_le(std::span(bytes).last(4), crc.value());
}
/// As parameter_image.hpp says that it is kept.
ImageBytes image_with(const std::vector<StoredValue>& values, std::uint8_t node_id = 0,
                      std::uint16_t version = 1, std::uint32_t magic = 0x4950'424B) {
  ImageBytes bytes(12 + 12 * values.size());
  put_u32_le(bytes, magic);
  put_u16_le(std::span(bytes).subspan(4), version);
  put_u16_le(std::span(bytes).subspan(6), static_cast<std::uint16_t>(values.size()));
  bytes[8] = node_id;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto place = std::span(bytes).subspan(12 + 12 * i);
    put_u32_le(place, ObjectAddress{values[i].index, values[i].sub}.key());
    put_u64_le(place.subspan(4), static_cast<std::uint64_t>(values[i].value));
  }
  finish_image(bytes);
  return bytes;
}
/// Asks for it, and plays a memory that takes it.
ImageBytes save(Lone& lone) {
  EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNoAnswer) << "the answer waits for the memory";
  const auto image = lone.node.image_to_store();
  ImageBytes kept(image.begin(), image.end());
  EXPECT_FALSE(kept.empty());
  lone.node.on_image_stored(true);
  EXPECT_EQ(lone.node.next_frame().value_or(CanFrame{}).data[0], 0x60) << "1010h";
  return kept;
}

TEST(NodeStorage, AStoredValueOutOfItsLimitsIsLeftOutAndOneAtThemIsTaken) {
  struct Case {
    std::int64_t stored, in_force;
  };
  for (const Case& c : {Case{1, 100}, Case{2, 2}, Case{510, 510}, Case{511, 100}, Case{-1, 100},
                        Case{std::int64_t{1} << 40, 100}}) {
    Lone lone({.node_id = 1}, image_with({{0x2113, 0, c.stored}, {0x6081, 0, 77'777}}));
    EXPECT_EQ(lone.read(0x2113, 0), c.in_force) << c.stored;
    EXPECT_EQ(lone.read(0x6081, 0), 77'777) << "what comes behind it is taken";
    EXPECT_EQ(lone.told(kStorageEmcy), 0) << "the image is whole";
  }
}

TEST(NodeStorage, NegativeLimitsHoldForStoredValuesToo) {
  for (const auto& [stored, in_force] :
       std::initializer_list<std::pair<int, int>>{{-2, 0}, {-1, -1}, {1, 0}}) {
    Lone lone({.node_id = 1}, image_with({{0x60C0, 0, stored}}));
    EXPECT_EQ(lone.read(0x60C0, 0), in_force) << stored;
  }
}

TEST(NodeStorage, OnlyParametersAreTakenFromAnImage) {
  // Objects that another program had, what is no parameter of this one, and a controlword least of all.
  Lone lone({.node_id = 1}, image_with({{0x2FFF, 0, 5},
                                        {0x0001, 0, 5},
                                        {0x6007, 0, 0},
                                        {0x6040, 0, 0x0F},
                                        {0x607A, 0, 40'000},
                                        {0x1018, 4, 99},
                                        {0x6085, 0, 5'555}}));
  EXPECT_EQ(lone.read(0x6007, 0), 3);
  EXPECT_EQ(lone.read(0x6040, 0), 0);
  EXPECT_EQ(lone.read(0x607A, 0), 0);
  EXPECT_EQ(lone.read(0x6085, 0), 5'555);
  EXPECT_EQ(lone.told(kStorageEmcy), 0);
}

TEST(NodeStorage, AnImageThatIsNotOfThisKindIsDamagedThoughItsSumAgrees) {
  const std::vector<StoredValue> one{{0x6081, 0, 77'777}};
  ImageBytes too_long = image_with(one);
  put_u16_le(std::span(too_long).subspan(6), 2);  // it ends before its second value
  const std::vector<StoredValue> many(700, one[0]);
  for (const ImageBytes& image :
       {image_with(one, 0, 2), image_with(one, 0, 1, 0x4950'424C), too_long, image_with(many), ImageBytes{},
        ImageBytes(15, 0x4B), ImageBytes(4096, 0xFF)}) {
    Lone lone({.node_id = 1}, image);
    EXPECT_EQ(lone.read(0x6081, 0), 128'000) << image.size();
    EXPECT_EQ(lone.told(kStorageEmcy), image.empty() ? 0 : 1) << image.size();
    EXPECT_EQ(lone.counter(NodeCounter::kStorageErrors), image.empty() ? 0 : 1);
  }
  // Flash is read as a whole page: what follows does not matter.
  ImageBytes page = image_with(one);
  page.resize(4096, 0xFF);
  Lone lone({.node_id = 1}, page);
  EXPECT_EQ(lone.read(0x6081, 0), 77'777);
}

TEST(NodeStorage, AnImageOfAllParametersAndNoMoreFits) {
  std::vector<StoredValue> all;
  for (const ObjectEntry& entry : kNodeObjects)
    if (entry.binding == Binding::kParameter)
      all.push_back({entry.address.index, entry.address.subindex, entry.initial()});
  EXPECT_EQ(Lone({.node_id = 1}, image_with(all)).told(kStorageEmcy), 0);
  all.push_back({0x6081, 0, 77'777});
  Lone lone({.node_id = 1}, image_with(all));
  EXPECT_EQ(lone.told(kStorageEmcy), 1);
  EXPECT_EQ(lone.read(0x6081, 0), 128'000);
}

TEST(NodeStorage, EverySavedParameterComesBackAndNoDefaultIsKept) {
  Lone lone;
  EXPECT_EQ(save(lone).size(), 16u) << "all are as the program brings them, so that the next one's hold";
  for (const auto& [index, sub, value] :
       std::initializer_list<StoredValue>{{0x6081, 0, 1'001}, {0x6881, 0, 1'002}, {0x607C, 0, -7}})
    ASSERT_EQ(lone.write(index, sub, 4, value), 0u);
  ASSERT_EQ(lone.write(0x607A, 0, 4, 123), 0u);
  const ImageBytes kept = save(lone);
  EXPECT_EQ(kept.size(), 16u + 3 * 12) << "no target position";
  Lone again({.node_id = 1}, kept);
  EXPECT_EQ(again.read(0x6081, 0), 1'001);
  EXPECT_EQ(again.read(0x6881, 0), 1'002);
  EXPECT_EQ(again.read(0x607C, 0), -7);
  EXPECT_EQ(again.read(0x607A, 0), 0);
}

TEST(NodeStorage, WhatGoesWithTheNodeIdGoesWithTheNewOne) {
  Lone lone;
  ASSERT_EQ(lone.write(0x1014, 0, 4, 0x8000'0081), 0u);
  ASSERT_EQ(lone.write(0x1403, 1, 4, 0x8000'0321), 0u);
  const ImageBytes kept = save(lone);
  Lone other({.node_id = 9}, kept);
  EXPECT_EQ(other.read(0x1014, 0), 0x8000'0089);
  EXPECT_EQ(other.read(0x1403, 1), 0x8000'0329);
  EXPECT_EQ(other.read(0x6081, 0), 128'000);
}

TEST(NodeStorage, ResetCommunicationBringsBackWhatIsStoredBelow2000hAlone) {
  Lone lone;
  ASSERT_EQ(lone.write(0x1017, 0, 2, 400), 0u);
  ASSERT_EQ(lone.write(0x2113, 0, 2, 60), 0u);
  ASSERT_EQ(lone.write(0x6081, 0, 4, 9'000), 0u);
  save(lone);
  ASSERT_EQ(lone.write(0x1017, 0, 2, 700), 0u);
  ASSERT_EQ(lone.write(0x1029, 1, 1, 2), 0u);
  ASSERT_EQ(lone.write(0x1403, 1, 4, 0x8000'0322), 0u);
  ASSERT_EQ(lone.write(0x2113, 0, 2, 80), 0u);
  ASSERT_EQ(lone.write(0x6081, 0, 4, 8'000), 0u);
  lone.send("000#8201");
  EXPECT_EQ(lone.read(0x1017, 0), 400);
  EXPECT_EQ(lone.read(0x1029, 1), 1) << "not stored: its default";
  EXPECT_EQ(lone.read(0x1403, 1), Lone().read(0x1403, 1));
  EXPECT_EQ(lone.read(0x1014, 0), 0x81) << "relative to the node id";
  EXPECT_EQ(lone.read(0x2113, 0), 80);
  EXPECT_EQ(lone.read(0x6081, 0), 8'000);
  lone.send("000#8101");
  EXPECT_EQ(lone.read(0x2113, 0), 60);
  EXPECT_EQ(lone.read(0x6081, 0), 9'000);
}

TEST(NodeStorage, LoadForgetsWhatIsStoredAndTheDefaultsHoldFromTheNextResetOn) {
  Lone lone({.node_id = 0}, image_with({{0x2113, 0, 60}, {0x6081, 0, 9'000}}, 33));
  EXPECT_EQ(lone.write(0x1011, 1, 4, kLoadSignature), kNoAnswer);
  const auto image = lone.node.image_to_store();
  const ImageBytes kept(image.begin(), image.end());
  lone.node.on_image_stored(true);
  EXPECT_EQ(text_of(lone.node.next_frame().value_or(CanFrame{})), "5A1#6011100100000000");
  EXPECT_EQ(lone.read(0x6081, 0), 9'000) << "not before it";
  lone.send("000#8121");
  EXPECT_EQ(lone.read(0x2113, 0), 100);
  EXPECT_EQ(lone.read(0x6081, 0), 128'000);
  Lone again({.node_id = 0}, kept);
  EXPECT_EQ(again.node.node_id(), 33) << "it keeps its node id";
  EXPECT_EQ(again.read(0x6081, 0), 128'000);
}

TEST(NodeStorage, EachCommandTakesItsOwnSignatureAlone) {
  Lone lone;
  for (const std::int64_t wrong : {kLoadSignature, std::int64_t{0}, std::int64_t{1}, kSaveSignature + 1})
    EXPECT_EQ(lone.write(0x1010, 1, 4, wrong), kNoStore) << wrong;
  for (const std::int64_t wrong : {kSaveSignature, std::int64_t{0}, kLoadSignature - 1})
    EXPECT_EQ(lone.write(0x1011, 1, 4, wrong), kNoStore) << wrong;
  EXPECT_TRUE(lone.node.image_to_store().empty());
  EXPECT_EQ(lone.read(0x1010, 1), 1);
  EXPECT_EQ(lone.read(0x1011, 1), 1);
}

TEST(NodeStorage, WritingFlashWaitsForNoMotorOfTheBoardWithPower) {
  for (const int axis : {0, 1}) {
    Lone lone;
    lone.power(axis);
    EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNotNow) << axis;
    EXPECT_EQ(lone.write(0x1011, 1, 4, kLoadSignature), kNotNow) << axis;
    lone.unpower(axis);
    save(lone);
  }
  Lone lone;
  lone.node.set_neighbours_powered(true);
  EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNotNow) << "another node of the same board";
  lone.node.set_neighbours_powered(false);
  EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNoAnswer);
  lone.node.set_neighbours_powered(true);
  EXPECT_TRUE(lone.node.image_to_store().empty());
  EXPECT_EQ(text_of(lone.node.next_frame().value_or(CanFrame{})), "581#8010100122000008");
  lone.node.set_neighbours_powered(false);
  save(lone);
}

TEST(NodeStorage, OneIsWrittenAtATime) {
  Lone lone;
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1700000000000000");  // LSS, store
  EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNotNow);
  ASSERT_FALSE(lone.node.image_to_store().empty());
  EXPECT_TRUE(lone.node.image_to_store().empty()) << "given out once";
  EXPECT_EQ(lone.write(0x1011, 1, 4, kLoadSignature), kNotNow);
  lone.node.on_image_stored(true);
  EXPECT_EQ(text_of(lone.node.next_frame().value_or(CanFrame{})), "7E4#1700000000000000");
  EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNoAnswer);
  lone.node.on_image_stored(true);
  EXPECT_FALSE(lone.node.next_frame()) << "what the memory has not been given cannot be stored";
  ASSERT_FALSE(lone.node.image_to_store().empty());
  lone.node.on_image_stored(true);
  EXPECT_EQ(text_of(lone.node.next_frame().value_or(CanFrame{})), "581#6010100100000000");
}

TEST(NodeStorage, AMemoryThatFailsIsToldCountedAndAskedAgain) {
  Lone lone;
  for (int times = 1; times <= 2; ++times) {
    EXPECT_EQ(lone.write(0x1010, 1, 4, kSaveSignature), kNoAnswer);
    ASSERT_FALSE(lone.node.image_to_store().empty());
    lone.node.on_image_stored(false);
    lone.send("080#");
    EXPECT_EQ(lone.told(kStorageEmcy), times);
    EXPECT_EQ(lone.counter(NodeCounter::kStorageErrors), times);
  }
  lone.send("7E5#0401000000000000");
  lone.send("7E5#1700000000000000");
  ASSERT_FALSE(lone.node.image_to_store().empty());
  lone.node.on_image_stored(false);
  lone.send("080#");
  EXPECT_TRUE(lone.was_sent("7E4#1702000000000000")) << "LSS: cannot be accessed";
}

TEST(NodeStorage, ANodeIdThatIsNoneIsNotTakenFromTheMemory) {
  for (const auto& [stored, in_force] : std::initializer_list<std::pair<std::uint8_t, int>>{
           {126, 126}, {127, 127}, {128, 0}, {255, 0}, {0, 0}}) {
    const LoneNode node(NodeOptions{}, LocalTime{0}, image_with({}, stored));
    EXPECT_EQ(node.node_id(), in_force) << int{stored};
  }
  for (const auto& [wanted, in_force] :
       std::initializer_list<std::pair<std::uint8_t, int>>{{127, 127}, {128, 33}, {0, 33}, {1, 1}}) {
    const LoneNode node(NodeOptions{.node_id = wanted}, LocalTime{0}, image_with({}, 33));
    EXPECT_EQ(node.node_id(), in_force) << int{wanted};
  }
  // Those that go with it need one, too.
  for (const auto& [stored, in_force] :
       std::initializer_list<std::pair<std::uint8_t, int>>{{124, 124}, {125, 0}, {127, 0}}) {
    const LoneNode node(NodeOptions{.consecutive_ids = 4}, LocalTime{0}, image_with({}, stored));
    EXPECT_EQ(node.node_id(), in_force) << int{stored};
  }
  const LoneNode board(NodeOptions{.node_id = 127, .id_from_board = true, .consecutive_ids = 4},
                       LocalTime{0});
  EXPECT_EQ(board.node_id(), 127);
  const LoneNode none(NodeOptions{.id_from_board = true}, LocalTime{0}, image_with({}, 33));
  EXPECT_EQ(none.node_id(), 0) << "the board's say, also when that is none";
}

}  // namespace
}  // namespace kinebus::testing_bench
