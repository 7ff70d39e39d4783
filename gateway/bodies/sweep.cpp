#include "gateway/bodies/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinebus::bodies {
namespace {

// A pair this much farther apart than it must be is not measured exactly: spheres around both say so.
constexpr double kFar_mm = 30;
// Motions and spares are kept as float: what rounding may take from them, with room.
constexpr float kRounding_mm = 1e-3F;

}  // namespace

Sweep::Sweep(const CollisionModel& model, Occasion occasion)
    : model_(model), occasion_(occasion), scenes_{model.at_rest(), model.at_rest()} {
  for (const CollisionModel::Pair& pair : model.pairs())
    if (occasion_ == Occasion::kHoming || !pair.homing_only) pairs_.push_back(pair);
  spare_.resize(pairs_.size());
  next_.resize(pairs_.size());
}

void Sweep::measure_motion() {
  const Scene &from = scenes_[now_], &to = scenes_[1 - now_];
  const double turn = std::abs(to.tilt_rad - from.tilt_rad);
  const auto& all = model_.bodies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].moves()) continue;
    const auto &a = from.witness[i], &b = to.witness[i];
    const Vec p = b[0] - a[0], q = b[1] - a[1];
    motion_[i] =
        static_cast<float>(std::sqrt(std::max(dot(p, p), dot(q, q))) + turn * all[i].lever_mm) + kRounding_mm;
  }
}

Sweep::Step Sweep::to(Frame frame, const Pose& pose) {
  const Scene& scene = scenes_[1 - now_];
  if (!model_.place(frame, pose, scenes_[1 - now_])) {
    placed_ = false;
    return Step::kOutOfReach;
  }
  if (placed_) measure_motion();
  const auto wanted = static_cast<float>(model_.wanted_mm());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const float motion = placed_ ? motion_of(pairs_[i]) : 0.0F;
    if (placed_) {
      next_[i] = spare_[i] - motion;
      if (next_[i] >= wanted) continue;
    }
    double mm = model_.least_distance(scene, pairs_[i]);
    if (mm < model_.wanted_mm() + kFar_mm) mm = model_.distance(scene, pairs_[i]);
    next_[i] = static_cast<float>(mm) - kRounding_mm;
    if (mm < model_.wanted_mm()) {
      if (mm < least) {
        least = mm;
        nearest_ = {mm, model_.bodies()[pairs_[i].first].id, model_.bodies()[pairs_[i].second].id};
      }
    } else if (placed_ && spare_[i] >= wanted - 2 * kRounding_mm && spare_[i] + next_[i] <= motion) {
      // Clear there and clear here, and moved so far between that both could have met.
      return Step::kCoarse;
    }
  }
  now_ = 1 - now_;
  std::swap(spare_, next_);
  placed_ = true;
  return std::isfinite(least) ? Step::kNear : Step::kClear;
}

}  // namespace kinebus::bodies
