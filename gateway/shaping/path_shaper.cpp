#include "gateway/shaping/path_shaper.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace kinebus {
namespace {

/// Turns nearer to each other are one: the copies' polynomials hold a little beyond their ends, too. At 6000
/// mm/s^2 a position is off by 3e-8 um.
constexpr double kSameTime_s = 1e-7;
/// Poses farther apart do not join, mm or rad: the planner's rounding is far below.
constexpr double kJoin = 1e-6;
/// Where copies are curved, the cubics keep within 10 nm (or 10 nrad) of them, and within 1 % of a gentle
/// printer's acceleration.
constexpr double kTolerance = 1e-5, kAccelTolerance = 10;
/// The check at the end of a cubic holds as long as the fourth derivative is about constant.
constexpr double kLongestCurved_s = 0.01;
/// Shorter cubics are not divided: what is missed in so short a time no joint can follow.
constexpr double kShortestCurved_s = 0.25e-3;
/// Times are kept small, so that their rounding is: 2^-51 s.
constexpr double kRebase_s = 2;
constexpr std::size_t kSources = 256;

bool is_curved(const PathPiece& piece) {
  return piece.arc || std::any_of(piece.coefficients.begin(), piece.coefficients.end(),
                                  [](const auto& c) { return c[2] != 0 || c[3] != 0; });
}

}  // namespace

PathShaper::Tap& PathShaper::tap_at(double delay_s) {
  const auto tap = std::find_if(taps_.begin(), taps_.end(),
                                [&](const Tap& t) { return std::abs(t.delay_s - delay_s) < kSameTime_s; });
  if (tap != taps_.end()) return *tap;
  taps_.push_back({.delay_s = delay_s});
  return taps_.back();
}

PathShaper::PathShaper(const Shapers& shapers, const AdvanceWindow& window)
    : sources_(kSources), window_(window) {
  const double reach_s = window_.reach_s(), w = window_.smooth_s;
  double mean_s = 0;
  for (const InputShaper& shaper : shapers) mean_s = std::max(mean_s, shaper.mean_s());
  for (std::size_t axis = 0; axis < shapers.size(); ++axis) {
    for (const InputShaper::Pulse& pulse : shapers[axis].all()) {
      const double delay_s = pulse.time_s + (mean_s - shapers[axis].mean_s());
      tap_at(delay_s + reach_s).weight[axis] += pulse.weight;
      if (!window_.acts()) continue;
      tap_at(delay_s + reach_s - 0.5 * w).advance_per_s[axis] += pulse.weight / w;
      tap_at(delay_s + reach_s + 0.5 * w).advance_per_s[axis] -= pulse.weight / w;
      if (window_.melt_s == 0) continue;
      const double melt = pulse.weight * window_.melt_s / (w * w);
      tap_at(delay_s + reach_s - w).advance_per_s[axis] += melt;
      tap_at(delay_s + reach_s).advance_per_s[axis] -= 2 * melt;
      tap_at(delay_s + reach_s + w).advance_per_s[axis] += melt;
    }
  }
  mean_s += reach_s;
  std::sort(taps_.begin(), taps_.end(), [](const Tap& a, const Tap& b) { return a.delay_s < b.delay_s; });
  for (std::size_t i = 0; i < taps_.size(); ++i)
    if (std::abs(taps_[i].delay_s - mean_s) < std::abs(taps_[centre_].delay_s - mean_s)) centre_ = i;
}

void PathShaper::reset() {
  sources_.clear();
  waiting_.reset();
  moving_ = ended_ = last_ = false;
}

double PathShaper::held_s() const {
  const double waits = waiting_ ? waiting_->duration_s : 0;
  return waits + (moving_ ? std::max(0.0, end_s_ + duration_s() - now_s_) : 0);
}

bool PathShaper::joins(const Phase& phase) const {
  if (phase.piece.frame != frame_) return false;
  const Pose from = phase.piece.evaluate(phase.s(0)).x;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (std::abs(from[i] - stop_[i]) > kJoin) return false;
  return true;
}

void PathShaper::push(const Phase& phase) {
  assert(!waiting_);
  if (moving_ && (ended_ || !joins(phase))) {
    ended_ = true;
    waiting_ = phase;
    return;
  }
  if (!moving_) begin(phase);
  if (const auto pause = pause_before(phase)) append(*pause);
  append(phase);
}

/// Filament alone and a bead meet at rest, which shaping makes overlap: the tool would be on its way before a
/// retraction is recovered. What was before comes to rest first.
std::optional<Phase> PathShaper::pause_before(const Phase& phase) const {
  const double shaper_s = duration_s() - 2 * window_.reach_s();
  if (!window_.acts() || shaper_s < kSameTime_s || sources_.begin() == sources_.end()) return std::nullopt;
  Phase rest = sources_[sources_.end() - 1].phase;
  const bool after_tool = moves_tool(rest);
  if (after_tool == moves_tool(phase)) return std::nullopt;
  const Phase& tool = after_tool ? rest : phase;
  if (!(tool.piece.evaluate(tool.s(0.5 * tool.duration_s)).x1[kE] > 0)) return std::nullopt;
  rest.s0 = rest.s(rest.duration_s);
  rest.v0 = rest.a = rest.jerk = 0;
  rest.duration_s = shaper_s;
  return rest;
}

void PathShaper::begin(const Phase& phase) {
  sources_.clear();
  moving_ = true;
  ended_ = last_ = false;
  now_s_ = end_s_ = 0;
  frame_ = phase.piece.frame;
  line_ = phase.line;
  start_ = stop_ = phase.piece.evaluate(phase.s(0)).x;
  filament_start_ = filament_stop_ = {start_[kE], 0, 0};
  advance_stop_ = {};
  knot_ = {.x = start_};
  for (Tap& tap : taps_) {
    tap.at = sources_.begin();
    tap.begun = tap.delay_s < kSameTime_s;
  }
}

void PathShaper::append(const Phase& phase) {
  Source& source = sources_.push();
  source.phase = phase;
  source.start_s = end_s_;
  source.advance = window_.acts() ? PhaseAdvance(phase, advance_) : PhaseAdvance();
  source.curved = is_curved(phase.piece) || source.advance.curved();
  const Pose& along = phase.piece.evaluate(phase.s(0.5 * phase.duration_s)).x1;
  const double square = along[kX] * along[kX] + along[kY] * along[kY] + along[kZ] * along[kZ];
  source.before = filament_stop_;
  source.advance_before = advance_stop_;
  const double advance = source.advance.at(phase, phase.duration_s).x;
  const Pose end = phase.piece.evaluate(phase.s(phase.duration_s)).x;
  for (std::size_t i = 0; i < 3; ++i) {
    source.share[i] = square > 0 ? along[i] * along[i] / square : 1.0 / 3;
    filament_stop_[i] += source.share[i] * (end[kE] - stop_[kE]);
    advance_stop_[i] += source.share[i] * advance;
  }
  stop_ = end;
  end_s_ += phase.duration_s;
  if (phase.last) ended_ = last_ = true;
}

std::optional<double> PathShaper::turn_of(const Tap& tap, bool& unknown) const {
  if (!tap.begun) return tap.delay_s;
  if (tap.at != sources_.end()) return end_of(sources_[tap.at]) + tap.delay_s;
  unknown = unknown || !ended_;
  return std::nullopt;
}

void PathShaper::add(const Tap& tap, const PosePoint& point, const std::array<double, 3>& before,
                     const std::array<double, 3>& share, double e_start, Knot& knot) const {
  for (std::size_t i = 0; i < kE; ++i) {
    const double weight = tap.weight[i < 3 ? i : 0];
    knot.x[i] += weight * point.x[i];
    knot.x1[i] += weight * point.x1[i];
    knot.x2[i] += weight * point.x2[i];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    knot.x[kE] += tap.weight[i] * (before[i] + share[i] * (point.x[kE] - e_start));
    knot.x1[kE] += tap.weight[i] * share[i] * point.x1[kE];
    knot.x2[kE] += tap.weight[i] * share[i] * point.x2[kE];
  }
}

void PathShaper::add_advance(const Tap& tap, const PhaseAdvance::Sum& sum,
                             const std::array<double, 3>& before, const std::array<double, 3>& share,
                             Knot& knot) const {
  if (!window_.acts()) return;
  for (std::size_t i = 0; i < 3; ++i) {
    knot.x[kE] += tap.advance_per_s[i] * (before[i] + share[i] * sum.x);
    knot.x1[kE] += tap.advance_per_s[i] * share[i] * sum.x1;
    knot.x2[kE] += tap.advance_per_s[i] * share[i] * sum.x2;
  }
}

PathShaper::Knot PathShaper::evaluate(double t) const {
  Knot knot;
  for (const Tap& tap : taps_) {
    if (!tap.begun) {
      add(tap, {.x = start_}, filament_start_, {}, 0, knot);
    } else if (tap.at == sources_.end()) {
      add(tap, {.x = stop_}, filament_stop_, {}, 0, knot);
      add_advance(tap, {}, advance_stop_, {}, knot);
    } else {
      const Source& source = sources_[tap.at];
      const double e_start = source.before[0] + source.before[1] + source.before[2];
      const double at_s = t - tap.delay_s - source.start_s;
      add(tap, source.phase.at(at_s), source.before, source.share, e_start, knot);
      if (window_.acts())
        add_advance(tap, source.advance.at(source.phase, at_s), source.advance_before, source.share, knot);
    }
  }
  return knot;
}

void PathShaper::hermite(const Knot& a, const Knot& b, double h, PathPiece& piece) {
  const double per_h = 1 / h;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    const double slope = (b.x[i] - a.x[i]) * per_h;
    piece.coefficients[i] = {a.x[i], a.x1[i], (3 * slope - 2 * a.x1[i] - b.x1[i]) * per_h,
                             (a.x1[i] + b.x1[i] - 2 * slope) * per_h * per_h};
  }
}

std::uint32_t PathShaper::line() const {
  const Tap& tap = taps_[centre_];
  return tap.begun && tap.at != sources_.end() ? sources_[tap.at].phase.line : line_;
}

/// Taps go on to the sources that begin at now_s_; what no tap looks at any more is dropped.
void PathShaper::advance() {
  std::uint64_t first = sources_.end();
  for (Tap& tap : taps_) {
    if (!tap.begun) tap.begun = now_s_ > tap.delay_s - kSameTime_s;
    while (tap.begun && tap.at != sources_.end() &&
           end_of(sources_[tap.at]) + tap.delay_s < now_s_ + kSameTime_s)
      ++tap.at;
    first = std::min(first, tap.at);
  }
  line_ = line();
  sources_.drop_to(first);
  if (now_s_ > kRebase_s) rebase();
}

void PathShaper::rebase() {
  // Taps that have not begun look at times from the start on.
  if (!taps_.back().begun) return;
  for (std::uint64_t i = sources_.begin(); i != sources_.end(); ++i) sources_[i].start_s -= now_s_;
  end_s_ -= now_s_;
  now_s_ = 0;
}

bool PathShaper::next(Phase& out) {
  if (!moving_) {
    if (!waiting_) return false;
    const Phase first = *std::exchange(waiting_, std::nullopt);
    begin(first);
    append(first);
  }
  advance();
  bool unknown = false, curved = false;
  double turn = std::numeric_limits<double>::infinity();
  for (const Tap& tap : taps_) {
    if (const auto t = turn_of(tap, unknown)) turn = std::min(turn, *t);
    curved = curved || (tap.begun && tap.at != sources_.end() && sources_[tap.at].curved);
  }
  if (unknown || !(turn < std::numeric_limits<double>::infinity())) return false;

  out = Phase{};
  out.timed = true;
  out.v0 = 1;
  out.line = line();
  out.piece.frame = frame_;
  double h = turn - now_s_;
  if (curved) h /= std::ceil(h / kLongestCurved_s);
  for (;;) {
    const Knot end = evaluate(now_s_ + h);
    hermite(knot_, end, h, out.piece);
    double missed = 0;
    if (curved && h > kShortestCurved_s)
      for (std::size_t i = 0; i < kPoseAxes; ++i)
        missed = std::max(missed, std::abs(end.x2[i] - 2 * out.piece.coefficients[i][2] -
                                           6 * h * out.piece.coefficients[i][3]));
    // A cubic Hermite that misses the second derivative at its end by d is off by d h^2 / 32 in the middle.
    if (missed <= kAccelTolerance && missed * h * h <= 32 * kTolerance) {
      knot_ = end;
      break;
    }
    h /= 2;
  }
  out.piece.length = out.duration_s = h;
  now_s_ += h;
  const bool done = ended_ && now_s_ > end_s_ + duration_s() - kSameTime_s;
  if (done) {
    out.last = last_;
    moving_ = false;
  }
  return true;
}

}  // namespace kinebus
