// What CiA 301 and CiA 402 say of a node, where a generic master has found one that did otherwise.

#include "node_firmware/core/tests/drive_bench.hpp"

namespace kinebus::testing_bench {
namespace {

constexpr std::uint32_t kInvalidValue = 0x0609'0030, kIncompatible = 0x0604'0043, kDeviceState = 0x0800'0022;

TEST_F(DriveTest, AnExpeditedDownloadNeedNotSayItsSize) {
  bench.send("601#2217100034120000");  // 16 bits of the four bytes
  bench.run(2ms);
  EXPECT_EQ(text_of(*bench.last(0x581)), "581#6017100000000000");
  EXPECT_EQ(bench.read(kId, 0x1017, 0), 0x1234);
  bench.send("601#22FF5F0034120000");
  bench.run(2ms);
  EXPECT_EQ(text_of(*bench.last(0x581)), "581#80FF5F0000000206");
}

TEST_F(DriveTest, ANodeIsWatchedInOneEntryAlone) {
  bench.write(kId, 0x1016, 1, 4, 0x007F'0100);
  EXPECT_EQ(bench.try_write(kId, 0x1016, 2, 4, 0x007F'0200), kIncompatible);
  bench.write(kId, 0x1016, 2, 4, 0x007E'0200);
  EXPECT_EQ(bench.try_write(kId, 0x1016, 1, 4, 0x007E'0100), kIncompatible);
  bench.write(kId, 0x1016, 2, 4, 0x007F'0000);  // no time: not in use
  bench.write(kId, 0x1016, 1, 4, 0x007F'0200);
}

TEST_F(DriveTest, EmcyCanBeSwitchedOff) {
  bench.send("000#0101");
  EXPECT_EQ(bench.try_write(kId, 0x1014, 0, 4, 0x8000'0082), kInvalidValue);
  bench.write(kId, 0x1014, 0, 4, 0x8000'0081);
  bench.send("201#0F");
  bench.run(5ms);
  EXPECT_FALSE(bench.was_seen(0x081));
  EXPECT_EQ(bench.read(kId, 0x1001, 0), 0x11) << "the error register tells it all the same";
  EXPECT_EQ(bench.read(kId, 0x1003, 1) & 0xFFFF, 0x8210);
  bench.write(kId, 0x1014, 0, 4, 0x81);
  bench.run(5ms);
  EXPECT_FALSE(bench.was_seen(0x081)) << "what is over is not told later";
  bench.send("000#0101");
  bench.run(5ms);
  EXPECT_TRUE(bench.was_seen(0x081));
}

TEST_F(DriveTest, AnRpdoWithAModeThatIsNoneChangesNothing) {
  bench.send("000#0101");
  bench.send("201#060006000155");
  bench.run(5ms);
  EXPECT_EQ(status() & 0x6F, 0x40);
  EXPECT_EQ(bench.read(kId, 0x6040, 0), 0);
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(text_of(*bench.last(0x081)), "081#0082110001606800");
}

TEST_F(DriveTest, StopOptionsByCurrentAndVoltageLimitAreTaken) {
  struct Case {
    int option;
    std::uint16_t state;
  };
  for (const auto& [option, state] : {Case{3, 0x40}, Case{4, 0x40}, Case{7, 0x07}, Case{8, 0x07}}) {
    bench.write(kId, 0x605A, 0, 2, option);
    bench.enable(kId, 0, 1);
    target(bench.read(kId, 0x6064, 0) + 50'000);
    watch(100ms, 128'000, 1'280'000);
    control(0x0B);
    watch(200ms, 128'000, 6'400'000);
    EXPECT_EQ(status() & 0x6F, state) << option;
    control(0);
  }
  for (const int option : {3, 4}) {
    bench.write(kId, 0x605D, 0, 2, option);
    bench.enable(kId, 0, 1);
    target(bench.read(kId, 0x6064, 0) + 50'000);
    watch(100ms, 128'000, 1'280'000);
    control(0x11F);
    watch(100ms, 128'000, 6'400'000);
    EXPECT_EQ(status() & 0x46F, 0x427) << option;
    control(0x0F);
    watch(1s, 128'000, 6'400'000);
    control(0);
  }
}

TEST_F(DriveTest, StatuswordTellsTheFollowingErrorOfAProfileMove) {
  bench.enable(kId, 0, 1);
  bench.node().set_feedback(0, {.following_error = 1024});
  EXPECT_EQ(status() & 0x2000, 0);
  bench.node().set_feedback(0, {.following_error = -1025});
  EXPECT_EQ(status() & 0x2000, 0x2000);
  bench.write(kId, 0x6065, 0, 4, 0xFFFF'FFFF);
  EXPECT_EQ(status() & 0x2000, 0);
}

TEST(NodeAsItComes, ModesEightAndSevenGoByAPlainSync) {
  Bench bench({{.id = kId, .told = false}});
  bench.send("000#0101");
  bench.write(kId, 0x60C2, 1, 1, 10);
  for (const auto& [mode, index, sub] :
       {std::tuple{8, std::uint16_t{0x607A}, std::uint8_t{0}}, {7, std::uint16_t{0x60C1}, std::uint8_t{1}}}) {
    const std::int64_t from = bench.read(kId, 0x6064, 0);
    bench.enable(kId, 0, mode);
    bench.write(kId, 0x6040, 0, 2, 0x1F);
    for (int i = 1; i <= 44; ++i) {
      bench.write(kId, index, sub, 4, from + 10 * std::min(i, 40));
      bench.send("080#");
      bench.run(9ms);
    }
    EXPECT_EQ(bench.statusword(kId, 0) & 0x1000, 0x1000) << mode;
    EXPECT_EQ(bench.read(kId, 0x6064, 0), from + 400) << mode;
    bench.write(kId, 0x6040, 0, 2, 0);
  }
  EXPECT_FALSE(bench.was_seen(0x081));
}

TEST(NodeAsItComes, TheCounterOfSyncChangesOnlyWithoutAPeriod) {
  Bench bench({{.id = kId, .told = false}});
  EXPECT_EQ(bench.try_write(kId, 0x1019, 0, 1, 1), kInvalidValue);
  bench.write(kId, 0x1006, 0, 4, 10'000);
  EXPECT_EQ(bench.try_write(kId, 0x1019, 0, 1, 10), kDeviceState);
  bench.write(kId, 0x1006, 0, 4, 0);
  bench.write(kId, 0x1019, 0, 1, 10);
  bench.send("080#");
  bench.run(5ms);
  EXPECT_FALSE(bench.was_seen(0x081)) << "a master that is still busy with its nodes";
  bench.send("000#0101");
  bench.send("080#");
  bench.run(5ms);
  ASSERT_TRUE(bench.last(0x081));
  EXPECT_EQ(text_of(*bench.last(0x081)).substr(0, 8), "081#4082");
}

}  // namespace
}  // namespace kinebus::testing_bench
