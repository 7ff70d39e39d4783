#include "gateway/bodies/sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

namespace kinebus::bodies {
namespace {

// A pair this much farther apart than it must be is not measured exactly: spheres around both say so.
constexpr double kFar_mm = 30;
// Motions and spares are kept as float: what rounding may take from them, with room.
constexpr float kRounding_mm = 1e-3F;

// A pair that has less to spare than this is measured when others are: the room around a pose is that of the
// pair that has least. By the time that plan takes with bodies.
constexpr float kRefresh_mm = 8;
// As far from a place pairs are left alone that cannot meet there: most of them, around what is printed.
constexpr double kAround_mm = 100;
// What an old plane may say less than the distance was before that is measured again.
constexpr double kWorse_mm = 1;

}  // namespace

Sweep::Sweep(const CollisionModel& model, Occasion occasion, const PrintedPart* printed)
    : model_(model),
      occasion_(occasion),
      scenes_{model.at_rest(), model.at_rest()},
      has_places_(model.place_of(Frame::kMachine, {}).has_value()),
      enough_mm_(static_cast<float>(model.wanted_mm()) + (has_places_ ? kRefresh_mm : 0)) {
  for (const CollisionModel::Pair& pair : model.pairs())
    if ((occasion_ == Occasion::kHoming || !(pair.homing_only || model.parted_at_work(pair))) &&
        !model.always_parted(pair))
      pairs_.push_back(pair);
  own_pairs_ = pairs_.size();
  if (printed != nullptr) {
    print_.emplace(model, *printed);
    for (std::size_t i = 0; i < model.bodies().size(); ++i)
      if (print_->meets(i))
        pairs_.push_back({static_cast<std::uint8_t>(print_->table()), static_cast<std::uint8_t>(i)});
  }
  spare_.resize(pairs_.size());
  next_.resize(pairs_.size());
  parting_.resize(pairs_.size());
  active_.reserve(pairs_.size());
  unsettle();
}

void Sweep::jump() {
  unsettle();
  placed_ = false;
  room_ = {};
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
float Sweep::motion_over(std::size_t i, float matters_mm) const {
  const CollisionModel::Pair& pair = pairs_[i];
  const auto &a = model_.bodies()[pair.first], &b = model_.bodies()[pair.second];
  // Of what is printed the table's motion is measured, which has a shorter lever.
  const auto higher = static_cast<float>(with_print(i) && a.moves() ? print_->lever_mm() - a.lever_mm : 0);
  const float sum = motion_[pair.first] + motion_[pair.second] + turned_rad_ * std::max(0.0F, higher);
  if (sum <= matters_mm || !a.moves() || !b.moves()) return sum;
  double most = 0;
  for (const Vec& p : displaced_[pair.first])
    for (const Vec& q : displaced_[pair.second]) most = std::max(most, dot(p - q, p - q));
  return static_cast<float>(std::sqrt(most)) +
         turned_rad_ * (static_cast<float>(a.lever_mm + b.lever_mm) + std::max(0.0F, higher)) + kRounding_mm;
}

/// How much more than the place says a turn moves what is printed: it may be higher than the lever that turns
/// are counted with.
double Sweep::turns_of(std::size_t i) const {
  if (!with_print(i) || !(at_.lever_mm > 0)) return 1;
  return std::max(1.0, print_->lever_mm() / at_.lever_mm);
}

/// Around the pose just measured pairs are left alone that have enough to spare for all ways there.
void Sweep::settle(const Place& place) {
  const double gain = model_.gain(place, kAround_mm);
  if (!std::isfinite(gain)) return;
  around_ = {place, gain};
  active_.clear();
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const auto enough =
        static_cast<float>(model_.wanted_mm() + gain * turns_of(i) * kAround_mm) + 2 * kRounding_mm;
    // Spheres around both, or an old plane, may have said less than is true.
    if (!(spare_[i] >= enough) && !with_print(i)) {
      const Scene& scene = scenes_[now_];
      double mm = parting_[i].mm > 0 ? model_.gap_along(scene, pairs_[i], parting_[i].axis) : 0;
      if (mm < enough + kRounding_mm && parting_[i].mm >= 0) {
        parting_[i] = model_.part(scene, pairs_[i]);
        mm = parting_[i].mm;
      }
      spare_[i] = std::max(spare_[i], static_cast<float>(mm) - kRounding_mm);
    }
    if (!(spare_[i] >= enough)) active_.push_back(i);
  }
  next_ = spare_;
}

/// All pairs count, with what they have to spare at the last pose measured.
void Sweep::unsettle() {
  if (around_) {
    const double moved = around_->gain * CollisionModel::apart_mm(at_, around_->middle);
    auto next = active_.begin();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (next != active_.end() && *next == i)
        ++next;
      else
        spare_[i] -= static_cast<float>(moved * turns_of(i)) + kRounding_mm;
    }
  }
  around_.reset();
  active_.resize(pairs_.size());
  std::iota(active_.begin(), active_.end(), std::size_t{0});
}

/// What is printed has grown since the last pose. Its new cells were laid at the tool's tip, from which the
/// bodies keep away as from any other: that they are clear of those is not in doubt, how far they are is.
void Sweep::follow_print() {
  const double grown = print_->grow();
  if (grown == 0) return;
  unsettle();
  for (std::size_t i = own_pairs_; i < pairs_.size(); ++i) spare_[i] -= static_cast<float>(grown);
  room_.mm = 0;
  known_.forget();
}

Sweep::Step Sweep::to(Frame frame, const Pose& pose) {
  if (print_) follow_print();
  const std::optional<Place> place = model_.place_of(frame, pose);
  bool way_is_clear = false;
  if (room_.mm > 0 || unmeasured_) {
    const double off = CollisionModel::apart_mm(*place, room_.middle);
    if (off < room_.mm) {
      unmeasured_ = {frame, pose, *place};
      return Step::kClear;
    }
    // The way on begins at the last pose, not at the last that was measured. If it is so short that bodies
    // that keep their distance at both ends cannot touch on it, no more need be known of where it begins.
    const double apart = CollisionModel::apart_mm(unmeasured_ ? unmeasured_->place : room_.middle, *place);
    const double coarse = print_ ? std::max(0.0, print_->coarse_mm()) : 0;
    way_is_clear =
        apart * model_.gain(room_.middle, off + apart) < 2 * (model_.wanted_mm() - coarse - kRounding_mm);
    if (const auto known = known_.around(*place); known && way_is_clear) {
      room_ = *known;
      unmeasured_ = {frame, pose, *place};
      return Step::kClear;
    }
  }
  const auto away = [this](const Place& p) {
    return CollisionModel::apart_mm(p, around_->middle) >= kAround_mm;
  };
  if (around_ && (away(*place) || (unmeasured_ && away(unmeasured_->place)))) unsettle();
  if (unmeasured_ && !way_is_clear) carry_on();
  return measure(frame, pose, place, way_is_clear);
}

/// From the last pose measured to the last pose, where the next way begins.
void Sweep::carry_on() {
  const bool in_reach = model_.place(unmeasured_->frame, unmeasured_->pose, scenes_[1 - now_]);
  assert(in_reach);
  measure_motion();
  const auto wanted = static_cast<float>(model_.wanted_mm());
  for (const std::size_t i : active_)
    // Within the room nothing is nearer than wanted.
    spare_[i] = std::max(wanted, spare_[i] - motion_over(i, spare_[i] - enough_mm_));
  now_ = 1 - now_;
  at_ = unmeasured_->place;
  room_ = {};
  unmeasured_.reset();
}

/// After a pose at which every pair was clear.
void Sweep::find_room(const Place& place) {
  double radius = std::numeric_limits<double>::infinity();
  for (const std::size_t i : active_)
    radius = std::min(radius, (spare_[i] - model_.wanted_mm() - kRounding_mm) / turns_of(i));
  room_ = {place, radius > 0 ? radius / model_.gain(place, radius) : 0};
  if (around_) room_.mm = std::min(room_.mm, kAround_mm - CollisionModel::apart_mm(place, around_->middle));
  if (room_.mm > 0) known_.keep(room_);
}

/// Distance of a pair, or somewhat less.
double Sweep::look(const Scene& scene, const Pose& pose, std::size_t i) {
  const CollisionModel::Pair& pair = pairs_[i];
  if (with_print(i)) return print_->distance(scene, pose, pair.second, parting_[i]);
  Parting& last = parting_[i];
  // The plane that parted both when they were measured parts them still, as a rule.
  if (last.mm > model_.wanted_mm()) {
    const double gap = model_.gap_along(scene, pair, last.axis);
    if (gap >= std::min(last.mm - kWorse_mm, model_.wanted_mm() + kFar_mm) &&
        gap >= model_.wanted_mm() + kWorse_mm)
      return gap;
  }
  const double far = model_.least_distance(scene, pair);
  if (far >= model_.wanted_mm() + kFar_mm) return far;
  last = model_.part(scene, pair);
  return last.mm;
}

/// `way_is_clear`: no pair that keeps its distance here has touched since the last pose.
Sweep::Step Sweep::measure(Frame frame, const Pose& pose, const std::optional<Place>& place,
                           bool way_is_clear) {
  const Scene& scene = scenes_[1 - now_];
  if (!model_.place(frame, pose, scenes_[1 - now_])) {
    jump();
    return Step::kOutOfReach;
  }
  ++measured_;
  if (placed_) measure_motion();
  const auto wanted = static_cast<float>(model_.wanted_mm());
  const auto coarse = static_cast<float>(print_ ? print_->coarse_mm() : 0);
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : active_) {
    float motion = 0;
    if (placed_) {
      motion = motion_over(i, spare_[i] - enough_mm_);
      next_[i] = spare_[i] - motion;
      if (next_[i] >= enough_mm_) continue;
    }
    const double mm = look(scene, pose, i);
    next_[i] = static_cast<float>(mm) - kRounding_mm;
    if (mm < model_.wanted_mm()) {
      if (mm < least) {
        least = mm;
        met_print_ = with_print(i);
        const BodyId second = model_.bodies()[pairs_[i].second].id;
        nearest_ = met_print_ ? Clearance{mm, second, {BodyKind::kPart}}
                              : Clearance{mm, model_.bodies()[pairs_[i].first].id, second};
      }
    } else if (placed_ && !way_is_clear && spare_[i] >= wanted - 2 * kRounding_mm &&
               spare_[i] + next_[i] <= motion + (with_print(i) ? 2 * coarse : 0)) {
      // Clear there and clear here, and moved so far between that both could have met.
      return Step::kCoarse;
    }
  }
  now_ = 1 - now_;
  std::swap(spare_, next_);
  placed_ = true;
  room_ = {};
  unmeasured_.reset();
  if (has_places_) {
    at_ = *place;
    if (!around_) settle(at_);
  }
  if (std::isfinite(least)) return Step::kNear;
  if (has_places_) find_room(at_);
  return Step::kClear;
}

}  // namespace kinebus::bodies
