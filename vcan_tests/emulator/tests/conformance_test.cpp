// One suite for the node core on the host and for the firmware's images on their emulated boards: what is
// true of one must be true of the other, to the bit where positions are concerned.

#include <gtest/gtest.h>

#include <cmath>

#include "protocol/canopen/boards/stm32f446_octopus.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"
#include "protocol/motion/tail_check.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"
#include "vcan_tests/emulator/ebb_board.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"
#include "vcan_tests/emulator/octopus_board.hpp"
#include "vcan_tests/emulator/tests/gateway_bench.hpp"

namespace kinebus::emulator {
namespace {

constexpr std::uint8_t kId = 5;

struct HostCore {
  static constexpr int kAxes = 2;
  static constexpr std::uint32_t kProduct = kProductCode;
  static std::unique_ptr<NodeMachine> make() {
    VirtualNodeOptions options;
    options.node = {.identity = {.serial = 77}, .node_id = kId};
    options.clock_drift_ppm = 20;
    return std::make_unique<VirtualMachine>(std::vector{options}, 1);
  }
};

struct EmulatedImage {
  static constexpr int kAxes = 2;
  static constexpr std::uint32_t kProduct = kProductCode;
  static std::unique_ptr<NodeMachine> make() {
    static const ElfImage image = load_elf(KINEBUS_FIRMWARE_IMAGE);
    EmulatedNodeOptions options;
    options.board.unique_id = {1, 2, 3};
    options.node_id = kId;
    options.clock_drift_ppm = 20;
    return std::make_unique<EmulatedMachine>(image, std::vector{options});
  }
};

struct OctopusImage {
  static constexpr int kAxes = 2;
  static constexpr std::uint32_t kProduct = Stm32f446OctopusBoard::kFacts.product_code;
  static std::unique_ptr<NodeMachine> make() {
    static const ElfImage image = load_elf(KINEBUS_OCTOPUS_IMAGE);
    EmulatedNodeOptions options;
    options.board.unique_id = {1, 2, 3};
    options.node_id = kId;
    options.clock_drift_ppm = 20;
    options.make = &make_board<OctopusBoard>;
    return std::make_unique<EmulatedMachine>(image, std::vector{options});
  }
};

// Its second axis has no motor.
struct EbbImage {
  static constexpr int kAxes = 1;
  static constexpr std::uint32_t kProduct = Stm32g0b1EbbBoard::kFacts.product_code;
  static std::unique_ptr<NodeMachine> make() {
    static const ElfImage image = load_elf(KINEBUS_EBB_IMAGE);
    EmulatedNodeOptions options;
    options.board.unique_id = {1, 2, 3};
    options.node_id = kId;
    options.clock_drift_ppm = 20;
    options.make = &make_board<EbbBoard>;
    return std::make_unique<EmulatedMachine>(image, std::vector{options});
  }
};

template <typename Node>
struct Conformance : testing::Test {
  std::unique_ptr<NodeMachine> node = Node::make();
  GatewayBench bench{*node};
};
using Nodes = testing::Types<HostCore, EmulatedImage, OctopusImage, EbbImage>;
TYPED_TEST_SUITE(Conformance, Nodes);

TYPED_TEST(Conformance, IsATwoAxisDriveAndSaysSo) {
  EXPECT_EQ(this->bench.read(kId, 0x1000, 0), 0xFFFF0192) << "CiA 402, several axes";
  EXPECT_EQ(this->bench.read(kId, 0x1018, 1), kVendorId);
  EXPECT_EQ(this->bench.read(kId, 0x1018, 2), TypeParam::kProduct);
  EXPECT_EQ(this->bench.read(kId, 0x1018, 3), kRevisionNumber);
  EXPECT_NE(this->bench.read(kId, 0x1018, 4), 0);
}

TYPED_TEST(Conformance, RefusesWhatTheTableDoesNotAllowByTheStandardsCodes) {
  EXPECT_EQ(this->bench.try_write(kId, 0x2FFF, 0, 4, 0), 0x06020000u);
  EXPECT_EQ(this->bench.try_write(kId, 0x1000, 0, 4, 0), 0x06010002u);
  EXPECT_EQ(this->bench.try_write(kId, 0x1018, 9, 4, 0), 0x06090011u);
}

TYPED_TEST(Conformance, FollowsNmtAndTellsItsStateByHeartbeat) {
  this->bench.write(kId, 0x1017, 0, 2, 20);
  const auto state = [&] {
    this->bench.run(50ms);
    const CanFrame* beat = this->bench.last(0x700u + kId);
    return beat == nullptr ? -1 : int{beat->data[0]};
  };
  EXPECT_EQ(state(), 127);
  this->bench.send(nmt_frame(NmtCommand::kStart, kId));
  EXPECT_EQ(state(), 5);
  this->bench.send(nmt_frame(NmtCommand::kStop, kId));
  EXPECT_EQ(state(), 4);
  this->bench.send(nmt_frame(NmtCommand::kEnterPreOperational, kAllNodes));
  EXPECT_EQ(state(), 127);
  this->bench.seen.clear();
  this->bench.send(nmt_frame(NmtCommand::kResetCommunication, kId));
  this->bench.run(50ms);
  bool booted = false;
  for (const auto& seen : this->bench.seen)
    booted = booted || seen.frame == CanFrame::make(0x700u + kId, {0});
  EXPECT_TRUE(booted);
}

TYPED_TEST(Conformance, GoesThroughTheDriveStatesOfItsAxes) {
  this->bench.send(nmt_frame(NmtCommand::kStart, kId));
  for (int axis = 0; axis < TypeParam::kAxes; ++axis) {
    const auto word = [&](int value) {
      this->bench.write(kId, static_cast<std::uint16_t>(0x6040 + 0x800 * axis), 0, 2, value);
      this->bench.run(20ms);
      return this->bench.statusword(kId, axis) & 0x6F;
    };
    EXPECT_EQ(this->bench.statusword(kId, axis) & 0x4F, 0x40);
    EXPECT_EQ(word(0x06), 0x21);
    EXPECT_EQ(word(0x07), 0x23);
    this->bench.enable(kId, axis, 1);
    EXPECT_EQ(word(0x07), 0x23);
    EXPECT_EQ(word(0x00) & 0x4F, 0x40);
  }
}

TYPED_TEST(Conformance, MovesItsAxesToTheirTargetsExactly) {
  this->bench.send(nmt_frame(NmtCommand::kStart, kId));
  for (int axis = 0; axis < TypeParam::kAxes; ++axis) this->bench.enable(kId, axis, 1);
  this->bench.move(kId, 0, 12'345, 100'000, 1'000'000);
  if (TypeParam::kAxes > 1) this->bench.move(kId, 1, -6'789, 50'000, 500'000);
  this->bench.run(500ms);
  EXPECT_TRUE(this->bench.reached(kId, 0));
  EXPECT_EQ(this->bench.read(kId, 0x6064, 0), 12'345);
  if (TypeParam::kAxes > 1) {
    EXPECT_TRUE(this->bench.reached(kId, 1));
    EXPECT_EQ(this->bench.read(kId, 0x6864, 0), -6'789);
  }
  EXPECT_TRUE(this->bench.emergencies(kId).empty());
}

TYPED_TEST(Conformance, StreamedPositionsAreThoseOfTheirPathTimeToTheBit) {
  this->bench.bring_up({kId});
  this->bench.write(kId, 0x2115, 0, 2, 5);
  for (int axis = 0; axis < TypeParam::kAxes; ++axis) this->bench.enable(kId, axis, 7);
  StreamFeed feed{.id = kId};
  const auto path_ticks = [&] { return this->bench.read_long(kId, 0x2112); };
  this->bench.send(feed.start(path_ticks() / kPathTicksPerUnit + 62'500));
  for (int i = 0; i < 12; ++i)
    for (const int sign : {1, -1, -1, 1})
      this->bench.send(feed.segment(1250, sign * 612'345, TypeParam::kAxes > 1 ? -sign * 254'321 : 0));
  this->bench.send(feed.end());
  this->bench.run(100ms);
  const auto status = [&] {
    return decode_stream_status(static_cast<std::uint64_t>(this->bench.read_long(kId, 0x2102)));
  };
  EXPECT_EQ(this->bench.read(kId, 0x2118, 0) & kTellsTailCheck, kTellsTailCheck);
  EXPECT_FALSE(status().tail_check) << "before anybody has asked";
  this->bench.write(kId, 0x2119, 0, 1, 1);
  const std::int64_t units = path_ticks() / kPathTicksPerUnit;
  EXPECT_EQ(status().tail_check, tail_check(feed.sequence, feed.state, feed.begin_units, units));
  EXPECT_EQ(status().path_near(units), units);
  // Holds at arbitrary path times in the middle of segments.
  for (const auto span : {1'234'567us, 333'221us, 256'789us, 177'777us}) {
    this->bench.rate(1);
    this->bench.run(span);
    this->bench.rate(0);
    this->bench.run(300ms);
    const std::int64_t ticks = path_ticks();
    EXPECT_EQ(path_ticks(), ticks) << "held";
    for (int axis = 0; axis < TypeParam::kAxes; ++axis) {
      const std::int64_t expected = feed.position(axis, ticks);
      const auto index = static_cast<std::uint16_t>(0x6064 + 0x800 * axis);
      EXPECT_EQ(this->bench.read(kId, index, 0), (expected + (std::int64_t{1} << 31)) >> 32)
          << "axis " << axis;
    }
  }
  this->bench.rate(1);
  this->bench.run(3s);
  for (int axis = 0; axis < TypeParam::kAxes; ++axis)
    EXPECT_EQ(this->bench.read(kId, static_cast<std::uint16_t>(0x6064 + 0x800 * axis), 0),
              feed.state[static_cast<std::size_t>(axis)].position >> 32);
  EXPECT_TRUE(this->bench.emergencies(kId).empty());
}

// Also where one cuts another short, and with the longest that the wire carries.
TYPED_TEST(Conformance, PathTimeAlongSmoothRampsIsThatOfTheGatewayToTheTick) {
  this->bench.bring_up({kId});
  EXPECT_EQ(this->bench.read(kId, 0x2118, 0) & kFollowsSmoothRamps, kFollowsSmoothRamps);
  PathClock clock;
  ASSERT_TRUE(clock.set_tau(PathTime{this->bench.read_long(kId, 0x2112)}, this->bench.now));
  struct Change {
    double rate;
    std::uint8_t ramp_2ms;
    BusTime until_next;
  };
  for (const Change& change : {Change{1, 100, 500ms},
                               {0.3, 40, 50ms},
                               {0, 90, 400ms},
                               {0.7, 255, 300ms},
                               {0, 30, 900ms},
                               {1, 255, 1100ms},
                               {0, 255, 1100ms}}) {
    const RateCommand command =
        this->bench.command({.kind = RateCommand::Kind::kSmooth,
                             .rate_q15 = static_cast<std::uint16_t>(std::lround(change.rate * 32768)),
                             .full_ramp_2ms = change.ramp_2ms},
                            5ms);
    clock.apply(command, this->bench.now);
    this->bench.run(change.until_next);
    if (!clock.at_rest(this->bench.now)) continue;
    EXPECT_EQ(this->bench.read_long(kId, 0x2112), clock.tau(this->bench.now).count());
  }
  EXPECT_TRUE(clock.at_rest(this->bench.now));
  EXPECT_TRUE(this->bench.emergencies(kId).empty());
}

TYPED_TEST(Conformance, StopsOnThePathWhenSyncIsLost) {
  this->bench.bring_up({kId});
  this->bench.write(kId, 0x2115, 0, 2, 5);
  for (int axis = 0; axis < TypeParam::kAxes; ++axis) this->bench.enable(kId, axis, 7);
  StreamFeed feed{.id = kId};
  this->bench.send(feed.start(this->bench.read_long(kId, 0x2112) / kPathTicksPerUnit + 62'500));
  for (int i = 0; i < 20; ++i)
    for (const int sign : {1, -1, -1, 1})
      this->bench.send(feed.segment(1250, sign * 500'000, TypeParam::kAxes > 1 ? sign * 300'000 : 0));
  this->bench.send(feed.end());
  // A start is named when the records were taken, as the gateway does: the EBB takes some 1000 a second.
  this->bench.run(150ms);
  this->bench.rate(1);
  this->bench.run(1200ms);
  EXPECT_TRUE(this->bench.emergencies(kId).empty());
  this->bench.stop_sync();
  this->bench.run(600ms);
  const auto codes = this->bench.emergencies(kId);
  ASSERT_FALSE(codes.empty());
  EXPECT_EQ(codes.front(), 0x8700);
  EXPECT_EQ(this->bench.statusword(kId, 0) & 0x6F, 0x27) << "holds with power on";
  const std::int64_t ticks = this->bench.read_long(kId, 0x2112);
  for (int axis = 0; axis < TypeParam::kAxes; ++axis)
    EXPECT_EQ(this->bench.read(kId, static_cast<std::uint16_t>(0x6064 + 0x800 * axis), 0),
              (feed.position(axis, ticks) + (std::int64_t{1} << 31)) >> 32);
}

TEST(ConformanceOfBoth, EveryObjectOfTheTableHasTheSameValueAfterPowerUp) {
  const auto host = HostCore::make(), image = EmulatedImage::make();
  GatewayBench one(*host), other(*image);
  int compared = 0;
  for (const ObjectEntry& entry : kNodeObjects) {
    const ObjectAddress at = entry.address;
    if (!entry.readable()) continue;
    const bool differs_by_nature =
        entry.binding == Binding::kLive;  // serial number, times, counters, measurements
    const CanFrame a = one.upload(kId, at.index, at.subindex), b = other.upload(kId, at.index, at.subindex);
    if (differs_by_nature)
      EXPECT_EQ(a.data[0], b.data[0]) << std::hex << at.index << ":" << int{at.subindex};
    else
      EXPECT_EQ(a, b) << std::hex << at.index << ":" << int{at.subindex};
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace kinebus::emulator
