#include "gateway/bodies/sweep.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"

namespace kinebus::bodies {
namespace {

/// A path that wanders through the workspace and out of it.
class Walk {
 public:
  explicit Walk(std::uint32_t seed) : source_(seed) {}
  Pose next(double step_mm, double step_rad) {
    for (std::size_t k = 0; k < 3; ++k) {
      speed_[k] = 0.98 * speed_[k] + 0.2 * in(-1, 1);
      pose_[k] += step_mm * std::clamp(speed_[k], -0.57, 0.57);
    }
    speed_[kA] = 0.98 * speed_[kA] + 0.2 * in(-1, 1);
    pose_[kA] += step_rad * std::clamp(speed_[kA], -1.0, 1.0);
    pose_[kX] = std::clamp(pose_[kX], -180.0, 180.0);
    pose_[kY] = std::clamp(pose_[kY], -180.0, 180.0);
    pose_[kZ] = std::clamp(pose_[kZ], -10.0, 250.0);
    pose_[kA] = std::clamp(pose_[kA], -0.9, 0.9);
    return pose_;
  }

 private:
  double in(double low, double high) { return std::uniform_real_distribution<>(low, high)(source_); }
  std::mt19937 source_;
  Pose pose_{0, 0, 60, 0, 0, 0}, speed_{};
};

TEST(Sweep, SaysAtEveryPoseWhatMeasuringAllPairsSays) {
  MachineDescription d = legs_below();
  d.bodies->clearance_mm = 10;
  const Model model = make_collision_model(d);
  int near = 0, clear = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    Walk walk(seed);
    Sweep sweep(*model);
    for (int n = 0; n < 2000; ++n) {
      const Pose pose = walk.next(1, 0.01);
      const auto all = model->clearance(Frame::kPart, pose);
      const Sweep::Step step = sweep.to(Frame::kPart, pose);
      if (!all) {
        EXPECT_EQ(step, Sweep::Step::kOutOfReach) << "seed " << seed << ", pose " << n;
        continue;
      }
      ASSERT_NE(step, Sweep::Step::kCoarse) << "10 mm are more than a step of 1 mm can take";
      EXPECT_EQ(step == Sweep::Step::kNear, all->mm < 10)
          << "seed " << seed << ", pose " << n << ": " << all->mm;
      if (step == Sweep::Step::kNear) {
        ++near;
        EXPECT_NEAR(std::max(sweep.nearest().mm, 0.0), std::max(all->mm, 0.0), 2e-3);
      } else {
        ++clear;
      }
    }
  }
  EXPECT_GT(near, 100);
  EXPECT_GT(clear, 2000);
}

/// Line beside line, as infill is, 2 mm apart in a square of 80 mm.
template <typename See>
void for_each_of_a_layer(double z_mm, double tilt_rad, const See& see) {
  for (int line = 0; line <= 40; ++line)
    for (int n = 0; n <= 80; ++n)
      see(Pose{line % 2 == 0 ? n - 40.0 : 40.0 - n, 2.0 * line - 40, z_mm, tilt_rad, 0, 0});
}

/// Whether something is too near at that pose: the sweep says so, and measuring all pairs says the same.
bool near_by_both(const CollisionModel& model, Sweep& sweep, const Pose& pose) {
  const auto all = model.clearance(Frame::kPart, pose);
  if (!all) {
    ADD_FAILURE() << "out of reach";
    return false;
  }
  Sweep::Step step = sweep.to(Frame::kPart, pose);
  if (step == Sweep::Step::kCoarse) {
    sweep.jump();
    step = sweep.to(Frame::kPart, pose);
  }
  const bool near = step == Sweep::Step::kNear;
  EXPECT_EQ(near, all->mm < model.wanted_mm())
      << "X " << pose[kX] << " Y " << pose[kY] << " Z " << pose[kZ] << ": " << all->mm;
  return near;
}

TEST(Sweep, WhereAPathHasBeenClearItIsNotMeasuredAgain) {
  const Model model = make_collision_model(legs_below());
  for (const double tilt : {0.0, 0.5}) {
    Sweep sweep(*model);
    std::uint64_t first = 0;
    for (int layer = 0; layer < 8; ++layer) {
      sweep.jump();
      for_each_of_a_layer(20 + 0.3 * layer, tilt,
                          [&](const Pose& p) { ASSERT_EQ(sweep.to(Frame::kPart, p), Sweep::Step::kClear); });
      if (layer == 0) first = sweep.measured();
    }
    EXPECT_GT(first, 0u) << "tilt " << tilt;
    // Seven layers more, and cells of 4 mm are full after a while.
    EXPECT_LT(sweep.measured(), 3 * first) << "tilt " << tilt;
  }
}

TEST(Sweep, WhereItComesBackToItSaysWhatMeasuringAllPairsSays) {
  MachineDescription d = legs_below();
  // The table's rim comes to it in a part of each layer.
  d.bodies->fixed.push_back({"lamp", {125, -20, 1200}, {135, 20, 1400}});
  const Model model = make_collision_model(d);
  for (const double tilt : {0.0, 0.3}) {
    SCOPED_TRACE(tilt);
    Sweep sweep(*model);
    int near = 0, clear = 0;
    for (int layer = 0; layer < 4; ++layer)
      for_each_of_a_layer(20 + 0.3 * layer, tilt,
                          [&](const Pose& pose) { ++(near_by_both(*model, sweep, pose) ? near : clear); });
    EXPECT_GT(near, 500) << "tilt " << tilt;
    EXPECT_GT(clear, 5000) << "tilt " << tilt;
    // Twice along the border between both, line by line, there is little room.
    EXPECT_LT(sweep.measured(), static_cast<std::uint64_t>(near + clear / 2)) << "tilt " << tilt;
  }
}

TEST(Sweep, WhatIsPrintedIsFoundWhereThePathWasClearBefore) {
  MachineDescription d = legs_below();
  // 20 mm over the nozzle's tip, beside it.
  d.bodies->fixed.push_back({"beam", {30, -60, 1320}, {60, 60, 1340}});
  const Model model = make_collision_model(d);
  PrintedPart printed;
  Sweep sweep(*model, Occasion::kMotion, &printed);
  const auto met_at = [&](double x, double z) {
    return sweep.to(Frame::kPart, {x, 0, z, 0, 0, 0}) == Sweep::Step::kNear && sweep.met_print();
  };
  for (double z = 45; z >= 1; --z) EXPECT_FALSE(met_at(0, z)) << "nothing is printed, Z " << z;
  const std::uint64_t before = sweep.measured();
  for (double z = 1; z <= 45; ++z) {
    for (double x = -40; x <= 40; ++x) printed.add({x, 0, z});
    EXPECT_FALSE(met_at(0, z)) << "the part ends at the tip, Z " << z;
  }
  EXPECT_GT(sweep.measured(), before);
  // Back down the same way the part comes up to the beam: 45 mm less the 20, and what bodies keep.
  double z = 45;
  while (z > 0 && !met_at(0, z)) z -= 0.5;
  EXPECT_NEAR(z, 45 - 20 + 2, 1.9);
}

void expect_witnesses(const MachineDescription& machine) {
  const Model model = make_collision_model(machine);
  Walk walk(11);
  Scene from = model->at_rest(), to = model->at_rest();
  Pose pose = walk.next(20, 0.2);
  ASSERT_TRUE(model->place(Frame::kPart, pose, from));
  for (int n = 0; n < 300; ++n) {
    pose = walk.next(20, 0.2);
    if (!model->place(Frame::kPart, pose, to)) continue;
    const double turn = std::abs(to.tilt_rad - from.tilt_rad);
    const auto motion = [&](std::size_t i) {
      double most = 0;
      for (std::size_t k = 0; k < 2; ++k) most = std::max(most, norm(to.witness[i][k] - from.witness[i][k]));
      return most + turn * model->bodies()[i].lever_mm;
    };
    for (const CollisionModel::Pair& pair : model->pairs()) {
      const double before = model->distance(from, pair), after = model->distance(to, pair);
      // Where bodies overlap the distance says so and no more.
      if (before <= 0 || after <= 0) continue;
      EXPECT_LE(std::abs(after - before), motion(pair.first) + motion(pair.second) + 2e-3)
          << model->name(model->bodies()[pair.first].id) << " and "
          << model->name(model->bodies()[pair.second].id);
    }
    from = to;
  }
}

/// How much of the bound is used at most, at steps that do not turn.
double expect_places(const MachineDescription& machine) {
  const Model model = make_collision_model(machine);
  Walk walk(13);
  Scene from = model->at_rest(), to = model->at_rest();
  Pose pose = walk.next(20, 0.2);
  EXPECT_TRUE(model->place(Frame::kPart, pose, from));
  auto place = model->place_of(Frame::kPart, pose);
  double nearest_to_bound = 0;
  for (int n = 0; n < 2000; ++n) {
    // Some steps turn, some do not.
    pose = walk.next(20, n % 2 * 0.2);
    pose[kC] += 0.01;
    if (!model->place(Frame::kPart, pose, to)) continue;
    const auto next = model->place_of(Frame::kPart, pose);
    if (!place || !next) {
      ADD_FAILURE() << "no place at pose " << n;
      return 0;
    }
    const double apart = CollisionModel::apart_mm(*place, *next);
    const double most = model->gain(*place, apart) * apart;
    const double turn = std::abs(to.tilt_rad - from.tilt_rad);
    for (const CollisionModel::Pair& pair : model->pairs()) {
      const CollisionModel::Body &a = model->bodies()[pair.first], &b = model->bodies()[pair.second];
      for (std::size_t k = 0; k < 4; ++k) {
        Vec moved{};
        if (a.moves()) moved = to.witness[pair.first][k / 2] - from.witness[pair.first][k / 2];
        if (b.moves()) moved = moved - (to.witness[pair.second][k % 2] - from.witness[pair.second][k % 2]);
        const double sum = norm(moved) + turn * ((a.moves() ? a.lever_mm : 0) + (b.moves() ? b.lever_mm : 0));
        EXPECT_LE(sum, most + 1e-9) << model->name(a.id) << ", " << model->name(b.id) << ", pose " << n;
        if (turn == 0) nearest_to_bound = std::max(nearest_to_bound, sum / most);
      }
    }
    from = to;
    place = next;
  }
  return nearest_to_bound;
}

TEST(Sweep, NoPairMovesFartherThanThePlacesOfTwoPosesSay) {
  MachineDescription d = legs_below();
  d.bodies->part_radius_mm = 80;
  d.bodies->part_height_mm = 120;
  for (const double lean : {0.0, 0.05}) {
    // Rails that are not parallel, too.
    std::get<M1Geometry>(d.kinematics).legs[0].rail = {lean, 0, 1};
    EXPECT_GT(expect_places(d), lean == 0 ? 0.85 : 0.4) << "a bound that is never met costs time";
  }
}

TEST(Sweep, NoPairComesFartherThanItsWitnessesSay) {
  expect_witnesses(legs_below());
}

TEST(Sweep, NorWhereThePlatformCarriesTheTool) {
  auto mill = load_machine(machines_folder() / "m5.toml");
  ASSERT_TRUE(mill) << to_string(mill.error());
  mill->bodies.emplace();
  expect_witnesses(*mill);
  EXPECT_GT(expect_places(*mill), 0.7);
}

MachineDescription machine_file(const std::string& name) {
  auto machine = load_machine(machines_folder() / (name + ".toml"));
  EXPECT_TRUE(machine) << name << ": " << to_string(machine.error());
  return *machine;
}

TEST(Sweep, PlacesOfADeltaAndOfCartesianMachinesBoundTheirPairsToo) {
  EXPECT_GT(expect_places(machine_file("delta")), 0.7);
  EXPECT_GT(expect_places(machine_file("corexy")), 0.9);
  MachineDescription turning = machine_file("cartesian");
  auto& geometry = std::get<CartesianGeometry>(turning.kinematics);
  geometry.has_table = true;
  for (const double z : {0.0, -30.0, 50.0}) {
    geometry.table.pivot_mm = {0, 0, z};
    EXPECT_GT(expect_places(turning), 0.9) << "pivot at Z " << z;
  }
}

TEST(Sweep, OnDeltaAndCoreXySaysWhatMeasuringAllPairsSaysLineAfterLine) {
  for (const char* name : {"delta", "corexy"}) {
    SCOPED_TRACE(name);
    MachineDescription d = machine_file(name);
    // The nozzle's holder comes to it in a part of each layer.
    d.bodies->fixed.push_back({"lamp", {55, -20, 10}, {70, 20, 75}});
    const Model model = make_collision_model(d);
    Sweep sweep(*model);
    int near = 0, clear = 0;
    for (int layer = 0; layer < 4; ++layer)
      for_each_of_a_layer(20 + 0.3 * layer, 0,
                          [&](const Pose& pose) { ++(near_by_both(*model, sweep, pose) ? near : clear); });
    EXPECT_GT(near, 500) << name;
    EXPECT_GT(clear, 5000) << name;
    EXPECT_LT(sweep.measured(), static_cast<std::uint64_t>(near + clear / 2)) << name;
  }
}

TEST(Sweep, ADeltasArmsKeepFromItsHolderWhereTheSweepDoesNotLook) {
  const MachineDescription d = machine_file("delta");
  const Model model = make_collision_model(d);
  Scene scene = model->at_rest();
  int pairs = 0;
  for (const CollisionModel::Pair& pair : model->pairs()) {
    if (!model->parted_at_work(pair)) continue;
    ++pairs;
    for (int turn = 0; turn < 72; ++turn)
      for (const double r : {0.0, 70.0, 140.0})
        for (const double z : {-5.0, 290.0}) {
          const double a = turn * 5 * kRadPerDeg;
          ASSERT_TRUE(model->place(Frame::kPart, {r * std::cos(a), r * std::sin(a), z, 0, 0, 0}, scene));
          EXPECT_GE(model->distance(scene, pair), model->wanted_mm()) << turn << ", radius " << r;
        }
  }
  EXPECT_EQ(pairs, 3);
}

TEST(Sweep, AStepThatMayHaveJumpedOverSomethingIsCoarse) {
  MachineDescription d = legs_below();
  // A thin post that the table's edge would pass in one long step.
  d.bodies->fixed.push_back({"post", {120, -1, 1100}, {122, 1, 1300}});
  const Model model = make_collision_model(d);
  Sweep sweep(*model);
  ASSERT_EQ(sweep.to(Frame::kPart, {0, 0, 20, 0, 0, 0}), Sweep::Step::kClear);
  // Next to a pose that was measured; what follows begins here.
  ASSERT_EQ(sweep.to(Frame::kPart, {-3, 0, 20, 0, 0, 0}), Sweep::Step::kClear);
  // The platform goes 60 mm towards +X: who measured at the end alone would find the table beyond the post.
  EXPECT_EQ(sweep.to(Frame::kPart, {-60, 0, 20, 0, 0, 0}), Sweep::Step::kCoarse);
  auto step = Sweep::Step::kClear;
  double x = 0;
  for (; x >= -60 && step == Sweep::Step::kClear; x -= 1) step = sweep.to(Frame::kPart, {x, 0, 20, 0, 0, 0});
  EXPECT_EQ(step, Sweep::Step::kNear);
  EXPECT_EQ(model->name(sweep.nearest().second), "post");
  // Disc and post are 120 - 100 mm apart at first, and keep 2 mm.
  EXPECT_NEAR(x, -20, 1.01);
  // Over it, from one side to the other, tilted out of its way at both ends.
  sweep.jump();
  ASSERT_EQ(sweep.to(Frame::kPart, {-15, 0, 20, 0, 0, 0}), Sweep::Step::kClear);
  EXPECT_EQ(sweep.to(Frame::kPart, {-15, 60, 20, 0, 0, 0}), Sweep::Step::kCoarse);
  EXPECT_EQ(sweep.to(Frame::kPart, {-15, 1, 20, 0, 0, 0}), Sweep::Step::kClear);
}

}  // namespace
}  // namespace kinebus::bodies
