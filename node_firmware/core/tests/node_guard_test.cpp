// Node guarding: what masters may rely on that do not consume heartbeats.

#include "node_firmware/core/tests/drive_bench.hpp"

namespace kinebus::testing_bench {
namespace {

struct GuardTest : DriveTest {
  GuardTest() { bench.plant_on = false; }
  /// What the node answers; empty: nothing.
  std::string asked() {
    const std::size_t before = bench.seen.size();
    bench.send("701#R");
    bench.run(5ms);
    for (std::size_t i = before; i < bench.seen.size(); ++i)
      if (bench.seen[i].frame.id == 0x701) return text_of(bench.seen[i].frame);
    return {};
  }
  int told(std::uint16_t code) {
    return static_cast<int>(std::count_if(bench.seen.begin(), bench.seen.end(), [&](const auto& seen) {
      return seen.frame.id == 0x081 && get_u16_le(seen.frame.data) == code;
    }));
  }
};

TEST_F(GuardTest, ANodeWithoutHeartbeatAnswersWithItsStateAndABitThatToggles) {
  bench.run(10ms);
  EXPECT_EQ(asked(), "") << "it has a heartbeat: one of the two";
  bench.write(kId, 0x1017, 0, 2, 0);
  EXPECT_EQ(asked(), "701#7F");
  EXPECT_EQ(asked(), "701#FF");
  bench.send("000#0101");
  EXPECT_EQ(asked(), "701#05");
  bench.send("000#0201");
  EXPECT_EQ(asked(), "701#84");
  bench.send("000#8201");
  bench.run(5ms);
  bench.write(kId, 0x1017, 0, 2, 0);
  EXPECT_EQ(asked(), "701#7F") << "from boot-up the bit begins anew";
  bench.seen.clear();
  bench.send("702#R");
  bench.send("701#");
  bench.run(5ms);
  EXPECT_FALSE(bench.was_seen(0x701));
}

TEST_F(GuardTest, AMasterThatStopsAskingIsLostAndAMotionEnds) {
  bench.write(kId, 0x1017, 0, 2, 0);
  bench.write(kId, 0x100C, 0, 2, 50);
  bench.write(kId, 0x100D, 0, 1, 3);
  bench.run(1s);
  EXPECT_EQ(told(emcy::kHeartbeat), 0) << "it has never asked";
  bench.enable(kId, 0, 1);
  target(1'000'000);
  for (int i = 0; i < 10; ++i) {
    static_cast<void>(asked());
    bench.run(120ms);
  }
  EXPECT_EQ(told(emcy::kHeartbeat), 0);
  EXPECT_NE(bench.read(kId, 0x606C, 0), 0);
  bench.run(100ms);
  EXPECT_EQ(told(emcy::kHeartbeat), 1);
  bench.run(200ms);
  EXPECT_EQ(bench.read(kId, 0x606C, 0), 0);
  EXPECT_EQ(bench.read(kId, 0x1001, 0) & 0x10, 0x10);
  static_cast<void>(asked());
  bench.run(5ms);
  EXPECT_EQ(bench.read(kId, 0x1001, 0) & 0x10, 0) << "it is back";
}

}  // namespace
}  // namespace kinebus::testing_bench
