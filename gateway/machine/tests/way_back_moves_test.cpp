// The moves that lead back to a job's place, one by one, from wherever the axes were found.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <variant>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/recovery.hpp"

namespace kinebus {
namespace {

class WayBackMoves : public ::testing::Test {
 protected:
  static constexpr Pose kPlace{20, 10, 30, 0, 0, 100};

  WayBackMoves() {
    machine.resume.lift_mm = 4;
    machine.resume.approach_mm_per_s = 6;
  }
  /// The axes stand at this pose, but for so many counts of the first carriage's and the filament's.
  void found_at(const Pose& pose, double carriage = 0, double filament = 0) {
    JointVector joints{};
    ASSERT_TRUE(kinematics->inverse(Frame::kMachine, pose, joints));
    for (const NodeAxes& node : axes) {
      std::array<AxisState, kAxesPerNode> states{};
      for (std::size_t axis = 0; axis < kAxesPerNode; ++axis) {
        const AxisScaling& scaling = node.axes[axis];
        if (scaling.joint < 0) continue;
        double counts = scaling.to_counts(joints[static_cast<std::size_t>(scaling.joint)]);
        counts += scaling.joint == 0 ? carriage : scaling.joint == 5 ? filament : 0;
        states[axis].position = to_fixed(counts);
      }
      group.set_state(node.node_id, states, {});
    }
    position.take_run_end();
  }
  /// "up 30.5", "over 20 10 34": what it does, and where to, one a line; or why not.
  std::string way(const Pose& from, const Pose& place = kPlace) {
    const auto moves = recovery.way_back({place, Frame::kMachine, 1}, from, position);
    if (!moves) return moves.error().words.english();
    std::string text;
    for (const canonical::Line& line : *moves) {
      const auto* feed = std::get_if<canonical::Feed>(&line.command);
      const auto* traverse = std::get_if<canonical::Traverse>(&line.command);
      EXPECT_TRUE(feed != nullptr || traverse != nullptr);
      const Pose& to = feed != nullptr ? feed->target : traverse->target;
      char words[120];
      std::snprintf(words, sizeof words, "%s X%g Y%g Z%g E%g", feed != nullptr ? "feed" : "go", to[kX],
                    to[kY], to[kZ], to[kE]);
      text += words;
      if (feed != nullptr) {
        std::snprintf(words, sizeof words, " F%g", feed->feed_per_s);
        text += words;
      }
      text += '\n';
    }
    return text;
  }
  static Pose moved(PoseAxis axis, double by, Pose pose = kPlace) {
    pose[axis] += by;
    return pose;
  }
  std::string from_where_it_is(const Pose& pose) {
    found_at(pose);
    return way(pose);
  }

  MachineDescription machine = default_m1();
  std::unique_ptr<Kinematics> kinematics = std::move(*make_kinematics(machine));
  std::vector<NodeAxes> axes = node_axes(machine);
  StreamGroup group{*kinematics, axes, stream_options(machine)};
  Position position{machine, *kinematics, axes, group};
  journal::Queue journal;
  Recovery recovery{machine, *kinematics, journal};
};

TEST_F(WayBackMoves, NoneFromItsPlaceToACountOrThree) {
  EXPECT_EQ(from_where_it_is(kPlace), "");
  found_at(kPlace, 2.9);
  EXPECT_EQ(way(kPlace), "");
  found_at(kPlace, 0, 2.9);
  EXPECT_EQ(way(kPlace), "");
  found_at(kPlace, 3.1);
  EXPECT_EQ(way(kPlace), "feed X20 Y10 Z30 E100 F5\n");
  found_at(kPlace, 0, -3.1);
  EXPECT_EQ(way(kPlace), "feed X20 Y10 Z30 E100 F5\n");
}

TEST_F(WayBackMoves, StraightFromNextToIt) {
  EXPECT_EQ(from_where_it_is(moved(kX, 0.4)), "feed X20 Y10 Z30 E100 F5\n");
  EXPECT_EQ(from_where_it_is(moved(kZ, -0.4)), "feed X20 Y10 Z30 E100 F5\n");
}

TEST_F(WayBackMoves, UpOverAndDownFromFarAway) {
  const std::string down = "go X20 Y10 Z34 E100\nfeed X20 Y10 Z30 E100 F6\n";
  EXPECT_EQ(from_where_it_is(moved(kX, -15)), "go X5 Y10 Z34 E100\ngo X20 Y10 Z34 E100\n" + down);
  EXPECT_EQ(from_where_it_is(moved(kY, 0.6)), "go X20 Y10.6 Z34 E100\ngo X20 Y10 Z34 E100\n" + down);
  EXPECT_EQ(from_where_it_is(moved(kX, -15, moved(kZ, 10))), "go X20 Y10 Z40 E100\n" + down)
      << "it is higher than that";
  EXPECT_EQ(from_where_it_is(moved(kA, 0.02)).substr(0, 3), "go ") << "one that is turned is not next to it";
  EXPECT_EQ(from_where_it_is(moved(kA, 0.005)), "feed X20 Y10 Z30 E100 F5\n");
}

TEST_F(WayBackMoves, FilamentFollowsWhenTheToolIsThereIfItWasNotMovedOnPurpose) {
  EXPECT_EQ(from_where_it_is(moved(kE, 0.4)), "feed X20 Y10 Z30 E100 F5\n");
  EXPECT_EQ(from_where_it_is(moved(kE, 0.6)), "");
  EXPECT_EQ(from_where_it_is(moved(kE, -0.6)), "");
  EXPECT_EQ(from_where_it_is(moved(kX, -15, moved(kE, 0.4))),
            "go X5 Y10 Z34 E100.4\ngo X20 Y10 Z34 E100.4\ngo X20 Y10 Z34 E100.4\n"
            "feed X20 Y10 Z30 E100.4 F6\nfeed X20 Y10 Z30 E100 F5\n");
}

TEST_F(WayBackMoves, FilamentThatNobodyKnowsOfIsPrimed) {
  recovery.lose_filament();
  EXPECT_EQ(from_where_it_is(moved(kE, 0.4)), "") << "by nothing";
  machine.resume.prime_mm = 2;
  EXPECT_EQ(from_where_it_is(moved(kE, 0.4)), "feed X20 Y10 Z30 E102.4 F3\n");
  const PlannedPose place{kPlace, Frame::kMachine, 1};
  EXPECT_NEAR(recovery.finish_return(place, moved(kE, 2.4)), 2.4, 1e-9);
  EXPECT_EQ(from_where_it_is(moved(kE, 0.4)), "feed X20 Y10 Z30 E100 F5\n") << "known again";
}

TEST_F(WayBackMoves, TheJobsFilamentIsWhereItWasMovedOnPurpose) {
  const PlannedPose place{kPlace, Frame::kMachine, 1};
  recovery.go_on();
  EXPECT_EQ(recovery.finish_return(place, moved(kE, 0.4)), 0);
  EXPECT_FALSE(recovery.going_on());
  EXPECT_NEAR(recovery.finish_return(place, moved(kE, -0.6)), -0.6, 1e-9);
  EXPECT_EQ(recovery.finish_return(place, std::nullopt), 0);
  recovery.lose_filament();
  recovery.job_begins();
  EXPECT_EQ(recovery.finish_return(place, moved(kE, 0.4)), 0) << "a new job begins where it is";
}

TEST_F(WayBackMoves, UnderTheEndOfTheWorkspaceItRisesAsFarAsItCan) {
  Pose high = kPlace;
  while (kinematics->check(Frame::kMachine, moved(kZ, 4, high))) high[kZ] += 1;
  ASSERT_TRUE(kinematics->check(Frame::kMachine, high));
  found_at(moved(kX, -3, high));
  const std::string text = way(moved(kX, -3, high), high);
  char z[20];
  std::snprintf(z, sizeof z, "Z%g", high[kZ]);
  EXPECT_EQ(text.find("go X20 Y10 " + std::string(z)), 0U) << text;
}

TEST_F(WayBackMoves, APlaceOutOfReachIsSaid) {
  found_at(kPlace);
  EXPECT_EQ(way(kPlace, moved(kX, 5000)).find("the job's place cannot be reached: "), 0U);
}

}  // namespace
}  // namespace kinebus
