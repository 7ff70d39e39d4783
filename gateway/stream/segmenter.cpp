#include "gateway/stream/segmenter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "protocol/time.hpp"

namespace kinebus {

namespace {

// The best C1 quadratic spline misses a cubic with q''' = M by 0.00802 M h^3, where position is met and
// velocity is off by M h^2 / 12 at every knot (the Bernoulli polynomial of degree 3). With M = 6 c3:
constexpr double kBendError = 6 * 0.00802;  // times c3 h^3
// A jump J of q''/2 costs J x^2 / 8 at best when a segment goes x beyond it, and leaves a velocity error of J
// x: a segment stops at a jump for which J x^2 / tolerance is above this on both sides.
constexpr double kStopAtJump = 0.3;
// Share of the tolerance that a first guess aims at. The rest is for what the start state brings along, and
// for a velocity target that is a few percent off (the target times h is 10 tolerances).
constexpr double kAim = 0.6;
constexpr double kLongest = kMaxSegmentUnits;
constexpr double kForever = std::numeric_limits<double>::infinity();
// A velocity error w at a knot costs the next segment w h / 3 when it is taken back over two segments.
constexpr double kVelocityCost = 1.0 / 3;
constexpr double kMostDrift = 2.5;
// Position error that an end state may have for the sake of its velocity, in tolerances.
constexpr double kMostEndError = 0.55;
constexpr int kTries = 14;
// An end state up to this drift needs no proof that it can be followed.
constexpr double kSafeDrift = 1.0;
constexpr int kProofs = 8, kProofDepth = 2, kMoreProofs = 3;
// A fit that misses by less than this is corrected at the one place where it misses, to this share of the
// tolerance.
// Only behind this part of its length, where the acceleration has some effect.
constexpr double kRepairable = 0.3, kTouch = 0.97, kRepairFrom = 0.25, kMostRepairedEndError = 0.8;
constexpr double kHopeless = 2.5;       // estimated error beyond which a jump is not tried to be crossed
constexpr double kImpossible = 100;     // error of a fit that no acceleration within bounds gives
constexpr std::int32_t kShortest = 64;  // 1 ms
// Accelerations may leave those of q'' by this share of what is left to the joint's limit.
constexpr double kRoomShare = 0.75, kLeastWidening = 0.002;
// A motion that is over the limit itself is followed anyway, with this much to spare.
constexpr double kOverLimit = 1.02, kOverLimitWidening = 0.05;

// Weight of velocity against position at the end: by the length of the next segment, within these multiples.
constexpr double kLeastNext = 0.5, kMostNext = 1.5;

std::int32_t round_up(double x) {
  return static_cast<std::int32_t>(std::ceil(x - 1e-6));
}

}  // namespace

double Segmenter::Fit::score() const {
  return std::max(error, drift / kMostDrift);
}

Segmenter::Segmenter(const NodeAxes& node, Options options)
    : node_(node),
      options_(options),
      raw_per_unit_(kCountFraction / static_cast<double>(1 << options.acceleration_shift)),
      pieces_(kCapacity) {
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const AxisScaling& scaling = node.axes[i];
    at_.axes[i].base_tolerance =
        std::max(scaling.tolerance_counts - options.margin_counts, 0.5 * scaling.tolerance_counts);
    at_.axes[i].limit =
        0.5 * std::abs(scaling.slope()) * scaling.acceleration_limit * kSecondsPerUnit * kSecondsPerUnit;
  }
}

void Segmenter::start(const std::array<AxisState, kAxesPerNode>& states) {
  assert(states[0].velocity == 0 && states[1].velocity == 0);
  at_.states = states;
  at_.first = at_.count = 0;
  at_.knot = 0;
  start_offset_ = 0;
  planned_.reset();
  complete_ = ended_ = false;
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    at_.axes[i].p = to_counts(states[i].position);
    at_.axes[i].v = 0;
    at_.axes[i].tolerance = at_.axes[i].base_tolerance;
  }
}

void Segmenter::append(const Piece& next) {
  if (at_.count > 0) {
    Piece& before = piece(at_.count - 1);
    const double d = before.end - before.start;
    before.jump = 0;
    for (std::size_t i = 0; i < at_.axes.size(); ++i)
      before.jump = std::max(before.jump, std::abs(next.c[i][2] - before.c[i][2] - 3 * before.c[i][3] * d) /
                                              at_.axes[i].base_tolerance);
  }
  ++at_.count;
  piece(at_.count - 1) = next;
}

void Segmenter::push(const JointSpan& span) {
  assert(has_room() && !complete_ && !ended_);
  constexpr double u = kSecondsPerUnit;
  Piece p;
  p.start = span.start_s / u;
  p.end = (span.start_s + span.duration_s) / u;
  p.line = span.line;
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const AxisScaling& scaling = node_.axes[i];
    if (scaling.joint < 0) {
      p.c[i] = {to_counts(at_.states[i].position), 0, 0, 0};
      continue;
    }
    const auto& c = span.coefficients[static_cast<std::size_t>(scaling.joint)];
    const double k = scaling.slope();
    p.c[i] = {scaling.to_counts(c[0]), k * u * c[1], k * u * u * c[2], k * u * u * u * c[3]};
    p.bend = std::max(p.bend, std::abs(p.c[i][3]) / at_.axes[i].base_tolerance);
  }
  if (at_.count == 0 && at_.knot == 0)
    for (std::size_t i = 0; i < at_.axes.size(); ++i) {
      const double offset = std::abs(p.c[i][0] - at_.axes[i].p);
      start_offset_ = std::max(start_offset_, offset);
      at_.axes[i].tolerance = std::max(at_.axes[i].base_tolerance, 1.2 * offset);
    }
  append(p);
  if (!span.last) return;
  complete_ = true;
  run_end_ = p.end;
  Piece rest{.start = p.end, .end = kForever, .line = span.line};
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const double d = p.end - p.start;
    rest.c[i][0] = p.c[i][0] + d * (p.c[i][1] + d * (p.c[i][2] + d * p.c[i][3]));
  }
  append(rest);
}

bool Segmenter::ready() const {
  if (at_.count == 0) return false;
  return complete_ || !has_room() || piece(at_.count - 1).end >= static_cast<double>(at_.knot) + 3 * kLongest;
}

/// The piece that holds at time t. A knot is rounded to the grid, so one within half a unit before a boundary
/// belongs to what follows the boundary.
std::size_t Segmenter::piece_at(double t, std::size_t hint) const {
  while (hint + 1 < at_.count && piece(hint).end < t + 0.5) ++hint;
  return hint;
}

/// Whether a segment that begins b units before the end of piece `index` had better end there: when it could
/// neither get far beyond the jump, nor is the jump small.
bool Segmenter::stops_at(std::size_t index, double b) const {
  const double jump = piece(index).jump;
  if (complete_ && index + 2 == at_.count) return true;
  if (jump * b * b < kStopAtJump) return false;
  const double enough = std::sqrt(kStopAtJump / jump);
  double after = 0;
  for (std::size_t i = index + 1; i < at_.count; ++i) {
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
    if (complete_ && i + 1 == at_.count) return {begin, i, false, true};
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
    if (end >= kLongest || i + 1 == at_.count) return {to, i, false, false};
    if (stops_at(i, end) && !(complete_ && i + 2 == at_.count)) return {end, i + 1, true, false};
    change += p.jump + 3 * p.bend * (end - std::max(begin, 0.0));
    begin = end;
  }
}

/// How far a segment that begins at t, in piece `index`, will go at most.
double Segmenter::next_units(double t, std::size_t index, double most) const {
  double bend = 0;
  for (std::size_t i = index; i < at_.count; ++i) {
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
  const double missing = piece(at_.count - 1).c[axis][0] - a.p - a.v * whole;
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
std::array<double, 2> Segmenter::bounds(std::size_t axis, double h, std::size_t last) const {
  const double limit = at_.axes[axis].limit;
  if (limit <= 0) return {-kForever, kForever};
  const double knot = static_cast<double>(at_.knot);
  double low = kForever, high = -kForever;
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const auto& c = p.c[axis];
    const double x0 = std::max(knot - p.start, 0.0), x1 = std::min(knot + h, p.end) - p.start;
    const double a0 = c[2] + 3 * c[3] * x0, a1 = c[2] + 3 * c[3] * x1;
    low = std::min({low, a0, a1});
    high = std::max({high, a0, a1});
  }
  const double wider = spare(axis, std::max(std::abs(low), std::abs(high)));
  return {low - wider, high + wider};
}

/// Largest q - p - v t - a t^2 over the segment, piece by piece, exact. x: units from the knot.
Extreme Segmenter::error_over(std::size_t axis, double a, double h, std::size_t last) const {
  const Axis& s = at_.axes[axis];
  const double knot = static_cast<double>(at_.knot);
  Extreme worst;
  for (std::size_t i = 0; i <= last; ++i) {
    const Piece& p = piece(i);
    const auto& c = p.c[axis];
    const double t = p.start - knot;  // the quadratic, expanded about the piece's start
    const double x0 = std::max(-t, 0.0), x1 = std::min(h - t, p.end - p.start);
    if (x1 < x0) continue;
    const Extreme e =
        extreme_of_cubic(c[0] - s.p - t * (s.v + a * t), c[1] - s.v - 2 * a * t, c[2] - a, c[3], x0, x1);
    if (std::abs(e.value) > std::abs(worst.value)) worst = {e.x + t, e.value};
  }
  return worst;
}

Segmenter::Fit Segmenter::fit(std::int32_t units, Goal goal) {
  ++counters_.candidates;
  Fit f{.units = std::clamp(units, 1, kMaxSegmentUnits)};
  const double h = f.units, end = static_cast<double>(at_.knot) + h;
  const std::size_t last = piece_at(end, 0);
  const double next = goal == Goal::kRunOn ? next_units(end, last, std::min(kLongest, kMostNext * h)) : 0;
  const double weight = std::clamp(next / h, kLeastNext, kMostNext);
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const auto [low, high] = bounds(i, h, last);
    Miss m;
    double a = 0;
    // The acceleration nearest to `wanted` that ends within this share of the tolerance.
    const auto end_within = [&](double share, double wanted) {
      const double most = share * at_.axes[i].base_tolerance;
      return std::clamp(wanted, (m.position - most) / (h * h), (m.position + most) / (h * h));
    };
    if (goal == Goal::kRunOn) {
      // Least r^2 + rho^2 w^2 at the end, rho = next / 2. rho = h / 2 takes an error back in two segments.
      m = miss(i, h, next, last);
      a = (m.position + 0.5 * weight * weight * h * m.velocity) / ((1 + weight * weight) * h * h);
      a = std::clamp(end_within(kMostEndError, a), low, high);
    } else {
      a = resting_acceleration(i, h, goal);
      if (a < low || a > high) f.error = kImpossible;
    }
    Extreme worst;
    const auto apply = [&](double wanted) {
      const double raw =
          std::clamp<double>(wanted * raw_per_unit_, -kMaxSegmentAcceleration, kMaxSegmentAcceleration);
      f.acceleration[i] = static_cast<std::int32_t>(raw + std::copysign(0.5, raw));
      a = f.acceleration[i] / raw_per_unit_;
      worst = error_over(i, a, h, last);
    };
    apply(a);
    const double tolerance = at_.axes[i].tolerance, excess = std::abs(worst.value) - kTouch * tolerance;
    if (goal == Goal::kRunOn && excess > 0 && excess < kRepairable * tolerance && worst.x > kRepairFrom * h) {
      const double repaired = a + std::copysign(excess, worst.value) / (worst.x * worst.x);
      apply(std::clamp(end_within(kMostRepairedEndError, repaired), low, high));
    }
    f.error = std::max(f.error, std::abs(worst.value) / tolerance);
    if (goal != Goal::kRunOn) continue;
    const double r = std::abs(m.position - a * h * h), w = std::abs(m.velocity - 2 * a * h);
    // What there is to spare of acceleration must be able to brake it before it leaves the tolerance.
    const bool away = (m.position - a * h * h) * (m.velocity - 2 * a * h) > 0;
    const double cost = std::max(r + kVelocityCost * std::min(h, next) * w,
                                 (away ? r : -r) + w * w / (4 * spare(i, std::abs(m.bend))));
    f.drift = std::max(f.drift, cost / at_.axes[i].base_tolerance);
  }
  return f;
}

/// The longest segment that is good, as far as a few trials find it.
Segmenter::Fit Segmenter::choose() {
  const Reach far = reach();
  return far.at_end ? come_to_rest() : run_on(far);
}

Segmenter::Fit Segmenter::come_to_rest() {
  const double remaining = run_end_ - static_cast<double>(at_.knot);
  const std::int32_t units = std::max(round_up(remaining), 1);
  Fit best = fit(units, Goal::kRest);
  if (best.good()) return best;
  if (units < kShortest) {  // too late to brake within the run: a little after it
    const Fit later = fit(kShortest, Goal::kRest);
    return later.error < best.error ? later : best;
  }
  const Fit half = fit(units / 2, Goal::kHalfway);
  return half.good() ? half : shrink(half);
}

/// A steady chain of segments of h on a bend has the velocity error w = M h^2 / 12 at every knot. Coming from
/// w0, a segment that meets the position ends with M h^2 / 6 - w0; so the steady state is reached at once by
/// h^2 (1/2 + w0 / 2w). From w0 = 0 that is h / sqrt(2).
double Segmenter::steadied(double h) const {
  const double knot = static_cast<double>(at_.knot);
  const Piece& p = piece(0);
  const Piece& e = piece(piece_at(knot + h, 0));
  const double x = knot - p.start, y = knot + h - e.start;
  double steady = 0, now = 0;  // of the axis that bends more, in tolerances
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const auto& c = p.c[i];
    const auto& d = e.c[i];
    const double q = c[0] + x * (c[1] + x * (c[2] + x * c[3])), q1 = c[1] + x * (2 * c[2] + x * 3 * c[3]);
    const double r = d[0] + y * (d[1] + y * (d[2] + y * d[3])), r1 = d[1] + y * (2 * d[2] + y * 3 * d[3]);
    const double wanted = (0.5 * (q1 + r1) - (r - q) / h) / at_.axes[i].base_tolerance;
    if (std::abs(wanted) <= std::abs(steady)) continue;
    steady = wanted;
    now = (q1 - at_.axes[i].v) / at_.axes[i].base_tolerance;
  }
  if (std::abs(steady) * h < 1) return h;
  return h * std::sqrt(std::clamp(0.5 + 0.5 * now / steady, 0.15, 1.2));
}

Segmenter::Fit Segmenter::run_on(const Reach& far) {
  double h = far.at_jump ? far.units : steadied(far.units);
  const Piece& p = piece(far.piece);
  const double rest = p.end - static_cast<double>(at_.knot);
  bool halfway = false;
  if (!far.at_jump && rest < 6 * h) {
    // Even parts up to a jump, so that no short one is left over.
    const bool run_end = complete_ && far.piece + 2 == at_.count;
    const double parts = std::ceil(rest / std::min(1.05 * h, kLongest));
    if (run_end || p.jump * h * h > kStopAtJump) {
      h = rest / parts;
      halfway = run_end && parts == 2;
    }
  }
  const auto units = static_cast<std::int32_t>(std::lround(h));
  if (halfway) {
    const Fit half = fit(units, Goal::kHalfway);
    if (half.good()) return half;
  }
  const Fit f = fit(units, Goal::kRunOn);
  if (!f.good()) return shrink(f);
  if (far.at_jump) return cross_jumps(f, far);
  if (f.score() < 0.4 && h < 0.7 * kLongest && !halfway) {
    const Fit longer =
        fit(static_cast<std::int32_t>(std::min(h * std::cbrt(0.8 / std::max(f.score(), 0.1)), kLongest)),
            Goal::kRunOn);
    if (longer.good()) return longer;
  }
  return f;
}

/// From a jump on: perhaps the piece behind it is so short that the segment can go on to its end.
Segmenter::Fit Segmenter::cross_jumps(Fit best, const Reach& far) {
  const double knot = static_cast<double>(at_.knot);
  const std::size_t stop = complete_ ? at_.count - 1 : at_.count;
  for (std::size_t i = far.piece; i < stop; ++i) {
    const double h = piece(i).end - knot, over = h - best.units;
    if (h > kLongest) break;
    if (piece(i - 1).jump * over * over > kHopeless) break;
    const Fit g = fit(static_cast<std::int32_t>(std::lround(h)), Goal::kRunOn);
    if (!g.good()) break;
    best = g;
  }
  return best;
}

Segmenter::Fit Segmenter::shrink(Fit failed) {
  Fit best = failed, f = failed;
  for (int i = 0; i < kTries && f.units > 2; ++i) {
    const double factor = std::clamp(std::cbrt(0.7 / f.score()), 0.25, 0.8);
    f = fit(static_cast<std::int32_t>(factor * f.units), Goal::kRunOn);
    if (f.score() < best.score() || (f.error <= 1 && best.error > 1)) best = f;
    if (f.good()) break;
  }
  return best;
}

/// Whether what follows `f` can be fitted, too: until a segment comes that needs no proof. Remembers the next
/// one.
bool Segmenter::leads_on(const Fit& f, int depth) {
  if (f.drift <= kSafeDrift) return true;
  const Position before = at_;
  apply(f);
  const Fit following = choose();
  const bool far_enough = depth <= 0 && f.units + following.units >= kShortest;
  const bool proved =
      following.error <= 1 && (far_enough || (depth > -kMoreProofs && leads_on(following, depth - 1)));
  at_ = before;
  if (proved) planned_ = following;
  return proved;
}

Segmenter::Fit Segmenter::choose_safe() {
  Fit f = planned_ ? *planned_ : choose();
  planned_.reset();
  Fit best = f;
  for (int i = 0; i < kProofs; ++i) {
    if (f.error <= 1 && leads_on(f, kProofDepth)) return f;
    planned_.reset();
    if (f.units < 4) break;
    // A dead end: a shorter segment has more to choose from.
    f = fit(f.units * 5 / 8, Goal::kRunOn);
    if (best.error > 1 ? f.error < best.error : f.score() < best.score()) best = f;
  }
  return best;
}

void Segmenter::apply(const Fit& f) {
  at_.knot += f.units;
  const std::size_t last = piece_at(static_cast<double>(at_.knot), 0);
  const Piece& p = piece(last);
  const double x = static_cast<double>(at_.knot) - p.start;
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    at_.states[i] = advance(at_.states[i], f.acceleration[i], f.units, options_.acceleration_shift);
    Axis& a = at_.axes[i];
    a.p = to_counts(at_.states[i].position);
    a.v = to_counts(at_.states[i].velocity);
    const double q = p.c[i][0] + x * (p.c[i][1] + x * (p.c[i][2] + x * p.c[i][3]));
    const double offset = std::abs(q - a.p);
    a.tolerance = offset > a.base_tolerance ? 1.1 * offset : a.base_tolerance;
  }
  at_.first += last;
  at_.count -= last;
}

FittedSegment Segmenter::emit(const Fit& f) {
  FittedSegment segment{at_.knot, f.units, f.acceleration, at_.states, piece(0).line};
  ++counters_.segments;
  counters_.worst_ratio = std::max(counters_.worst_ratio, f.error);
  if (f.error > 1) ++counters_.loose;
  apply(f);
  return segment;
}

/// At the run's end: the few 2^-32 counts/unit of velocity that rounding left are taken out in one unit of
/// time, so that rest is exact. nullopt: there is more than that, or nothing.
std::optional<FittedSegment> Segmenter::settle() {
  Fit f{.units = 1};
  bool moving = false;
  for (std::size_t i = 0; i < at_.axes.size(); ++i) {
    const std::int64_t raw = at_.states[i].velocity >> (options_.acceleration_shift + 1);
    if (std::abs(raw) > kMaxSegmentUnits) return std::nullopt;
    f.acceleration[i] = static_cast<std::int32_t>(-raw);
    moving = moving || raw != 0;
  }
  if (moving) return emit(f);
  ended_ = true;
  return std::nullopt;
}

std::optional<FittedSegment> Segmenter::next() {
  if (ended_ || !ready()) return std::nullopt;
  if (complete_ && run_end_ - static_cast<double>(at_.knot) < 1e-6) {
    auto segment = settle();
    if (segment || ended_) return segment;
  }
  return emit(choose_safe());
}

}  // namespace kinebus
