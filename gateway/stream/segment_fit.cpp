// How far a segment can go, and which accelerations take it there: the arithmetic of Segmenter.

#include <algorithm>
#include <cmath>

#include "gateway/stream/cubic_error.hpp"
#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/segmenter_tuning.hpp"

namespace kinebus {

using namespace segmenter;

/// Whether a segment that begins b units before the end of piece `index` had better end there: when it could
/// neither get far beyond the jump, nor is the jump small.
bool Segmenter::stops_at(std::size_t index, double b) const {
  const double jump = piece(index).jump;
  if (complete_ && index + 2 == count()) return true;
  if (jump * b * b < kStopAtJump) return false;
  const double enough = std::sqrt(kStopAtJump / jump);
  double after = 0;
  for (std::size_t i = index + 1; i < count(); ++i) {
    after += piece(i).end - piece(i).start;
    if (after > enough) return true;
    if (piece(i).jump > 0.2 * jump) return false;
  }
  return false;
}

/// First guess of how far one segment can go: by the error that bends and jumps add up to on the way.
Segmenter::Reach Segmenter::reach() const {
  const double knot = static_cast<double>(at_.knot);
  double change = 0;  // of q''/2 so far, over tolerance
  double begin = 0;   // of the piece, from the knot
  for (std::size_t i = 0;; ++i) {
    const Piece& p = piece(i);
    const double end = p.end - knot, to = std::min(end, kLongest);
    const auto error = [&](double h) { return kBendError * h * h * (change / 3 + p.bend * (h - begin)); };
    if (complete_ && i + 1 == count()) return {begin, i, false, true};
    if (error(to) > kAim) {
      double h = 0;
      if (begin <= 0) {
        h = std::cbrt(kAim / (kBendError * p.bend));
      } else {
        double low = begin, high = to;
        for (int k = 0; k < 5; ++k) (error(0.5 * (low + high)) > kAim ? high : low) = 0.5 * (low + high);
        h = low;
      }
      return {h, i, false, false};
    }
    if (end >= kLongest || i + 1 == count()) return {to, i, false, false};
    if (stops_at(i, end) && !(complete_ && i + 2 == count())) return {end, i + 1, true, false};
    change += p.jump + 3 * p.bend * (end - std::max(begin, 0.0));
    begin = end;
  }
}

/// How far a segment that begins at t, in piece `index`, will go at most.
double Segmenter::next_units(double t, std::size_t index, double most) const {
  double bend = 0;
  for (std::size_t i = index; i < count(); ++i) {
    const Piece& p = piece(i);
    const double b = p.end - t;
    bend = std::max(bend, p.bend);
    const double to = std::min(b, most);
    if (kBendError * bend * to * to * to > kAim) return std::min(to, std::cbrt(kAim / (kBendError * bend)));
    if (b >= most) return most;
    if (stops_at(i, b)) return std::max(b, 1.0);
  }
  return most;
}

Segmenter::Miss Segmenter::miss(std::size_t axis, double h, double next, std::size_t index) const {
  const Axis& a = at_.axes[axis];
  const double t = static_cast<double>(at_.knot) + h;
  const Piece& p = piece(index);
  const auto& c = p.c[axis];
  const double x = t - p.start;
  const double q = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
  const double q1 = c[1] + x * (2 * c[2] + x * 3 * c[3]);
  // The velocity error at this knot that splits the next segment's error evenly: M next^2 / 12 for a cubic.
  double wanted = 0.5 * c[3] * next * next;
  if (t + next > p.end + 1) {
    const Piece& e = piece(piece_at(t + next, index));
    const auto& d = e.c[axis];
    const double y = t + next - e.start;
    const double qn = d[0] + y * (d[1] + y * (d[2] + y * d[3]));
    const double qn1 = d[1] + y * (2 * d[2] + y * 3 * d[3]);
    wanted = 0.5 * (q1 + qn1) - (qn - q) / next;
  }
  return {q - a.p - a.v * h, q1 - a.v - wanted, c[2] + 3 * c[3] * x};
}

/// kRest: velocity 0 at the end. kHalfway: this and one more segment bring position and velocity to the run's
/// end.
double Segmenter::resting_acceleration(std::size_t axis, double h, Goal goal) const {
  const Axis& a = at_.axes[axis];
  if (goal == Goal::kRest) return -0.5 * a.v / h;
  const double whole = std::max(std::ceil(run_end_ - static_cast<double>(at_.knot) - 1e-6), h + 1);
  const double missing = piece(count() - 1).c[axis][0] - a.p - a.v * whole;
  return (missing + 0.5 * (whole - h) * a.v) / (h * whole);
}

/// How far an acceleration may leave those of the motion, which reach `most`.
double Segmenter::spare(std::size_t axis, double most) const {
  const double limit = at_.axes[axis].limit;
  if (limit <= 0) return kForever;
  if (most > kOverLimit * limit) return kOverLimitWidening * limit;
  return std::max(kRoomShare * (limit - most), kLeastWidening * limit);
}

/// Where an acceleration may lie: in what q''/2 does on the way, and a part of what is left to the limit.
Segmenter::Bounds Segmenter::bounds(std::size_t axis, double h, std::size_t last) const {
  if (at_.axes[axis].limit <= 0) return {-kForever, kForever};
  const double knot = static_cast<double>(at_.knot);
  Bounds b{kForever, -kForever};
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const auto& c = p.c[axis];
    const double x0 = std::max(knot - p.start, 0.0), x1 = std::min(knot + h, p.end) - p.start;
    const double a0 = c[2] + 3 * c[3] * x0, a1 = c[2] + 3 * c[3] * x1;
    b.low = std::min(b.low, std::min(a0, a1));
    b.high = std::max(b.high, std::max(a0, a1));
  }
  const double wider = spare(axis, std::max(std::abs(b.low), std::abs(b.high)));
  return {b.low - wider, b.high + wider};
}

/// Largest q - p - v t - a t^2 over the segment, piece by piece; x: units from the knot. Exact where it is
/// above kTouch tolerances; below, an upper bound.
Extreme Segmenter::error_over(std::size_t axis, double a, double h, std::size_t last) const {
  const Axis& s = at_.axes[axis];
  const double knot = static_cast<double>(at_.knot), enough = kTouch * s.tolerance;
  Extreme worst;
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const auto& c = p.c[axis];
    const double t = p.start - knot;  // the quadratic, expanded about the piece's start
    const double x0 = std::max(-t, 0.0), x1 = std::min(h - t, p.end - p.start);
    if (x1 < x0) continue;
    const double d0 = c[0] - s.p - t * (s.v + a * t), d1 = c[1] - s.v - 2 * a * t, d2 = c[2] - a, d3 = c[3];
    const double bound = bound_of_cubic(d0, d1, d2, d3, x0, x1);
    const Extreme e = bound <= enough ? Extreme{0, bound} : extreme_of_cubic(d0, d1, d2, d3, x0, x1);
    if (std::abs(e.value) > std::abs(worst.value)) worst = {e.x + t, e.value};
  }
  return worst;
}

Segmenter::Fit Segmenter::fit(std::int32_t units, Goal goal) {
  ++counters_.candidates;
  Fit f{.units = std::clamp(units, 1, kMaxSegmentUnits)};
  const double h = f.units, end = static_cast<double>(at_.knot) + h;
  Target target{.goal = goal, .per_h2 = 1 / (h * h), .last = piece_at(end, 0)};
  // A piece that only the rounding of the knot touches counts for the end state, which is compared itself.
  target.covered = target.last > 0 && piece(target.last).start > end - 1 ? target.last - 1 : target.last;
  if (goal == Goal::kRunOn) {
    target.next = next_units(end, target.last, std::min(kLongest, kMostNext * h));
    const double weight = std::clamp(target.next * h * target.per_h2, kLeastNext, kMostNext);
    target.velocity_share = 0.5 * weight * weight * h;
    target.scale = target.per_h2 / (1 + weight * weight);
  }
  for (std::size_t i = 0; i < at_.axes.size(); ++i) fit_axis(i, target, f);
  f.score = std::max(f.error, f.drift / (eased_ ? kMostEasedDrift : kMostDrift));
  return f;
}

void Segmenter::fit_axis(std::size_t axis, const Target& target, Fit& f) const {
  const Axis& state = at_.axes[axis];
  const double h = f.units;
  const Bounds bound = bounds(axis, h, target.covered);
  Miss m;
  double a = 0;
  Extreme worst;
  // The acceleration nearest to `wanted` that ends within this share of the tolerance.
  const auto end_within = [&](double share, double wanted) {
    const double most = share * state.base_tolerance;
    return std::clamp(wanted, (m.position - most) * target.per_h2, (m.position + most) * target.per_h2);
  };
  const auto apply = [&](double wanted) {
    const double raw =
        std::clamp<double>(wanted * raw_per_unit_, -kMaxSegmentAcceleration, kMaxSegmentAcceleration);
    f.acceleration[axis] = static_cast<std::int32_t>(raw + std::copysign(0.5, raw));
    a = f.acceleration[axis] * unit_per_raw_;
    worst = error_over(axis, a, h, target.covered);
  };
  if (target.goal != Goal::kRunOn) {
    a = resting_acceleration(axis, h, target.goal);
    if (a < bound.low || a > bound.high) f.error = kImpossible;
    apply(a);
    f.error = std::max(f.error, std::abs(worst.value) * state.per_tolerance);
    return;
  }
  // Least r^2 + rho^2 w^2 at the end, rho = next / 2. rho = h / 2 takes an error back in two segments.
  m = miss(axis, h, target.next, target.last);
  const double best = (m.position + target.velocity_share * m.velocity) * target.scale;
  apply(bound.clamp(end_within(kMostEndError, best)));
  const double excess = std::abs(worst.value) - kTouch * state.tolerance;
  if (excess > 0 && excess < kRepairable * state.tolerance && worst.x > kRepairFrom * h) {
    const double repaired = a + std::copysign(excess, worst.value) / (worst.x * worst.x);
    apply(bound.clamp(end_within(kMostRepairedEndError, repaired)));
  }
  const double r = m.position - a * h * h, w = m.velocity - 2 * a * h;
  f.error = std::max(f.error, std::max(std::abs(worst.value), std::abs(r)) * state.per_tolerance);
  // What there is to spare of acceleration must be able to brake w before it leaves the tolerance.
  const double braked = std::copysign(1.0, w) * r + w * w / (4 * spare(axis, std::abs(m.bend)));
  const double cost = std::max(std::abs(r) + kVelocityCost * std::min(h, target.next) * std::abs(w), braked);
  f.drift = std::max(f.drift, cost * state.per_base_tolerance);
}

}  // namespace kinebus
