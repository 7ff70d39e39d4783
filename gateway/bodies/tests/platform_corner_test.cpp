// How near the platform's corners come to the legs that they do not carry: on M1 never, whatever its
// workspace allows. What carries a leg is joined to it; there the angle of the leg to the platform is the
// rule.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/description/machine_description.hpp"

namespace kinebus::bodies {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr int kStarts = 4, kLooks = 4000, kSteps = 4000;

/// Distances of the platform's arms from the legs, of one machine, at poses that its rules allow.
class Corner {
 public:
  Corner()
      : kinematics_(*make_kinematics(m1_)), model_(make_collision_model(m1_)), scene_(model_->at_rest()) {
    const auto& limits = std::get<M1Geometry>(m1_.kinematics).limits;
    radius_mm_ = limits.radius_mm, z_mm_ = limits.z_mm, a_rad_ = limits.a_rad;
    for (const CollisionModel::Pair& pair : model_->pairs()) {
      const BodyKind first = model_->bodies()[pair.first].id.kind,
                     second = model_->bodies()[pair.second].id.kind;
      if ((first == BodyKind::kPlatform && second == BodyKind::kLeg) ||
          (first == BodyKind::kLeg && second == BodyKind::kPlatform))
        pairs_.push_back(pair);
    }
  }
  std::size_t pairs() const { return pairs_.size(); }
  /// Far away where the machine cannot stand.
  double distance_mm(const Pose& pose) {
    double least = 1e9;
    if (!kinematics_->check(Frame::kPart, pose) || !model_->place(Frame::kPart, pose, scene_)) return least;
    for (const CollisionModel::Pair& pair : pairs_) least = std::min(least, model_->distance(scene_, pair));
    return least;
  }
  /// The least, by walks downhill from the nearest of random poses.
  double nearest_mm() {
    double nearest = 1e9;
    for (int start = 0; start < kStarts; ++start) {
      Pose best{};
      double best_mm = 1e9;
      const auto look = [&](const Pose& pose) {
        if (const double mm = distance_mm(pose); mm < best_mm) best_mm = mm, best = pose;
      };
      for (int i = 0; i < kLooks; ++i) {
        Pose pose{};
        pose[kX] = random(-radius_mm_, radius_mm_), pose[kY] = random(-radius_mm_, radius_mm_);
        pose[kZ] = random(z_mm_.min, z_mm_.max), pose[kA] = random(a_rad_.min, a_rad_.max);
        look(pose);
      }
      double step = 1;
      for (int i = 0; i < kSteps; ++i, step *= 0.998) {
        Pose pose = best;
        for (const PoseAxis axis : {kX, kY, kZ}) pose[axis] += step * random(-15, 15);
        pose[kA] += step * random(-0.1, 0.1);
        look(pose);
      }
      nearest = std::min(nearest, best_mm);
    }
    return nearest;
  }

 private:
  double random(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  MachineDescription m1_ = default_m1();
  std::unique_ptr<Kinematics> kinematics_;
  std::unique_ptr<const CollisionModel> model_;
  Scene scene_;
  std::vector<CollisionModel::Pair> pairs_;
  double radius_mm_ = 0;
  Interval z_mm_{}, a_rad_{};
  std::mt19937_64 random_{kSeed};
};

TEST(PlatformCorner, OfM1KeepsFarFromEveryLegThatItDoesNotCarry) {
  SCOPED_TRACE(kSeed);
  Corner m1;
  EXPECT_EQ(m1.pairs(), 12u) << "each of four arms, and the three legs that are not its own";
  const double nearest_mm = m1.nearest_mm();
  EXPECT_NEAR(nearest_mm, 57.1, 0.3) << "at the workspace's rim and top, tilted by 45 deg";
  RecordProperty("nearest_mm", std::to_string(nearest_mm));
}

}  // namespace
}  // namespace kinebus::bodies
