#include "gateway/motion/path_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>

namespace kinebus {
namespace {

using Vector3 = std::array<double, 3>;

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vector3 minus(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double length(const Vector3& v) {
  return std::sqrt(dot(v, v));
}

// Moves beyond the best so far that are looked at before the search ends. A millisecond at 300 mm/s passes
// two lines of 0.2 mm; where the path comes back on itself, the nearest place must stay the one that the
// queries are at.
constexpr std::size_t kLookOn = 4;
constexpr std::size_t kLookBack = 2;
// Passes of a cycle share corners and lines. Who has gone one millimetre is not a pass further on: what is
// farther along the path than this allows is where it is only when nothing before it is near.
constexpr double kLongerThanTravelled = 4, kLonger_mm = 0.5;  // where corners are cut
constexpr double kNear_mm2 = 0.02 * 0.02, kSame_mm2 = 1e-9;

}  // namespace

void PathDistance::add(const canonical::Line& line) {
  const auto xyz = [](const Pose& p) { return Vector3{p[0], p[1], p[2]}; };
  const Pose* target = nullptr;
  Move move;
  if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) target = &feed->target;
  if (const auto* traverse = std::get_if<canonical::Traverse>(&line.command)) target = &traverse->target;
  if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) {
    target = &arc->target;
    move.arc = true;
    move.centre = arc->centre_mm;
    move.normal = arc->normal;
    move.sweep_rad = arc->sweep_rad;
  }
  if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) end_ = set->pose;
  if (target == nullptr) return;
  move.from = xyz(end_);
  move.to = xyz(*target);
  move.line = line.line;
  end_ = *target;
  // Moves of E and of rotations alone are no places of their own; a row of them would end the search.
  if (!move.arc && move.from == move.to && !moves_.empty() && moves_.back().to == move.to) return;
  const Vector3 along = minus(move.to, move.from);
  move.length_mm = length(along);
  if (move.arc) {
    const double climb = dot(along, move.normal), radius = length(minus(move.from, move.centre));
    move.length_mm = std::hypot(radius * move.sweep_rad, climb);
  }
  moves_.push_back(move);
}

PathDistance::Place PathDistance::nearest_on_line(const Move& move, const Vector3& point) {
  const Vector3 along = minus(move.to, move.from), off = minus(point, move.from);
  const double length2 = dot(along, along);
  const double t = length2 > 0 ? std::clamp(dot(off, along) / length2, 0.0, 1.0) : 0;
  const Vector3 rest{off[0] - t * along[0], off[1] - t * along[1], off[2] - t * along[2]};
  return {dot(rest, rest), t};
}

PathDistance::Place PathDistance::nearest_on(const Move& move, const Vector3& point) {
  if (!move.arc) return nearest_on_line(move, point);
  // Height along the axis follows the angle; the nearest point is the one at the query's own angle, except
  // past the ends. Exact for circles; for helices of usual pitch the error is of second order in the
  // distance.
  const Vector3 start = minus(move.from, move.centre), finish = minus(move.to, move.centre);
  const Vector3 off = minus(point, move.centre);
  const double height0 = dot(start, move.normal), height1 = dot(finish, move.normal);
  const double height = dot(off, move.normal);
  Vector3 r0, r;
  for (std::size_t i = 0; i < 3; ++i) {
    r0[i] = start[i] - height0 * move.normal[i];
    r[i] = off[i] - height * move.normal[i];
  }
  const double radius0 = std::sqrt(dot(r0, r0)), radius = std::sqrt(dot(r, r));
  Vector3 r1;
  for (std::size_t i = 0; i < 3; ++i) r1[i] = finish[i] - height1 * move.normal[i];
  const double radius1 = std::sqrt(dot(r1, r1));
  constexpr double kTurn = 2 * std::numbers::pi;
  double angle = std::atan2(dot(cross(r0, r), move.normal), dot(r0, r));
  if (angle < 0) angle += kTurn;
  const double at_start = dot(minus(point, move.from), minus(point, move.from));
  const double at_end = dot(minus(point, move.to), minus(point, move.to));
  Place best = at_start < at_end ? Place{at_start, 0} : Place{at_end, 1};
  for (int turn = 0; angle + turn * kTurn <= move.sweep_rad; ++turn) {
    const double part = (angle + turn * kTurn) / move.sweep_rad;
    const double dr = radius - (radius0 + part * (radius1 - radius0));
    const double dh = height - (height0 + part * (height1 - height0));
    if (dr * dr + dh * dh < best.distance2) best = {dr * dr + dh * dh, part};
  }
  return best;
}

PathDistance::Found PathDistance::search(const Vector3& point, std::uint32_t line, double reach_mm) const {
  Found best{{std::numeric_limits<double>::infinity(), 0}, nearest_};
  std::size_t end = std::min(moves_.size(), nearest_ + kLookOn + 1);
  // Along the path, from the last place to the beginning of the move.
  double way_mm = -part_ * moves_[nearest_].length_mm;
  for (std::size_t i = nearest_ > kLookBack ? nearest_ - kLookBack : 0; i < end; ++i) {
    if (i > nearest_ && (moves_[i].line > line || way_mm > reach_mm)) break;
    if (i >= nearest_) way_mm += moves_[i].length_mm;
    const Place place = nearest_on(moves_[i], point);
    // The next move at the same distance (a shared corner, the way back) is where the path goes on.
    const double same = i == best.move + 1 ? kSame_mm2 : 0;
    if (place.distance2 <= best.place.distance2 + same) {
      if (i > best.move) end = std::min(moves_.size(), i + kLookOn + 1);
      best = {place, i};
    }
  }
  return best;
}

double PathDistance::distance_mm(const Pose& pose, std::uint32_t line) {
  if (moves_.empty()) return 0;
  const Vector3 point{pose[0], pose[1], pose[2]};
  while (nearest_ > kLookBack) {
    moves_.pop_front();
    --nearest_;
  }
  const double reach_mm = kLonger_mm + (last_ ? kLongerThanTravelled * length(minus(point, *last_)) : 0);
  last_ = point;
  Found best = search(point, line, reach_mm);
  double distance2 = best.place.distance2;
  if (distance2 > kSame_mm2) {
    const Found farther = search(point, line, std::numeric_limits<double>::infinity());
    if (distance2 > kNear_mm2) best = farther;
    distance2 = std::min(distance2, farther.place.distance2);
  }
  nearest_ = best.move;
  part_ = best.place.part;
  nearest_line_ = moves_[nearest_].line;
  return std::sqrt(distance2);
}

}  // namespace kinebus
