// What the gateway says by itself, and how often.

#include <gtest/gtest.h>

#include "gateway/machine/bus_voice.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

class BusVoiceTest : public ::testing::Test {
 protected:
  struct Said {
    int syncs = 0, heartbeats = 0;
  };
  /// Up to `until`, in turns of a millisecond; every frame goes out at once.
  Said listen(BusTime until, bool bringing_up = false) {
    Said said;
    for (; now < until; now += 1ms) {
      voice.on_time(now, bringing_up);
      while (const auto frame = voice.next_frame(now)) {
        voice.on_frame_sent(now, *frame);
        said.syncs += frame->id == cob_id::kSync ? 1 : 0;
        said.heartbeats += frame->id == cob_id::kHeartbeat + kGatewayNodeId ? 1 : 0;
      }
    }
    return said;
  }

  MachineDescription machine = default_m1();
  BusVoice voice{machine, 1};
  BusTime now{0};
};

TEST_F(BusVoiceTest, SaysNothingUntilItBegins) {
  const Said said = listen(1s);
  EXPECT_EQ(said.syncs + said.heartbeats, 0);
  EXPECT_FALSE(voice.speaks());
  EXPECT_EQ(voice.next_deadline(now, 5s), 5s);
}

TEST_F(BusVoiceTest, SyncIsDenseUntilClocksAgreeAndGrowsRareBySteps) {
  voice.begin(now);
  EXPECT_NEAR(listen(6s).syncs, 1200, 3);
  EXPECT_NEAR(listen(9s).syncs, 300, 3);
  EXPECT_NEAR(listen(18s).syncs, 360, 3);
  const double usual_s = to_seconds(BusTime{machine.bus.sync_period});
  EXPECT_NEAR(listen(28s).syncs, 10 / usual_s, 3);
  voice.begin(now);
  EXPECT_NEAR(listen(38s).syncs, 10 / usual_s, 3) << "it has begun already";
}

TEST_F(BusVoiceTest, SyncIsDenseAgainForNodesThatAreBroughtUp) {
  voice.begin(now);
  listen(20s);
  EXPECT_NEAR(listen(21s, true).syncs, 200, 3);
  voice.nodes_are_new(now);
  EXPECT_NEAR(listen(27s).syncs, 1200, 3);
}

TEST_F(BusVoiceTest, ItsHeartbeatComesInTime) {
  voice.begin(now);
  listen(1s);
  EXPECT_NEAR(listen(11s).heartbeats, 10 / to_seconds(BusTime{machine.bus.heartbeat_period}), 1.5);
}

}  // namespace
}  // namespace kinebus
