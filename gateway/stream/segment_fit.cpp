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

Segmenter::Miss Segmenter::miss(double h, double next, std::size_t index) const {
  const double t = static_cast<double>(at_.knot) + h;
  const Piece& p = piece(index);
  const double x = t - p.start;
  const Both q = p.at(x), q1 = p.slope(x);
  // The velocity error at this knot that splits the next segment's error evenly: M next^2 / 12 for a cubic.
  Both wanted = 0.5 * p.c[3] * next * next;
  if (t + next > p.end + 1) {
    const Piece& e = piece(piece_at(t + next, index));
    const double y = t + next - e.start;
    wanted = 0.5 * (q1 + e.slope(y)) - (e.at(y) - q) / next;
  }
  return {q - at_.p - at_.v * h, q1 - at_.v - wanted, p.half_bend(x)};
}

/// kRest: velocity 0 at the end. kHalfway: this and one more segment bring position and velocity to the run's
/// end.
Both Segmenter::resting_acceleration(double h, Goal goal) const {
  if (goal == Goal::kRest) return -0.5 * at_.v / h;
  const double whole = std::max(std::ceil(run_end_ - static_cast<double>(at_.knot) - 1e-6), h + 1);
  const Both missing = piece(count() - 1).c[0] - at_.p - at_.v * whole;
  return (missing + 0.5 * (whole - h) * at_.v) / (h * whole);
}

/// How far an acceleration may leave those of the motion, which reach `most`.
Both Segmenter::spare(Both most) const {
  const Both room = greater(kRoomShare * (axes_.limit - most), kLeastWidening * axes_.limit);
  return most > kOverLimit * axes_.limit ? kOverLimitWidening * axes_.limit : room;
}

/// Where an acceleration may lie: in what q''/2 does on the way, and a part of what is left to the limit.
Segmenter::Bounds Segmenter::bounds(double h, std::size_t last) const {
  const double knot = static_cast<double>(at_.knot);
  Bounds b{both(kForever), both(-kForever)};
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const double x0 = std::max(knot - p.start, 0.0), x1 = std::min(knot + h, p.end) - p.start;
    const Both a0 = p.half_bend(x0), a1 = p.half_bend(x1);
    b.low = lesser(b.low, lesser(a0, a1));
    b.high = greater(b.high, greater(a0, a1));
  }
  const Both wider = spare(greater(magnitude(b.low), magnitude(b.high)));
  return {b.low - wider, b.high + wider};
}

/// Largest q - p - v t - a t^2 over the segment, piece by piece; x: units from the knot. Exact where it is
/// above kTouch tolerances; below, an upper bound.
Segmenter::Worst Segmenter::error_over(Both a, double h, std::size_t last) const {
  const double knot = static_cast<double>(at_.knot);
  const Both enough = kTouch * at_.tolerance;
  Worst worst;
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const double t = p.start - knot;  // the quadratic, expanded about the piece's start
    const double x0 = std::max(-t, 0.0), x1 = std::min(h - t, p.end - p.start);
    if (x1 < x0) continue;
    const Both d0 = p.c[0] - at_.p - t * (at_.v + a * t), d1 = p.c[1] - at_.v - 2 * a * t, d2 = p.c[2] - a,
               d3 = p.c[3];
    Worst here{Both{}, bound_of_cubics(d0, d1, d2, d3, x0, x1)};
    if (const BothBits small = here.value <= enough; !all(small))
      for (int k = 0; k < 2; ++k) {
        if (small[k]) continue;
        const Extreme e = extreme_of_cubic(d0[k], d1[k], d2[k], d3[k], x0, x1);
        here.x[k] = e.x;
        here.value[k] = e.value;
      }
    const BothBits worse = magnitude(here.value) > magnitude(worst.value);
    worst = {worse ? here.x + t : worst.x, worse ? here.value : worst.value};
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
    fit_run_on(target, f);
  } else {
    fit_rest(target, f);
  }
  f.score = std::max(f.error, f.drift / (eased_ ? kMostEasedDrift : kMostDrift));
  return f;
}

/// The acceleration that comes nearest to this one, as whole numbers in `f`.
Both Segmenter::accelerate(Both wanted, Fit& f) const {
  const Both raw =
      clamped(wanted * raw_per_unit_, both(-kMaxSegmentAcceleration), both(kMaxSegmentAcceleration));
  const Both rounded = raw + with_sign_of(both(0.5), raw);
  f.acceleration = {static_cast<std::int32_t>(rounded[0]), static_cast<std::int32_t>(rounded[1])};
  return Both{static_cast<double>(f.acceleration[0]), static_cast<double>(f.acceleration[1])} * unit_per_raw_;
}

void Segmenter::fit_rest(const Target& target, Fit& f) const {
  const double h = f.units;
  const Bounds bound = bounds(h, target.covered);
  const Both a = resting_acceleration(h, target.goal);
  if (any((a < bound.low) | (a > bound.high))) f.error = kImpossible;
  const Worst worst = error_over(accelerate(a, f), h, target.covered);
  f.error = std::max(f.error, greatest(magnitude(worst.value) * at_.per_tolerance));
}

void Segmenter::fit_run_on(const Target& target, Fit& f) const {
  const double h = f.units;
  const Bounds bound = bounds(h, target.covered);
  const Miss m = miss(h, target.next, target.last);
  // The acceleration nearest to `wanted` that is within bounds, and ends within this share of the tolerance
  // where that leaves a choice.
  const auto within = [&](double share, Both wanted) {
    const Both most = share * axes_.tolerance;
    const Both ending =
        clamped(wanted, (m.position - most) * target.per_h2, (m.position + most) * target.per_h2);
    return clamped(ending, bound.low, bound.high);
  };
  // Least r^2 + rho^2 w^2 at the end, rho = next / 2. rho = h / 2 takes an error back in two segments.
  const Both best = (m.position + target.velocity_share * m.velocity) * target.scale;
  const Both wanted = within(kMostEndError, best);
  Both a = accelerate(wanted, f);
  Worst worst = error_over(a, h, target.covered);
  const Both excess = magnitude(worst.value) - kTouch * at_.tolerance;
  if (const BothBits repairable =
          (excess > 0) & (excess < kRepairable * at_.tolerance) & (worst.x > kRepairFrom * h);
      any(repairable)) {
    const Both repaired = a + with_sign_of(magnitude(excess), worst.value) / (worst.x * worst.x);
    a = accelerate(repairable ? within(kMostRepairedEndError, repaired) : wanted, f);
    worst = error_over(a, h, target.covered);
  }
  const Both r = m.position - a * h * h, w = m.velocity - 2 * a * h;
  f.error = greatest(greater(magnitude(worst.value), magnitude(r)) * at_.per_tolerance);
  // What there is to spare of acceleration must be able to brake w before it leaves the tolerance.
  const Both braked = with_sign_of(both(1), w) * r + w * w / (4 * spare(magnitude(m.bend)));
  const Both cost = greater(magnitude(r) + kVelocityCost * std::min(h, target.next) * magnitude(w), braked);
  f.drift = greatest(cost * axes_.per_tolerance);
}

}  // namespace kinebus
