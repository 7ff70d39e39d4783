#include "gateway/stream/segmenter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "gateway/stream/segmenter_tuning.hpp"
#include "protocol/time.hpp"

namespace kinebus {

using namespace segmenter;

namespace {

std::int32_t round_up(double x) {
  return static_cast<std::int32_t>(std::ceil(x - 1e-6));
}

}  // namespace

Segmenter::Segmenter(const NodeAxes& node, Options options)
    : node_(node),
      options_(options),
      raw_per_unit_(kCountFraction / static_cast<double>(1 << options.acceleration_shift)),
      unit_per_raw_(1 / raw_per_unit_),
      pieces_(kCapacity) {
  for (std::size_t i = 0; i < kAxesPerNode; ++i) {
    const AxisScaling& scaling = node.axes[i];
    axes_.tolerance[i] =
        std::max(scaling.tolerance_counts - options.margin_counts, 0.5 * scaling.tolerance_counts);
    axes_.per_tolerance[i] = 1 / axes_.tolerance[i];
    slope_[i] = scaling.slope();
    const double limit =
        0.5 * std::abs(scaling.slope()) * scaling.acceleration_limit * kSecondsPerUnit * kSecondsPerUnit;
    axes_.limit[i] = limit > 0 ? limit : kForever;
  }
}

void Segmenter::start(const std::array<AxisState, kAxesPerNode>& states) {
  assert(states[0].velocity == 0 && states[1].velocity == 0);
  at_.states = states;
  at_.first = pushed_ = 0;
  at_.knot = 0;
  start_offset_ = 0;
  links_ = 0;
  eased_ = false;
  complete_ = ended_ = false;
  at_.p = Both{to_counts(states[0].position), to_counts(states[1].position)};
  at_.v = Both{};
}

/// The tolerances, while the state at the knot is `offset` counts off.
void Segmenter::widen(Both offset) {
  at_.tolerance = axes_.tolerance;
  at_.per_tolerance = axes_.per_tolerance;
  const BothBits within = offset <= axes_.tolerance;
  for (int i = 0; i < 2; ++i)
    if (!within[i]) {
      at_.tolerance[i] = 1.1 * offset[i];
      at_.per_tolerance[i] = 1 / at_.tolerance[i];
    }
}

void Segmenter::append(const Piece& next) {
  if (count() > 0) {
    Piece& before = place(count() - 1);
    const double d = before.end - before.start;
    before.jump = greatest(magnitude(next.c[2] - before.half_bend(d)) * axes_.per_tolerance);
  }
  ++pushed_;
  place(count() - 1) = next;
}

void Segmenter::push(const JointSpan& span) {
  assert(has_room() && !complete_ && !ended_);
  constexpr double u = kSecondsPerUnit, per_u = 1 / kSecondsPerUnit;
  Piece p;
  p.start = span.start_s * per_u;
  p.end = (span.start_s + span.duration_s) * per_u;
  p.line = span.line;
  for (std::size_t i = 0; i < kAxesPerNode; ++i) {
    const AxisScaling& scaling = node_.axes[i];
    if (scaling.joint < 0) {
      p.c[0][i] = to_counts(at_.states[i].position);
      continue;
    }
    const auto& c = span.coefficients[static_cast<std::size_t>(scaling.joint)];
    const double k = slope_[i];
    p.c[0][i] = k * (c[0] - scaling.offset);
    p.c[1][i] = k * u * c[1];
    p.c[2][i] = k * u * u * c[2];
    p.c[3][i] = k * u * u * u * c[3];
  }
  p.bend = greatest(magnitude(p.c[3]) * axes_.per_tolerance);
  if (count() == 0) {
    const Both offset = magnitude(p.c[0] - at_.p);
    start_offset_ = std::max(start_offset_, greatest(offset));
    widen(offset);
  }
  eased_ = eased_ || span.eased;
  append(p);
  if (!span.last) return;
  complete_ = true;
  run_end_ = p.end;
  Piece rest{.start = p.end, .end = kForever, .line = span.line};
  rest.c[0] = p.at(p.end - p.start);
  append(rest);
}

bool Segmenter::ready() const {
  // Of a run that is complete the rest behind it has no end.
  return count() > 0 &&
         (!has_room() || place(count() - 1).end >= static_cast<double>(at_.knot) + 3 * kLongest);
}

double Segmenter::known() const {
  return pieces_[(pushed_ - 1) & (kCapacity - 1)].end - static_cast<double>(at_.knot);
}

/// The piece that holds at time t. A knot is rounded to the grid, so one within half a unit before a boundary
/// belongs to what follows the boundary.
std::size_t Segmenter::piece_at(double t, std::size_t hint) const {
  while (hint + 1 < count() && piece(hint).end < t + 0.5) ++hint;
  return hint;
}

/// The longest segment that is good, as far as a few trials find it.
Segmenter::Fit Segmenter::choose() {
  furthest_ = 0;
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
/// Where hardly anything bends, w0 is what the end of a bend has left, and alone sets how far a segment can
/// go.
double Segmenter::steadied(double h) const {
  const double knot = static_cast<double>(at_.knot);
  const Piece& p = piece(0);
  const Piece& e = piece(piece_at(knot + h, 0));
  const double x = knot - p.start, y = knot + h - e.start;
  const Both q = p.at(x), q1 = p.slope(x), off = q1 - at_.v;
  const Both wanted = (0.5 * (q1 + e.slope(y)) - (e.at(y) - q) / h) / axes_.tolerance;
  const double left = greatest(magnitude(off) * axes_.per_tolerance);  // of the axis that is off more
  // Of the axis that bends more, in tolerances.
  const int bends = std::abs(wanted[1]) > std::abs(wanted[0]) ? 1 : 0;
  const double steady = wanted[bends], now = off[bends] / axes_.tolerance[bends];
  if (eased_ && std::abs(steady) * h < kStraight) return std::min(h, kTakenBack / left);
  if (std::abs(steady) * h < 1) return h;
  return h * std::sqrt(std::clamp(0.5 + 0.5 * now / steady, 0.15, 1.2));
}

Segmenter::Fit Segmenter::run_on(const Reach& far) {
  double h = far.at_jump && !eased_ ? far.units : std::min(steadied(far.units), known());
  const bool at_jump = far.at_jump && h >= kNearJump * far.units;
  if (at_jump) h = far.units;
  const Piece& p = piece(far.piece);
  const double rest = p.end - static_cast<double>(at_.knot);
  bool halfway = false;
  if (!at_jump && rest < 6 * h) {
    // Even parts up to a jump, so that no short one is left over.
    const bool run_end = complete_ && far.piece + 2 == count();
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
  if (at_jump) return cross_jumps(f, far);
  if (f.score < 0.4 && h < 0.7 * kLongest && !halfway) {
    const double most = std::min(kLongest, known());
    const Fit longer = fit(
        static_cast<std::int32_t>(std::min(h * std::cbrt(0.8 / std::max(f.score, 0.1)), most)), Goal::kRunOn);
    if (longer.good()) return longer;
  }
  return f;
}

/// From a jump on: perhaps the piece behind it is so short that the segment can go on to its end.
Segmenter::Fit Segmenter::cross_jumps(Fit best, const Reach& far) {
  const double knot = static_cast<double>(at_.knot);
  for (std::size_t i = far.piece; i < count(); ++i) {
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
    const double factor = std::clamp(std::cbrt(0.7 / f.score), 0.25, 0.8);
    f = fit(static_cast<std::int32_t>(factor * f.units), Goal::kRunOn);
    if (f.score < best.score || (f.error <= 1 && best.error > 1)) best = f;
    if (f.good()) break;
  }
  return best;
}

void Segmenter::begin_chain(const Fit& fit) {
  links_ = 1;
  link(0) = {.at = at_, .fit = fit};
}

/// Finds the segment behind link i, unless it is known. False: none is good enough.
bool Segmenter::extend_chain(std::size_t i) {
  const std::size_t next = i + 1;
  if (is_stale(link(next))) links_ = next;
  if (next == links_) {
    Link& following = link(next);
    at_ = link(i).at;
    apply(link(i).fit);
    following.at = at_;
    following.fit = choose();
    following.pushed = furthest_ + 2 < count() ? kWhateverComes : pushed_;
    ++links_;
  }
  return link(next).fit.error <= 1;
}

/// Whether what follows the chain's first segment can be fitted, too: until a segment comes that needs no
/// proof.
bool Segmenter::leads_on() {
  const Position here = at_;
  bool proved = false;
  int depth = kProofDepth;
  for (std::size_t i = 0;; ++i, --depth) {
    proved = link(i).fit.drift <= kSafeDrift;
    if (proved || !extend_chain(i)) break;
    proved = depth <= 0 && link(i).fit.units + link(i + 1).fit.units >= kProofUnits;
    if (proved || depth <= -kMoreProofs) break;
  }
  at_ = here;
  return proved;
}

const Segmenter::Fit& Segmenter::choose_safe() {
  if (links_ == 0) begin_chain(choose());
  Fit best = link(0).fit;
  for (int i = 0; i < kProofs; ++i) {
    const Fit f = link(0).fit;
    if (f.error <= 1 && leads_on()) return link(0).fit;
    if (f.units < 4) break;
    // A dead end: a shorter segment has more to choose from.
    begin_chain(fit(f.units * 5 / 8, Goal::kRunOn));
    if (best.error > 1 ? link(0).fit.error < best.error : link(0).fit.score < best.score) best = link(0).fit;
  }
  begin_chain(best);
  return link(0).fit;
}

void Segmenter::apply(const Fit& f) {
  at_.knot += f.units;
  const std::size_t last = piece_at(static_cast<double>(at_.knot), 0);
  const Piece& p = piece(last);
  const double x = static_cast<double>(at_.knot) - p.start;
  for (std::size_t i = 0; i < kAxesPerNode; ++i) {
    at_.states[i] = advance(at_.states[i], f.acceleration[i], f.units, options_.acceleration_shift);
    at_.p[i] = to_counts(at_.states[i].position);
    at_.v[i] = to_counts(at_.states[i].velocity);
  }
  widen(magnitude(p.at(x) - at_.p));
  at_.first += last;
}

FittedSegment Segmenter::emit(const Fit& f) {
  FittedSegment segment{at_.knot, f.units, f.acceleration, at_.states, piece(0).line};
  ++counters_.segments;
  counters_.worst_ratio = std::max(counters_.worst_ratio, f.error);
  if (f.error > 1) ++counters_.loose;
  if (links_ > 1) {
    at_ = link(1).at;
    ++first_link_;
    --links_;
  } else {
    apply(f);
    links_ = 0;
  }
  return segment;
}

/// At the run's end: the few 2^-32 counts/unit of velocity that rounding left are taken out in one unit of
/// time, so that rest is exact. nullopt: there is more than that, or nothing.
std::optional<FittedSegment> Segmenter::settle() {
  Fit f{.units = 1};
  bool moving = false;
  for (std::size_t i = 0; i < kAxesPerNode; ++i) {
    const std::int64_t raw = at_.states[i].velocity >> (options_.acceleration_shift + 1);
    if (std::abs(raw) > kMaxSegmentUnits) return std::nullopt;
    f.acceleration[i] = static_cast<std::int32_t>(-raw);
    moving = moving || raw != 0;
  }
  links_ = 0;
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
