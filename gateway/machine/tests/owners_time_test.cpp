// What the gateway asks of its owner's time in each state, and which time it takes for the present.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "gateway/machine/tests/hand_rig.hpp"
#include "protocol/can/candump.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class OwnersTime : public HandRig {
 protected:
  /// The longest that it leaves itself alone, while it is in this state and at most so long.
  BusTime longest(MachineState wanted, BusTime limit = 200ms) {
    BusTime most{0};
    for (const BusTime until = rig.now + limit; state() == wanted && rig.now < until; rig.run_for(170us)) {
      most = std::max(most, rig.gateway->next_deadline() - rig.now);
    }
    EXPECT_GT(most, 0ns) << "it is in another state";
    return most;
  }
  static bool is(BusTime found, BusTime wanted) { return found <= wanted && found > wanted * 4 / 5; }
  /// SYNC is rare.
  ::testing::AssertionResult ready_for_long() {
    const auto is_ready = ready();
    rig.run_for(25s);
    return is_ready;
  }
};

TEST_F(OwnersTime, AtRestItIsALongOne) {
  EXPECT_TRUE(is(longest(MachineState::kOff), 100ms));
  ASSERT_TRUE(ready_for_long());
  EXPECT_GT(longest(MachineState::kReady), 20ms);
  ASSERT_TRUE(runs_to(kLine, 20));
  ASSERT_TRUE(asks(command::Hold{}));
  EXPECT_TRUE(is(longest(MachineState::kHolding), 5ms));
  ASSERT_TRUE(rig.reach(MachineState::kHeld, 2s));
  EXPECT_GT(longest(MachineState::kHeld), 20ms);
  ASSERT_TRUE(asks(command::Stop{}));
  EXPECT_TRUE(is(longest(MachineState::kStopping), 5ms));
  ASSERT_TRUE(rig.reach(MachineState::kStopped, 2s));
  EXPECT_GT(longest(MachineState::kStopped), 20ms);
  ASSERT_TRUE(asks(command::Clear{}));
  EXPECT_TRUE(is(longest(MachineState::kStopped), 10ms)) << "it is being cleared";
}

TEST_F(OwnersTime, InMotionItIsAShortOne) {
  ASSERT_TRUE(ready_for_long());
  ASSERT_TRUE(asks(command::Jog{.delta = {30, 0, 0, 0, 0, 0}, .speed_per_s = 20}));
  EXPECT_TRUE(is(longest(MachineState::kMoving), 5ms));
  ASSERT_TRUE(asks(command::Cancel{}));
  EXPECT_TRUE(is(longest(MachineState::kCancelling), 5ms));
  ASSERT_TRUE(rig.reach(MachineState::kReady, 2s));
  ASSERT_TRUE(runs_to(kLine, 20));
  EXPECT_TRUE(is(longest(MachineState::kRunning), 5ms));
}

TEST_F(OwnersTime, WhileItIsBroughtUpAndWhileItHomes) {
  ASSERT_TRUE(asks(command::BringUp{}));
  EXPECT_TRUE(is(longest(MachineState::kBringUp, 100ms), 10ms)) << "it listens";
  ASSERT_TRUE(rig.reach(MachineState::kUnhomed, 30s));
  rig.run_for(25s);
  EXPECT_GT(longest(MachineState::kUnhomed), 20ms);
  ASSERT_TRUE(asks(command::Home{}));
  EXPECT_TRUE(is(longest(MachineState::kHoming), 10ms));
}

TEST_F(OwnersTime, SmallerPiecesOfAJobComeMoreOften) {
  std::string text;
  for (int i = 0; i < 900; ++i) text += "G90\n";
  text += kLine;
  for (const int budget : {400, 100}) {
    use(rig.machine, {.planning_budget = budget});
    ASSERT_TRUE(asks(command::BringUp{}));
    ASSERT_TRUE(rig.run_until([&] { return state() != MachineState::kBringUp; }, 30s));
    if (state() == MachineState::kUnhomed) {
      ASSERT_TRUE(asks(command::Home{}));
    }
    ASSERT_TRUE(rig.reach(MachineState::kReady, 60s));
    rig.run_for(25s);
    ASSERT_TRUE(runs(text));
    const BusTime piece = budget * 2500ns;  // 1 ms for 400 lines
    EXPECT_TRUE(is(longest(MachineState::kChecking, 3ms), piece)) << budget;
    ASSERT_TRUE(rig.reach(MachineState::kRunning, 5s));
    EXPECT_TRUE(is(longest(MachineState::kRunning), 5ms)) << "all that is needed is planned";
    ASSERT_TRUE(asks(command::Cancel{}));
    ASSERT_TRUE(rig.reach(MachineState::kReady, 5s));
  }
}

TEST_F(OwnersTime, ThePresentIsTheLatestTimeThatItWasTold) {
  Gateway& gateway = *rig.gateway;
  const CanFrame frame = *parse_frame("703#05");
  const auto now = [&] { return gateway.status().now; };
  gateway.on_time(1s);
  EXPECT_EQ(now(), 1s);
  gateway.on_frame(2s, frame);
  EXPECT_EQ(now(), 2s);
  gateway.on_frame_sent(3s, frame);
  EXPECT_EQ(now(), 3s);
  static_cast<void>(gateway.next_frame(4s));
  EXPECT_EQ(now(), 4s);
  gateway.on_stall(5s, 1s, say("a test"));
  EXPECT_EQ(now(), 5s);
  gateway.on_bus_failure(6s, "gone");
  EXPECT_EQ(now(), 6s);
  gateway.on_time(1s);
  gateway.on_frame(1s, frame);
  gateway.on_frame_sent(1s, frame);
  static_cast<void>(gateway.next_frame(1s));
  gateway.on_stall(1s, 1s, say("a test"));
  gateway.on_bus_failure(1s, "gone");
  EXPECT_EQ(now(), 6s) << "time does not go back";
  EXPECT_EQ(gateway.status().counters.frames_received, 2U);
  EXPECT_EQ(gateway.status().counters.frames_sent, 2U);
}

}  // namespace
}  // namespace kinebus
