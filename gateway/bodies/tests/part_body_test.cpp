// What is printed against the machine's other bodies, compared with every printed point measured for itself.

#include "gateway/bodies/part_body.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "gateway/bodies/sweep.hpp"
#include "gateway/bodies/tests/legs_below.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/machines_folder.hpp"
#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

MachineDescription shipped(const char* file) {
  return std::move(*load_machine(machines_folder() / file));
}

/// A tower of single points, each also given to `part`.
std::vector<Vec> print_tower(PrintedPart& part, const Vec& foot, double half_mm, double height_mm) {
  std::vector<Vec> points;
  for (double z = 0.2; z < height_mm; z += 1.6)
    for (double x = -half_mm; x <= half_mm; x += 1.5)
      for (double y = -half_mm; y <= half_mm; y += half_mm > 0 ? 2 * half_mm : 1)
        points.push_back(foot + Vec{x, y, z});
  for (const Vec& p : points) part.add(p);
  return points;
}

/// Smallest distance of a point to a body other than table, tool and holder; `enough_mm` where it is more.
/// The tool does not tilt: a point is where it is beside the tip.
double nearest_body(const CollisionModel& model, const Scene& scene, const Vec& tip, const Pose& pose,
                    const std::vector<Vec>& points, std::uint8_t table_group, double enough_mm) {
  double least = enough_mm;
  for (const Vec& p : points) {
    const Vector3 t =
        turn_x(Turn(pose[kA]), turn_z(Turn(pose[kC]), {p.x - pose[kX], p.y - pose[kY], p.z - pose[kZ]}));
    const Vec at = tip + Vec{t[0], t[1], t[2]};
    for (const auto& body : model.bodies()) {
      if (body.group == table_group || body.id.kind == BodyKind::kTool || body.id.kind == BodyKind::kHolder)
        continue;
      for (std::size_t s = body.first_shape; s < std::size_t{body.first_shape} + body.shapes; ++s) {
        if (least_distance_mm(scene.shapes[s], Shape::capsule(at, at, 0)) >= least) continue;
        least = std::min(least, part(scene.shapes[s], Shape::capsule(at, at, 0)).mm);
      }
    }
  }
  return least;
}

struct Seen {
  int near = 0, clear = 0;
};

/// `tip`: of the tool at rest; nullopt: it moves with the pose.
Seen expect_what_points_say(const MachineDescription& machine, std::optional<Vec> tip, const Vec& foot,
                            double half_mm, double height_mm, const Vec& reach, double tilt_rad) {
  const Model model = make_collision_model(machine);
  std::uint8_t table_group = 0;
  for (const auto& body : model->bodies())
    if (body.id.kind == BodyKind::kTable) table_group = body.group;
  // A cell's middle is up to 0.87 mm from what was printed in it.
  const double near_mm = std::max(0.5, model->wanted_mm() - 0.87), always = near_mm - 0.88,
               never = near_mm + 0.88;
  Seen seen;
  for (std::uint32_t seed = 1; seed <= 2; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> push(-1, 1);
    PrintedPart part;
    Sweep sweep(*model, Occasion::kMotion, &part), bare(*model);
    EXPECT_NE(sweep.to(Frame::kPart, {0, 0, 100, 0, 0, 0}), Sweep::Step::kOutOfReach);
    const std::vector<Vec> points = print_tower(part, foot, half_mm, height_mm);
    sweep.jump();
    Pose pose{0, 0, 60, 0, 0, 0}, speed{};
    Scene scene = model->at_rest();
    for (int n = 0; n < 800; ++n) {
      const double limits[] = {reach.x, reach.y, 60};
      for (std::size_t k = 0; k < 3; ++k) {
        speed[k] = 0.98 * speed[k] + 0.2 * push(random);
        pose[k] += std::clamp(speed[k], -0.57, 0.57);
        pose[k] = std::clamp(pose[k], k == kZ ? 0.5 : -limits[k], limits[k]);
      }
      pose[kA] = std::clamp(pose[kA] + 0.01 * push(random), -tilt_rad, tilt_rad);
      if (tilt_rad > 0) pose[kC] += 0.01 * push(random);
      const auto own = bare.to(Frame::kPart, pose);
      const auto step = sweep.to(Frame::kPart, pose);
      if (!model->place(Frame::kPart, pose, scene)) {
        EXPECT_EQ(step, Sweep::Step::kOutOfReach);
        continue;
      }
      if (step == Sweep::Step::kCoarse || own == Sweep::Step::kCoarse) {
        sweep.jump();
        bare.jump();
        continue;
      }
      const Vec at = tip.value_or(Vec{pose[kX], pose[kY], pose[kZ]});
      const double mm = nearest_body(*model, scene, at, pose, points, table_group, never);
      const bool met = step == Sweep::Step::kNear && sweep.met_print();
      if (mm < always) {
        EXPECT_EQ(step, Sweep::Step::kNear) << "seed " << seed << ", pose " << n << ": " << mm;
        ++seen.near;
      } else if (mm >= never) {
        EXPECT_FALSE(met) << "seed " << seed << ", pose " << n << ": " << mm << " "
                          << model->words(sweep.nearest());
        EXPECT_TRUE(own != Sweep::Step::kClear || step == Sweep::Step::kClear) << mm;
        ++seen.clear;
      }
    }
  }
  return seen;
}

TEST(PartBody, OnATableThatTiltsAndTurnsASweepSaysWhatThePointsThemselvesSay) {
  MachineDescription d = legs_below();
  for (const double clearance : {2.0, 0.5}) {
    d.bodies->clearance_mm = clearance;
    d.bodies->fixed = {{"lamp", {40, 40, 1330}, {120, 120, 1350}},
                       {"arm", {-200, -20, 1310}, {-60, 0, 1320}}};
    const Seen seen = expect_what_points_say(d, Vec{0, 0, 1300}, {30, 40, 0}, 6, 70, {90, 90, 0}, 0.6);
    EXPECT_TRUE(seen.near > 20 || clearance < 1) << "where solids overlap, nobody says how far";
    EXPECT_GT(seen.clear, 500);
  }
}

TEST(PartBody, AndUnderADeltasEffectorAndArms) {
  const Seen seen =
      expect_what_points_say(shipped("delta.toml"), std::nullopt, {20, 30, 0}, 5, 70, {80, 80, 0}, 0);
  EXPECT_GT(seen.near, 20);
  EXPECT_GT(seen.clear, 500);
}

TEST(PartBody, NearATowerThatGrowsWhatCannotMeetItIsNotMeasuredAgain) {
  const Model model = make_collision_model(legs_below());
  PrintedPart part;
  PartBody body(*model, part);
  EXPECT_EQ(body.grow(), 0) << "nothing is printed";
  part.add({10, 0, 0.3});
  EXPECT_GT(body.grow(), 1000) << "nothing was known";
  EXPECT_EQ(body.grow(), 0);
  part.add({10.9, 0.4, 0.6});
  EXPECT_EQ(body.grow(), 0) << "within what it is taken to be";
  for (double x = 10; x <= 40; x += 0.5) part.add({x, 0, 0.3});
  EXPECT_NEAR(body.grow(), 32, 1e-9) << "from 12 mm to 44 mm off the axis";
  part.clear();
  EXPECT_EQ(body.grow(), 0);
  part.add({-5, 0, 0.3});
  EXPECT_GT(body.grow(), 1000);
}

TEST(PartBody, OnABedThatStandsNothingCanMeetItButToolAndHolder) {
  const Model model = make_collision_model(shipped("corexy.toml"));
  PrintedPart part;
  const PartBody body(*model, part);
  for (std::size_t i = 0; i < model->bodies().size(); ++i) EXPECT_FALSE(body.meets(i));
}

TEST(Shapes, ThePointsDistanceIsThatOfASolidWithoutSize) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-50, 50);
  const Shape solids[] = {
      Shape::capsule({-10, 4, 3}, {20, 8, -5}, 6), Shape::capsule({1, 2, 3}, {1, 2, 3}, 4),
      Shape::box({3, 4, 5}, {0, 12, 0}, {-5, 0, 0}, {0, 0, 20}), Shape::cylinder({0, 0, -8}, {6, 3, 12}, 15)};
  for (const Shape& s : solids)
    for (int n = 0; n < 2000; ++n) {
      const Vec p{u(random), u(random), u(random)};
      const double mm = distance_mm(s, p), other = distance_mm(s, Shape::capsule(p, p, 0));
      if (mm > 0.01)
        EXPECT_NEAR(mm, other, 2e-3);
      else
        EXPECT_LE(other, 0.011);
    }
}

}  // namespace
}  // namespace kinebus::bodies
