#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include "gateway/description/machine_file.hpp"
#include "tools/workspace/optimise_text.hpp"
#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {
namespace {

ScanOptions coarse(int threads) {
  ScanOptions o;
  o.step_mm = 10;
  o.ray_step_mm = 15;
  o.tilt_step_rad = 9 * kRadPerDeg;
  o.threads = threads;
  return o;
}

std::string said(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& f : findings) text += printed("rule %d: %g ", static_cast<int>(f.rule), f.worst);
  return text;
}

TEST(LegRules, TheDefaultMachineKeepsThemAll) {
  const MachineDescription d = default_m1();
  const M1Geometry& g = *four_legs(d);
  const Wish wish;
  const Judgement judged =
      judge(g, d.bodies ? *d.bodies : BodiesDescription{}, wish, poses_of(wish.room, Density::fine()));
  EXPECT_TRUE(judged.holds()) << said(judged.findings);
  // As the header of its geometry says.
  EXPECT_NEAR(judged.of(LegRule::kLegAngle).worst / kRadPerDeg, 27.4, 0.1);
  EXPECT_NEAR(judged.of(LegRule::kCondition).worst, 7.34, 0.02);
  EXPECT_NEAR(judged.travel_mm.min, 53.8, 0.2);
  EXPECT_NEAR(judged.travel_mm.max, 525, 0.2);
}

TEST(LegRules, WhatTheKinematicsRefuseIsBroken) {
  const MachineDescription d = default_m1();
  M1Geometry g = *four_legs(d);
  const Wish wish;
  const auto poses = poses_of(wish.room, {});
  const auto verdict = [&](const Pose& pose) {
    M1Geometry free = g;
    free.limits = {};
    for (M1Leg& leg : free.legs) leg.travel_mm = {};
    return (*make_m1_kinematics(free))->check(Frame::kPart, pose).has_value();
  };
  for (const double length : {991.0, 900.0, 800.0, 700.0}) {
    for (M1Leg& leg : g.legs) leg.length_mm = length;
    for (std::size_t k = 0; k < poses.size(); k += 17)
      EXPECT_EQ(judge(g, std::nullopt, wish, {poses[k]}).holds(), verdict(poses[k])) << length << " " << k;
  }
}

TEST(Optimise, ABadMachineBecomesOneThatKeepsEveryRuleAndIsNoWorseThanTheDefault) {
  MachineDescription bad = default_m1();
  auto& g = std::get<M1Geometry>(bad.kinematics);
  for (std::size_t i = 0; i < 4; ++i) {
    M1Leg& leg = g.legs[i];
    leg.length_mm = 520;
    leg.carriage_above = true;
    // Legs 3 and 4 cross.
    leg.attachment_mm = {i < 2 ? 75.0 : -75.0, i % 2 == 0 ? 75.0 : -75.0, 0};
    leg.foot_mm = {i < 2 ? 310.0 : -310.0, i % 3 == 0 ? 210.0 : -210.0, 0};
  }
  const Wish wish;
  const Optimised o = optimise(bad, wish);
  EXPECT_FALSE(o.before.holds());
  ASSERT_TRUE(o.found()) << said(o.after.findings);
  const MachineDescription d = default_m1();
  const Judgement default_machine =
      judge(*four_legs(d), o.machine.bodies, wish, poses_of(wish.room, Density::fine()));
  EXPECT_LE(o.after.price(*four_legs(o.machine)), 1.02 * default_machine.price(*four_legs(d)));

  // The gateway takes the file as it is.
  const auto read = parse_machine(write_machine(o.machine), "found.toml");
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(*read, o.machine);
  // And says the same of it, pose by pose.
  const auto kinematics = *make_kinematics(*read);
  const bodies::Model model = make_collision_model(*read);
  const Scan s = scan(*kinematics, wish.room, coarse(2), model.get());
  EXPECT_TRUE(s.meetings.empty());
  EXPECT_NEAR(volume_mm3(s, -1), std::numbers::pi * 100 * 100 * 200, 1);

  const std::string text = rules_text(o.after, *model);
  EXPECT_NE(text.find("binds"), std::string::npos) << text;
  EXPECT_EQ(text.find("BROKEN"), std::string::npos) << text;
}

}  // namespace
}  // namespace kinebus::workspace
