// Commands that are given by writing objects: what a node does not do, and says so.

#include "node_firmware/core/tests/lone_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kRefusedNow = 0x0800'0022, kWrongValue = 0x0609'0030, kAbove = 0x0609'0031,
                        kBelow = 0x0609'0032, kNothingThere = 0x0800'0024;
constexpr NodeOptions kWithBootLoader{.node_id = 1, .program_crc = 0x1234'5678};

std::int64_t raw_of(const Segment& record) {
  return static_cast<std::int64_t>(encode(record));
}

TEST(NodeCommands, EveryObjectRefusesWhatIsOutOfItsLimitsAndKeepsItsValue) {
  Lone lone;
  int tried = 0;
  for (const ObjectEntry& entry : kNodeObjects) {
    if (!entry.limited || !entry.writable()) continue;
    const auto [index, sub] = entry.address;
    const bool reads = entry.readable();
    const std::int64_t before = reads ? lone.read(index, sub) : 0;
    for (const auto& [value, code] :
         {std::pair{entry.high() + 1, kAbove}, std::pair{entry.low() - 1, kBelow}}) {
      if (value_of(entry.type, static_cast<std::uint64_t>(value)) != value) continue;
      EXPECT_EQ(lone.write(index, sub, entry.size(), value), code) << std::hex << index << ":" << int{sub};
      if (reads) {
        EXPECT_EQ(lone.read(index, sub), before) << std::hex << index << ":" << int{sub};
      }
      ++tried;
    }
  }
  EXPECT_GT(tried, 100);
}

TEST(NodeCommands, TheProgramGivesWayToTheBootLoaderWithoutPowerAlone) {
  {
    Lone lone(kWithBootLoader);
    EXPECT_EQ(lone.read(0x1F51, 1), 1);
    EXPECT_EQ(lone.read(0x1F56, 1), 0x1234'5678);
    EXPECT_EQ(lone.read(0x1F57, 1), 0);
    EXPECT_EQ(lone.write(0x1F51, 1, 1, 1), 0u) << "it runs";
    for (const int unknown : {2, 3}) EXPECT_EQ(lone.write(0x1F51, 1, 1, unknown), kRefusedNow);
    EXPECT_EQ(lone.write(0x1F51, 1, 1, 4), kAbove);
    for (const int axis : {0, 1}) {
      lone.power(axis);
      EXPECT_EQ(lone.write(0x1F51, 1, 1, 0), kRefusedNow) << axis;
      lone.unpower(axis);
    }
    lone.node.set_neighbours_powered(true);
    EXPECT_EQ(lone.write(0x1F51, 1, 1, 0), kRefusedNow) << "another node of the same board";
    lone.node.set_neighbours_powered(false);
    EXPECT_FALSE(lone.node.program_stop_requested());
    EXPECT_EQ(lone.write(0x1F51, 1, 1, 0), 0u);
    EXPECT_TRUE(lone.node.program_stop_requested());
  }
  Lone alone;
  EXPECT_EQ(alone.write(0x1F51, 1, 1, 0), kRefusedNow) << "no boot loader has started it";
  EXPECT_FALSE(alone.node.program_stop_requested());
}

TEST(NodeCommands, AutoTuneIsForAMotorWithPowerThatRests) {
  for (const int axis : {0, 1}) {
    const auto motor = static_cast<std::uint16_t>(0x2150 + axis * 0x800);
    Lone lone;
    EXPECT_EQ(lone.write(motor, 8, 1, 1), kRefusedNow) << "without power";
    lone.power(1 - axis);
    EXPECT_EQ(lone.write(motor, 8, 1, 1), kRefusedNow) << "the other one's power";
    lone.unpower(1 - axis);
    lone.power(axis);
    for (const int wrong : {0, 2, 255}) EXPECT_EQ(lone.write(motor, 8, 1, wrong), kRefusedNow) << wrong;
    lone.unpower(axis);
    lone.start_move(axis);
    EXPECT_EQ(lone.write(motor, 8, 1, 1), kRefusedNow) << "in motion";
    lone.wait(5s);
    ASSERT_FALSE(lone.node.moving(lone.now));
    for (const int each : {0, 1}) EXPECT_FALSE(lone.node.take_tune_request(each)) << "refused is not done";
    EXPECT_EQ(lone.write(motor, 8, 1, 1), 0u);
    EXPECT_FALSE(lone.node.take_tune_request(1 - axis));
    EXPECT_TRUE(lone.node.take_tune_request(axis));
    EXPECT_FALSE(lone.node.take_tune_request(axis)) << "once";
  }
}

TEST(NodeCommands, WhatAnAutoTuneFoundIsInTheMotorsObjects) {
  Lone lone;
  lone.node.set_motor(1, 1'500, 2'800, 0);
  lone.node.set_motor(0, 900, 1'100, -1);
  EXPECT_EQ(lone.read(0x2150, 2), 900);
  EXPECT_EQ(lone.read(0x2150, 3), 1'100);
  EXPECT_EQ(lone.read(0x2150, 7), -1) << "no encoder, no offset";
  EXPECT_EQ(lone.read(0x2950, 2), 1'500);
  EXPECT_EQ(lone.read(0x2950, 3), 2'800);
  EXPECT_EQ(lone.read(0x2950, 7), 0);
  lone.node.set_motor(1, 1'500, 2'800, -1);
  EXPECT_EQ(lone.read(0x2950, 7), 0) << "the one that is known stays";
}

TEST(NodeCommands, PathTimeIsSetAtRestWithNothingQueuedAlone) {
  Lone lone;
  EXPECT_EQ(lone.write(0x2112, 0, 8, 160'000), 0u);
  EXPECT_EQ(lone.read(0x2112, 0), 160'000);
  EXPECT_EQ(lone.write(0x2112, 0, 8, 0), 0u);
  EXPECT_EQ(lone.read(0x2112, 0), 0);
  for (const std::int64_t wraps : {std::int64_t{-1}, INT64_MIN, INT64_MAX, (std::int64_t{1} << 50) + 1}) {
    EXPECT_EQ(lone.write(0x2112, 0, 8, wraps), kAbove) << wraps;
    EXPECT_EQ(lone.read(0x2112, 0), 0) << wraps;
  }
  EXPECT_EQ(lone.write(0x2112, 0, 8, std::int64_t{1} << 50), 0u);
  EXPECT_EQ(lone.read(0x2112, 0), std::int64_t{1} << 50);
  ASSERT_EQ(lone.write(0x2112, 0, 8, 0), 0u);

  ASSERT_EQ(lone.write(0x2100, 0, 8, raw_of({.control = SegmentControl::kStart, .start_units = 100})), 0u);
  EXPECT_EQ(lone.write(0x2112, 0, 8, 16), kRefusedNow) << "another path time would be another position";
  ASSERT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  EXPECT_EQ(lone.write(0x2112, 0, 8, 16), 0u);

  lone.synchronise();
  lone.rate(0.5);
  EXPECT_EQ(lone.write(0x2112, 0, 8, 16), kRefusedNow) << "it runs";
  lone.rate(0);
  EXPECT_EQ(lone.write(0x2112, 0, 8, 16), 0u);
}

TEST(NodeCommands, RecordsBySdoAreAnsweredByWhatBecameOfThem) {
  Lone lone;
  const std::int64_t start = raw_of({.sequence = 0, .control = SegmentControl::kStart, .start_units = 100});
  const std::int64_t second = raw_of({.sequence = 1, .duration = 100}),
                     third = raw_of({.sequence = 2, .duration = 99});
  EXPECT_EQ(lone.write(0x2100, 0, 8, start), 0u);
  EXPECT_EQ(lone.write(0x2100, 0, 8, start), 0u) << "the same again";
  EXPECT_EQ(lone.write(0x2100, 0, 8, third), 0u) << "before its turn";
  EXPECT_EQ(lone.write(0x2100, 0, 8, second), 0u);
  EXPECT_EQ(lone.read(0x60C4, 4), 2) << "buffer position: what is not begun yet";
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.write(0x2100, 0, 8, raw_of({.sequence = 60, .duration = 100})), kWrongValue);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.counter(NodeCounter::kDuplicateFrames), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kRecordsReordered), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kSequenceErrors), 1);
  EXPECT_EQ(lone.read(0x60C4, 4), 2);
}

TEST(NodeCommands, TheBufferIsNoLargerThanItIs) {
  Lone lone;
  EXPECT_EQ(lone.read(0x60C4, 2), 120);
  EXPECT_EQ(lone.write(0x60C4, 2, 4, 120), 0u);
  EXPECT_EQ(lone.write(0x60C4, 2, 4, 121), kAbove);
  EXPECT_EQ(lone.read(0x60C4, 2), 120);
  ASSERT_EQ(lone.write(0x2100, 0, 8, raw_of({.control = SegmentControl::kStart, .start_units = 100})), 0u);
  ASSERT_EQ(lone.write(0x2100, 0, 8, raw_of({.sequence = 1, .duration = 100})), 0u);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 1), 0u) << "in use, which it always is";
  EXPECT_EQ(lone.read(0x60C4, 4), 1);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  EXPECT_EQ(lone.read(0x60C4, 4), 0);
}

TEST(NodeCommands, TheBufferIsNotClearedInTheMidstOfItsMotion) {
  Lone lone;
  lone.synchronise();
  lone.rate(1);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u) << "nothing is queued";
  const std::int64_t units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + 20'000;
  for (const Segment& segment : {Segment{.control = SegmentControl::kStart, .start_units = units},
                                 Segment{.sequence = 1, .duration = 1'000}}) {
    CanFrame record{.id = 0x401, .length = 8};
    put_u64_le(record.data, encode(segment));
    lone.send(record);
  }
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), kRefusedNow);
  EXPECT_EQ(lone.read(0x60C4, 4), 1);
  EXPECT_EQ(lone.write(0x2140, 1, 1, 3), kRefusedNow) << "nor what the stream relies on";
  lone.rate(0);
  EXPECT_EQ(lone.write(0x2140, 1, 1, 3), 0u);
  EXPECT_EQ(lone.write(0x60C4, 6, 1, 0), 0u);
  EXPECT_EQ(lone.read(0x60C4, 4), 0);
}

TEST(NodeCommands, OnlyARateCommandThatIsOneIsTaken) {
  Lone lone;
  CanFrame good =
      encode(RateCommand{.kind = RateCommand::Kind::kStop, .counter = 1, .start = Bench::whole_us(lone.now)});
  CanFrame wrong = good;
  wrong.data[3] ^= 1;
  const auto value = [](const CanFrame& frame) { return static_cast<std::int64_t>(get_u64_le(frame.data)); };
  EXPECT_EQ(lone.write(0x2110, 0, 8, value(wrong)), kRefusedNow);
  EXPECT_FALSE(lone.stopped());
  EXPECT_EQ(lone.write(0x2110, 0, 8, value(good)), 0u);
  EXPECT_TRUE(lone.stopped());
  EXPECT_EQ(lone.write(0x2110, 0, 8, value(good)), 0u) << "the same again";
  EXPECT_EQ(lone.counter(NodeCounter::kDuplicateFrames), 1);
  EXPECT_EQ(lone.counter(NodeCounter::kCoordinatedStops), 1);
}

TEST(NodeCommands, TheErrorHistoryIsReadAsFarAsItGoesAndClearedByZero) {
  Lone lone;
  EXPECT_EQ(lone.read(0x1003, 0), 0);
  lone.node.report(emcy::kBusOffRecovered);
  EXPECT_EQ(lone.read(0x1003, 0), 1);
  EXPECT_EQ(lone.read(0x1003, 1) & 0xFFFF, emcy::kBusOffRecovered);
  EXPECT_EQ(lone.read_code(0x1003, 2), kNothingThere);
  for (const int wrong : {1, 255}) EXPECT_EQ(lone.write(0x1003, 0, 1, wrong), kWrongValue);
  EXPECT_EQ(lone.read(0x1003, 0), 1);
  EXPECT_EQ(lone.write(0x1003, 0, 1, 0), 0u);
  EXPECT_EQ(lone.read(0x1003, 0), 0);
  EXPECT_EQ(lone.read_code(0x1003, 1), kNothingThere);
}

TEST(NodeCommands, SyncStaysWhereAllNodesHearIt) {
  Lone lone;
  EXPECT_EQ(lone.write(0x1005, 0, 4, 0x80), 0u);
  for (const std::int64_t wrong : {0x81, 0, 0x4000'0080})
    EXPECT_EQ(lone.write(0x1005, 0, 4, wrong), kWrongValue);
  EXPECT_EQ(lone.read(0x1005, 0), 0x80);
}

TEST(NodeCommands, HomingMethodsThatAreNoneAreRefused) {
  Lone lone;
  for (int method = -128; method < 128; ++method) {
    const bool known = method == 0 || (method >= 17 && method <= 22) || method == 35 || method == 37 ||
                       method == -3 || method == -4;
    EXPECT_EQ(lone.write(0x6098, 0, 1, method), known ? 0u : kWrongValue) << method;
    EXPECT_EQ(lone.write(0x6898, 0, 1, method), known ? 0u : kWrongValue) << method;
  }
}

}  // namespace
}  // namespace kinebus::testing_bench
