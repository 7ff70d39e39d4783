// Order, ways and surveys of homing, on the machines that are shipped and on some that are wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/machine_homing.hpp"
#include "gateway/description/machines_folder.hpp"

namespace kinebus::homing {
namespace {

MachineDescription shipped(const std::string& name) {
  auto machine = load_machine(machines_folder() / (name + ".toml"));
  if (!machine) throw std::runtime_error(to_string(machine.error()));
  return *machine;
}

/// "tower1- tower2- | X-"
std::string order_of(const MachineDescription& machine) {
  const HomingStudy study(machine);
  std::string text;
  for (const Stage& stage : study.plan().stages) {
    if (!text.empty()) text += "| ";
    for (const Joint& j : stage.joints) text += machine.joints[j.joint].name + (j.positive ? "+ " : "- ");
  }
  return text;
}

TEST(HomingPlan, TakesToolAndTableApartFirst) {
  EXPECT_EQ(order_of(default_m1()), "tower1- tower2- tower3- tower4- ");
  EXPECT_EQ(order_of(shipped("m5")), "rail1+ rail2+ rail3+ rail4+ ");
  EXPECT_EQ(order_of(shipped("m4")), "rail1+ rail2+ rail3+ | X- ");
  EXPECT_EQ(order_of(shipped("delta")), "tower1+ tower2+ tower3+ ");
  EXPECT_EQ(order_of(shipped("cartesian")), "Z+ | X- Y- ");
  EXPECT_EQ(order_of(shipped("corexy")), "Z+ ");
  const HomingStudy m1(default_m1());
  EXPECT_EQ(m1.plan().stages[0].effect, Effect::kParts);
  EXPECT_NEAR(m1.plan().stages[0].parting_mm_per_s, 40, 0.01) << "all carriages move the table as one";
}

TEST(HomingPlan, LiftsAtTheRatesThatTakeTheToolStraightAway) {
  for (const char* name : {"m1", "m2", "m3", "m5", "delta", "cartesian", "corexy"}) {
    const HomingStudy study(shipped(name));
    for (const Stage& stage : study.plan().stages)
      EXPECT_TRUE(stage.lift_per_s.empty()) << name << ": their own speeds do it";
  }
  const HomingStudy m4(shipped("m4"));
  ASSERT_EQ(m4.plan().stages.size(), 2u);
  EXPECT_TRUE(m4.plan().stages[1].lift_per_s.empty());
  const std::vector<double>& lift = m4.plan().stages[0].lift_per_s;
  ASSERT_EQ(lift.size(), 3u);
  for (const double speed : lift) EXPECT_NEAR(speed, 30, 1e-6) << "the slowest of the three";
  // From anywhere: the same rates, and neither sideways nor tilted.
  for (Pose pose : {Pose{0, 0, 10, 0, 0, 0}, Pose{50, -150, 40, 0.4, 0, 0}, Pose{-90, 120, 5, -0.4, 0, 0}}) {
    const Pose from = pose;
    JointVector q{};
    ASSERT_TRUE(m4.kinematics().inverse(Frame::kPart, from, q));
    for (std::size_t i = 0; i < lift.size(); ++i) q[i] += 2 * lift[i];
    ASSERT_TRUE(m4.kinematics().forward(Frame::kPart, q, pose));
    EXPECT_NEAR(pose[kZ], from[kZ] + 60, 1e-6);
    EXPECT_NEAR(pose[kY], from[kY], 1e-6);
    EXPECT_NEAR(pose[kA], from[kA], 1e-9);
  }
}

TEST(HomingPlan, AMachineWhoseCarriagesGoAtDifferentSpeedsLiftsWithEqualOnes) {
  MachineDescription machine = shipped("delta");
  machine.joints[1].homing->fast_per_s = 55;
  const HomingStudy study(machine);
  const std::vector<double>& lift = study.plan().stages.at(0).lift_per_s;
  ASSERT_EQ(lift.size(), 3u);
  for (const double speed : lift) EXPECT_NEAR(speed, machine.joints[0].homing->fast_per_s, 1e-6);
}

TEST(HomingPlan, BringsToolAndTableTogetherLast) {
  MachineDescription machine = shipped("cartesian");
  machine.joints[2].homing->method = 22;
  machine.joints[2].homing->switch_position = machine.joints[2].travel.min;
  EXPECT_EQ(order_of(machine), "X- Y- | Z- ");
  EXPECT_EQ(HomingStudy(machine).plan().stages[1].effect, Effect::kNears);
}

TEST(HomingPlan, FollowsAnOrderThatTheFileStates) {
  MachineDescription machine = shipped("cartesian");
  const int order[] = {3, 1, 2};
  for (std::size_t j = 0; j < 3; ++j) machine.joints[j].homing->order = static_cast<std::uint8_t>(order[j]);
  EXPECT_EQ(order_of(machine), "Y- | Z+ | X- ");
}

MachineDescription m1_with_bodies() {
  MachineDescription machine = default_m1();
  machine.bodies.emplace();
  machine.bodies->table_radius_mm = 100;
  return machine;
}

std::string told(const Survey& found) {
  if (!found.failure) return {};
  const auto& [start, way] = *found.failure;
  return std::string(start.model->words(way.nearest)) + " part " + std::to_string(start.part_radius_mm) +
         " " + std::to_string(start.part_height_mm);
}

// M1's promised cylinder as the greatest part. More starts: kinebus plan --home.
TEST(HomingSurvey, NothingTouchesOnM1WithAPartOnTheTable) {
  constexpr std::uint64_t kSeed = 1;
  constexpr int kStarts = 150;
  HomingStudy study(m1_with_bodies());
  study.set_part(100, 200);
  const Survey found = survey(study.machine(), study.plan(), kSeed, kStarts);
  EXPECT_EQ(found.starts, kStarts);
  EXPECT_GT(found.on_switch, kStarts / 8);
  EXPECT_GT(found.under_tool, kStarts / 50);
  EXPECT_TRUE(found.safe()) << told(found);
  EXPECT_GE(found.nearest.mm, 1.9);
  EXPECT_LE(found.spread_mm, default_m1().homing.max_spread_mm)
      << "the watch on the carriages lets them home";
  EXPECT_LE(found.worst_condition, 8);
}

// As wide and high as its workspace, and the tool often right beside it. More starts: kinebus plan --home.
TEST(HomingSurvey, NothingTouchesOnM4WithAPartOnTheTable) {
  HomingStudy study(shipped("m4"));
  study.set_part(170, 200);
  const Survey found = survey(study.machine(), study.plan(), 1, 400, {}, 200, Starts::corner_count());
  EXPECT_GT(found.starts, 400);
  EXPECT_GT(found.on_switch, 40);
  EXPECT_GT(found.under_tool, 40);
  EXPECT_TRUE(found.safe()) << told(found);
  EXPECT_LE(found.worst_condition, 20) << "of its work";
}

// All of its workspace, too: beside a tower a carriage stands highest.
TEST(HomingSurvey, NothingTouchesOnADeltaWithAPartAsHighAsItsWorkspace) {
  const MachineDescription delta = shipped("delta");
  HomingStudy study(delta);
  study.set_part(140, 290);
  const Survey found = survey(study.machine(), study.plan(), 1, 300, {}, 200, Starts::corner_count());
  EXPECT_GT(found.starts, 300);
  EXPECT_GT(found.under_tool, 30);
  EXPECT_TRUE(found.safe()) << told(found);
  EXPECT_GE(found.nearest.mm, 1.9);
  EXPECT_LE(found.spread_mm, delta.homing.max_spread_mm);
  for (int ray = 0; ray < 12; ++ray) {
    const double angle = ray * std::numbers::pi / 6;
    EXPECT_TRUE(study.machine().kinematics->check(
        Frame::kPart, Pose{140 * std::cos(angle), 140 * std::sin(angle), 290, 0, 0, 0}))
        << ray;
  }
}

TEST(HomingSurvey, TheOthersCloseAllTheWay) {
  for (const char* name : {"m4", "m5", "delta", "cartesian", "corexy"}) {
    MachineDescription machine = shipped(name);
    machine.bodies.reset();
    const HomingStudy study(machine);
    const Survey found = survey(study.machine(), study.plan(), 1, 100);
    EXPECT_EQ(found.starts, 100) << name;
    EXPECT_EQ(found.not_closed, 0) << name;
    EXPECT_LE(found.spread_mm, machine.homing.max_spread_mm) << name;
  }
}

TEST(HomingSurvey, TheSameSeedGivesTheSameStarts) {
  const HomingStudy study(m1_with_bodies());
  Starts a(study.machine(), 5), b(study.machine(), 5), c(study.machine(), 6);
  for (int n = 0; n < 5; ++n) {
    const auto one = a.next(), same = b.next(), other = c.next();
    ASSERT_TRUE(one && same && other);
    EXPECT_EQ(one->joints, same->joints);
    EXPECT_EQ(one->part_height_mm, same->part_height_mm);
    EXPECT_NE(one->joints, other->joints);
  }
}

// A tall part swings about the tilted table's axis while the first carriages stand on their switches.
TEST(HomingSurvey, CornersFindAPartThatIsTooTall) {
  const auto corners_of = [](const MachineDescription& machine, double radius, double height) {
    HomingStudy study(machine);
    study.set_part(radius, height);
    return survey(study.machine(), study.plan(), 1, 0, {}, 1, 32);
  };
  const Survey room_below = corners_of(m1_with_bodies(), 100, 250);
  EXPECT_TRUE(room_below.safe()) << told(room_below);
  // Its switches where its work ends.
  MachineDescription near = m1_with_bodies();
  for (std::size_t j = 0; j < 4; ++j) near.joints[j].travel.min = near.joints[j].homing->switch_position = 40;
  const auto corners_with = [&](double radius, double height) { return corners_of(near, radius, height); };
  const Survey promised = corners_with(100, 200);
  EXPECT_GT(promised.corners, 16);
  EXPECT_EQ(promised.starts, promised.corners);
  EXPECT_TRUE(promised.safe()) << told(promised);
  const Survey tall = corners_with(100, 250);
  EXPECT_GT(tall.touching, 0);
  EXPECT_LE(tall.failure->way.nearest.mm, 0.2);
}

// Rail 1 stood on its switch, moved by hand, and the spindle as askew as it works.
TEST(HomingWay, M4TiltsFartherThanItWorksAndClosesAllTheWay) {
  const MachineDescription machine = shipped("m4");
  const HomingStudy study(machine);
  for (Pose pose : {Pose{38.09, -222.6, 85.28, 25 * kRadPerDeg, 0, 0},
                    Pose{6.178, -218.5, 66.65, 25 * kRadPerDeg, 0, 0}}) {
    JointVector joints{};
    ASSERT_TRUE(study.machine().mechanism->inverse(Frame::kMachine, pose, joints));
    const bodies::Model model = make_collision_model(machine);
    const Way way = Walker(*study.machine().mechanism, study.plan(), model.get(), {}).walk(joints, pose);
    EXPECT_EQ(way.end, Way::End::kHome) << model->words(way.nearest);
    EXPECT_LT(way.worst_condition, 30);
  }
}

// Carriages that look for switches at their upper ends drive the table into the nozzle.
TEST(HomingSurvey, FindsThatHomingUpwardsDrivesThePartIntoTheTool) {
  MachineDescription machine = m1_with_bodies();
  for (std::size_t j = 0; j < 4; ++j) {
    machine.joints[j].homing->method = 20;
    machine.joints[j].homing->switch_position = machine.joints[j].travel.max;
  }
  const HomingStudy study(machine);
  EXPECT_EQ(study.plan().stages[0].effect, Effect::kNears);
  const Survey found = survey(study.machine(), study.plan(), 1, 20);
  ASSERT_TRUE(found.failure);
  EXPECT_FALSE(found.safe());
  EXPECT_LE(found.failure->way.nearest.mm, 0.2);
}

TEST(HomingWay, AThingThatStandsUnderTheTableIsFound) {
  MachineDescription machine = m1_with_bodies();
  HomingStudy free(machine);
  const Plan plan = free.plan();
  JointVector joints{};
  Pose pose = free.kinematics().bed_reference();
  ASSERT_TRUE(free.kinematics().inverse(Frame::kMachine, pose, joints));
  const bodies::Model empty = make_collision_model(machine);
  const Way clear = Walker(*free.machine().mechanism, plan, empty.get(), {}).walk(joints, pose);
  EXPECT_EQ(clear.end, Way::End::kHome);
  // The table comes down to 1340 - 317 mm, and its arms lie under it.
  machine.bodies->fixed.push_back({.name = "lamp", .from_mm = {-20, -20, 900}, .to_mm = {20, 20, 1010}});
  const bodies::Model blocked = make_collision_model(machine);
  const Way way = Walker(*free.machine().mechanism, plan, blocked.get(), {}).walk(joints, pose);
  EXPECT_EQ(way.end, Way::End::kTouches);
  EXPECT_NE(std::string(blocked->words(way.nearest)).find("lamp"), std::string::npos);
  EXPECT_GT(way.at[kZ], pose[kZ] + 200) << "on its way down";
}

}  // namespace
}  // namespace kinebus::homing
