// A probe with a pin against one that follows the maker's data sheet, and what can break of it.

#include <gtest/gtest.h>

#include "node_firmware/heat/pin_probe.hpp"
#include "node_firmware/port/host/pin_probe_plant.hpp"

namespace kinebus::heat {
namespace {

using namespace std::chrono_literals;

struct PinBench {
  PinProbe probe;
  PinProbePlant plant;
  LocalTime now{0};
  PinBench() { probe.fit(true); }
  void run_for(LocalTime time) {
    for (const LocalTime end = now + time; now < end; now += 10ms) {
      plant.step(probe.pulse());
      probe.on_sample(now, plant.line());
    }
  }
  PinState after(PinCommand command) {
    EXPECT_TRUE(probe.command(now, command));
    const LocalTime begun = now;
    while (probe.state() == PinState::kMoves && now - begun < 10s) run_for(10ms);
    return probe.state();
  }
};

TEST(PinProbe, ComesOutTellsOfATouchAndGoesIn) {
  PinBench bench;
  EXPECT_EQ(bench.probe.pulse(), 0) << "nothing moves before a command";
  ASSERT_EQ(bench.after(PinCommand::kDeploy), PinState::kDeployed);
  EXPECT_LE(bench.now, 1s);
  EXPECT_TRUE(bench.plant.out());
  bench.run_for(1s);
  EXPECT_FALSE(bench.probe.level());
  bench.plant.meet(-0.01);
  bench.run_for(100ms);
  EXPECT_TRUE(bench.probe.level()) << "and stays so";
  bench.plant.meet(3);
  ASSERT_EQ(bench.after(PinCommand::kStow), PinState::kStowed);
  EXPECT_FALSE(bench.plant.out());
  EXPECT_FALSE(bench.probe.level());
}

TEST(PinProbe, APinThatStaysInIsNotTakenForOneThatIsOut) {
  PinBench bench;
  bench.plant.stays_in = true;
  const PinState state = bench.after(PinCommand::kDeploy);
  EXPECT_TRUE(state == PinState::kAlarm || state == PinState::kNotOut);
  EXPECT_LE(bench.now, 4s);
  bench.plant.mend();
  EXPECT_EQ(bench.after(PinCommand::kReset), PinState::kStowed);
  EXPECT_EQ(bench.after(PinCommand::kDeploy), PinState::kDeployed);
}

TEST(PinProbe, APinThatHangsOutIsNotTakenForOneThatIsIn) {
  PinBench bench;
  ASSERT_EQ(bench.after(PinCommand::kDeploy), PinState::kDeployed);
  bench.plant.hangs_out = true;
  EXPECT_EQ(bench.after(PinCommand::kStow), PinState::kNotIn);
}

TEST(PinProbe, AMagnetThatHoldsNothingIsFoundWhenTheBedNoLongerDoes) {
  for (const bool again : {false, true}) {
    PinBench bench;
    ASSERT_EQ(bench.after(PinCommand::kDeploy), PinState::kDeployed);
    bench.plant.falls_out = true;
    bench.plant.meet(-0.01);
    EXPECT_EQ(bench.after(PinCommand::kStow), PinState::kStowed) << "the bed holds it in";
    bench.plant.meet(3);
    bench.run_for(1s);
    EXPECT_TRUE(bench.plant.out());
    EXPECT_EQ(bench.after(again ? PinCommand::kDeploy : PinCommand::kStow), PinState::kNotIn);
  }
}

TEST(PinProbe, AnAlarmIsResetOnceAndThenBelieved) {
  PinBench bench;
  bench.plant.alarm(false);
  EXPECT_EQ(bench.after(PinCommand::kDeploy), PinState::kDeployed);
  bench.plant.alarm(true);
  EXPECT_EQ(bench.after(PinCommand::kStow), PinState::kAlarm);
}

TEST(PinProbe, NothingMovesWhereNoneIsFitted) {
  PinProbe probe;
  EXPECT_FALSE(probe.command(LocalTime{0}, PinCommand::kDeploy));
  EXPECT_EQ(probe.pulse(), 0);
}

}  // namespace
}  // namespace kinebus::heat
