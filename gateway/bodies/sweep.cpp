#include "gateway/bodies/sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kinebus::bodies {
namespace {

// A pair this much farther apart than it must be is not measured exactly: spheres around both say so.
constexpr double kFar_mm = 30;
// Motions and spares are kept as float: what rounding may take from them, with room.
constexpr float kRounding_mm = 1e-3F;

// A pair that has less to spare than this is measured when others are: the room around a pose is that of the
// pair that has least. By the time that plan takes with bodies.
constexpr float kRefresh_mm = 18;
// What an old plane may say less than the distance was before that is measured again.
constexpr double kWorse_mm = 1;

}  // namespace

Sweep::Sweep(const CollisionModel& model, Occasion occasion)
    : model_(model),
      occasion_(occasion),
      scenes_{model.at_rest(), model.at_rest()},
      has_places_(model.place_of(Frame::kMachine, {}).has_value()),
      enough_mm_(static_cast<float>(model.wanted_mm()) + (has_places_ ? kRefresh_mm : 0)) {
  for (const CollisionModel::Pair& pair : model.pairs())
    if (occasion_ == Occasion::kHoming || !pair.homing_only) pairs_.push_back(pair);
  spare_.resize(pairs_.size());
  next_.resize(pairs_.size());
  parting_.resize(pairs_.size());
}

void Sweep::jump() {
  placed_ = false;
  room_mm_ = 0;
  unmeasured_.reset();
}

void Sweep::measure_motion() {
  const Scene &from = scenes_[now_], &to = scenes_[1 - now_];
  const double turn = std::abs(to.tilt_rad - from.tilt_rad);
  turned_rad_ = static_cast<float>(turn);
  const auto& all = model_.bodies();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].moves()) continue;
    const auto &a = from.witness[i], &b = to.witness[i];
    const Vec p = b[0] - a[0], q = b[1] - a[1];
    displaced_[i] = {p, q};
    motion_[i] =
        static_cast<float>(std::sqrt(std::max(dot(p, p), dot(q, q))) + turn * all[i].lever_mm) + kRounding_mm;
  }
}

/// How far the two may have come together. Exact enough to tell whether that is more than `matters_mm`: what
/// moves both alike does not bring them together.
float Sweep::motion_over(const CollisionModel::Pair& pair, float matters_mm) const {
  const auto &a = model_.bodies()[pair.first], &b = model_.bodies()[pair.second];
  const float sum = motion_[pair.first] + motion_[pair.second];
  if (sum <= matters_mm || !a.moves() || !b.moves()) return sum;
  double most = 0;
  for (const Vec& p : displaced_[pair.first])
    for (const Vec& q : displaced_[pair.second]) most = std::max(most, dot(p - q, p - q));
  return static_cast<float>(std::sqrt(most)) + turned_rad_ * static_cast<float>(a.lever_mm + b.lever_mm) +
         kRounding_mm;
}

Sweep::Step Sweep::to(Frame frame, const Pose& pose) {
  if (room_mm_ > 0 && CollisionModel::apart_mm(*model_.place_of(frame, pose), middle_) < room_mm_) {
    unmeasured_ = {frame, pose};
    return Step::kClear;
  }
  bool way_is_clear = false;
  if (unmeasured_) {
    // The way on begins at the last pose, not at the last that was measured. If it is so short that bodies
    // that keep their distance at both ends cannot touch on it, no more need be known of where it begins.
    const CollisionModel::Place from = *model_.place_of(unmeasured_->frame, unmeasured_->pose),
                                to = *model_.place_of(frame, pose);
    const double apart = CollisionModel::apart_mm(from, to);
    way_is_clear = apart * model_.gain(middle_, CollisionModel::apart_mm(to, middle_)) <
                   2 * (model_.wanted_mm() - kRounding_mm);
    if (!way_is_clear) carry_on();
  }
  return measure(frame, pose, way_is_clear);
}

/// From the last pose measured to the last pose, where the next way begins.
void Sweep::carry_on() {
  const bool in_reach = model_.place(unmeasured_->frame, unmeasured_->pose, scenes_[1 - now_]);
  assert(in_reach);
  measure_motion();
  const auto wanted = static_cast<float>(model_.wanted_mm());
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    // Within the room nothing is nearer than wanted.
    spare_[i] = std::max(wanted, spare_[i] - motion_over(pairs_[i], spare_[i] - enough_mm_));
  now_ = 1 - now_;
  room_mm_ = 0;
  unmeasured_.reset();
}

/// After a pose at which every pair was clear.
void Sweep::find_room(Frame frame, const Pose& pose) {
  float least = std::numeric_limits<float>::infinity();
  for (const float spare : spare_) least = std::min(least, spare);
  const double radius = least - model_.wanted_mm() - kRounding_mm;
  middle_ = *model_.place_of(frame, pose);
  room_mm_ = radius > 0 ? radius / model_.gain(middle_, radius) : 0;
}

/// Distance of a pair, or somewhat less.
double Sweep::look(const Scene& scene, std::size_t i) {
  const CollisionModel::Pair& pair = pairs_[i];
  const double far = model_.least_distance(scene, pair);
  if (far >= model_.wanted_mm() + kFar_mm) return far;
  Parting& last = parting_[i];
  // The plane that parted both when they were measured parts them still, as a rule.
  if (last.mm > model_.wanted_mm()) {
    const double gap = model_.gap_along(scene, pair, last.axis);
    if (gap >= std::min(last.mm - kWorse_mm, model_.wanted_mm() + kFar_mm) &&
        gap >= model_.wanted_mm() + kWorse_mm)
      return gap;
  }
  last = model_.part(scene, pair);
  return last.mm;
}

/// `way_is_clear`: no pair that keeps its distance here has touched since the last pose.
Sweep::Step Sweep::measure(Frame frame, const Pose& pose, bool way_is_clear) {
  const Scene& scene = scenes_[1 - now_];
  if (!model_.place(frame, pose, scenes_[1 - now_])) {
    jump();
    return Step::kOutOfReach;
  }
  if (placed_) measure_motion();
  const auto wanted = static_cast<float>(model_.wanted_mm());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    float motion = 0;
    if (placed_) {
      motion = motion_over(pairs_[i], spare_[i] - enough_mm_);
      next_[i] = spare_[i] - motion;
      if (next_[i] >= enough_mm_) continue;
    }
    const double mm = look(scene, i);
    next_[i] = static_cast<float>(mm) - kRounding_mm;
    if (mm < model_.wanted_mm()) {
      if (mm < least) {
        least = mm;
        nearest_ = {mm, model_.bodies()[pairs_[i].first].id, model_.bodies()[pairs_[i].second].id};
      }
    } else if (placed_ && !way_is_clear && spare_[i] >= wanted - 2 * kRounding_mm &&
               spare_[i] + next_[i] <= motion) {
      // Clear there and clear here, and moved so far between that both could have met.
      return Step::kCoarse;
    }
  }
  now_ = 1 - now_;
  std::swap(spare_, next_);
  placed_ = true;
  room_mm_ = 0;
  unmeasured_.reset();
  if (std::isfinite(least)) return Step::kNear;
  if (has_places_) find_room(frame, pose);
  return Step::kClear;
}

}  // namespace kinebus::bodies
