#include "gateway/bodies/sweep.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"

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
  auto mill = load_machine(std::filesystem::path(KINEBUS_MACHINES) / "m5.toml");
  ASSERT_TRUE(mill) << to_string(mill.error());
  mill->bodies.emplace();
  expect_witnesses(*mill);
  EXPECT_GT(expect_places(*mill), 0.7);
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
