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
/// Where copies are curved, the cubics keep within 10 nm (or 10 nrad) of them.
constexpr double kTolerance = 1e-5;
/// The check at the end of a cubic holds as long as the fourth derivative is about constant.
constexpr double kLongestCurved_s = 0.01;
/// Shorter cubics are not divided: what is missed in so short a time no joint can follow.
constexpr double kShortestCurved_s = 0.25e-3;
/// Times are kept small, so that their rounding is: 2^-51 s.
constexpr double kRebase_s = 2;
constexpr std::size_t kSources = 256;
/// Of the path's parameter, /s: the planner's rounding.
constexpr double kAtRest = 1e-6;

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

PathShaper::PathShaper(const Shapers& shapers, const AdvanceWindow& window, bool along_tip,
                       double filament_offset_mm)
    : sources_(kSources), window_(window), along_tip_(along_tip), offset_(filament_offset_mm) {
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

void PathShaper::push(const Phase& phase, const PhaseAdvance::Filament* given) {
  assert(!waiting_);
  PhaseAdvance::Filament beads{};
  if (given != nullptr)
    beads = *given;
  else if (window_.acts() && moves_tool(phase))
    beads = phase.piece.coefficients[kE];
  if (moving_ && (ended_ || !joins(phase))) {
    ended_ = true;
    waiting_ = phase;
    waiting_beads_ = beads;
    return;
  }
  if (!moving_) begin(phase);
  if (const auto pause = pause_before(phase)) {
    // What flows there yet is of the model before.
    const AdvanceModel next = std::exchange(advance_, sources_[sources_.end() - 1].model);
    append(*pause, {});
    advance_ = next;
  }
  append(phase, beads);
}

/// Filament alone and a bead meet at rest, or with a short travel between them, which shaping makes overlap:
/// the tool would be on its way before a retraction is recovered. What was before comes to rest first, and
/// its advance to 0, so that each has the extruder for itself; the same where the advance changes.
std::optional<Phase> PathShaper::pause_before(const Phase& phase) const {
  if (pause_s_ < kSameTime_s || sources_.empty()) return std::nullopt;
  const Source& last = sources_[sources_.end() - 1];
  Phase rest = last.phase;
  // A rest in the midst of motion would be a step.
  if (std::abs(rest.speed(rest.duration_s)) > kAtRest) return std::nullopt;
  double pause_s = pause_s_;
  if (last.model == advance_) {
    const bool after_tool = moves_tool(rest);
    if (after_tool == moves_tool(phase)) return std::nullopt;
    if (after_tool)
      pause_s -= since_fed_s_;
    else if (!feeds_along_tip(phase))
      pause_s -= phase.duration_s;
    if (pause_s < kSameTime_s) return std::nullopt;
  }
  rest.s0 = rest.s(rest.duration_s);
  rest.v0 = rest.a = rest.jerk = 0;
  rest.duration_s = pause_s;
  return rest;
}

void PathShaper::begin(const Phase& phase) {
  sources_.clear();
  moving_ = true;
  ended_ = last_ = false;
  now_s_ = end_s_ = 0;
  since_fed_s_ = pause_s_;
  frame_ = phase.piece.frame;
  line_ = phase.line;
  start_ = stop_ = phase.piece.evaluate(phase.s(0)).x;
  filament_start_ = filament_stop_ = {start_[kE], 0, 0};
  advance_stop_ = {};
  knot_ = {.x = start_};
  knot_.x[kE] += offset_;
  plain_ = start_[kE];
  for (Tap& tap : taps_) {
    tap.at = sources_.begin();
    tap.begun = tap.delay_s < kSameTime_s;
  }
}

void PathShaper::append(const Phase& phase, const PhaseAdvance::Filament& beads) {
  Source& source = sources_.push();
  source.phase = phase;
  source.start_s = end_s_;
  source.beads = beads;
  source.advance = window_.acts() ? PhaseAdvance(phase, beads, advance_) : PhaseAdvance();
  // What is timed is a cubic in time already.
  source.curved = (!phase.timed && is_curved(phase.piece)) || source.advance.curved();
  const Pose& along = phase.piece.evaluate(phase.s(0.5 * phase.duration_s)).x1;
  source.model = advance_;
  source.along_tip = along_tip_ && feeds_along_tip(phase);
  const double square = along[kX] * along[kX] + along[kY] * along[kY] + along[kZ] * along[kZ];
  source.before = filament_stop_;
  source.e_start = along_tip_ ? stop_[kE] : filament_stop_[0] + filament_stop_[1] + filament_stop_[2];
  source.advance_before = advance_stop_;
  const double advance = source.advance.at(phase, beads, phase.duration_s).x;
  const Pose end = phase.piece.evaluate(phase.s(phase.duration_s)).x;
  for (std::size_t i = 0; i < 3; ++i) {
    source.share[i] = square > 0 && !along_tip_ ? along[i] * along[i] / square : 1.0 / 3;
    source.direction[i] = square > 0 ? along[i] / std::sqrt(square) : 0;
    if (!source.along_tip) filament_stop_[i] += source.share[i] * (end[kE] - stop_[kE]);
    advance_stop_[i] += source.share[i] * advance;
  }
  stop_ = end;
  end_s_ += phase.duration_s;
  since_fed_s_ = feeds_along_tip(phase) && phase.speed(0.5 * phase.duration_s) > kAtRest
                     ? 0
                     : since_fed_s_ + phase.duration_s;
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
      const double at_s = t - tap.delay_s - source.start_s;
      PosePoint point = source.phase.at(at_s);
      if (source.along_tip) {
        knot.flow.add(tap.weight, source.phase, at_s);
        point.x[kE] = source.e_start;
        point.x1[kE] = point.x2[kE] = 0;
      }
      add(tap, point, source.before, source.share, source.e_start, knot);
      if (window_.acts())
        add_advance(tap, source.advance.at(source.phase, source.beads, at_s), source.advance_before,
                    source.share, knot);
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
void PathShaper::go_on() {
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

/// Filament that follows the tip does so in more than one direction, or along a curve.
bool PathShaper::bent() const {
  constexpr double kStraight = 1 - 1e-12;
  const Source* first = nullptr;
  for (const Tap& tap : taps_) {
    if (!tap.begun || tap.at == sources_.end() || !sources_[tap.at].along_tip) continue;
    const Source& source = sources_[tap.at];
    if (first == nullptr) first = &source;
    double cosine = 0;
    for (std::size_t i = 0; i < 3; ++i) cosine += first->direction[i] * source.direction[i];
    if (cosine < kStraight) return true;
  }
  return false;
}

TipFlow PathShaper::flow_at(double t) const {
  TipFlow flow;
  for (const Tap& tap : taps_) {
    if (!tap.begun || tap.at == sources_.end() || !sources_[tap.at].along_tip) continue;
    const Source& source = sources_[tap.at];
    flow.add(tap.weight, source.phase, t - tap.delay_s - source.start_s);
  }
  return flow;
}

/// What evaluate() left open of filament h after now_s_; returns what beads took until then. Gauss and
/// Legendre, three places: exact on straights.
double PathShaper::follow_tip(double h, Knot& end) const {
  constexpr double kAside = 0.387298334620742;
  const TipFlow before = flow_at(now_s_ + (0.5 - kAside) * h), middle = flow_at(now_s_ + 0.5 * h),
                after = flow_at(now_s_ + (0.5 + kAside) * h);
  const double fed = h * (8 * middle.rate() + 5 * (before.rate() + after.rate())) / 18;
  const double apart = h * (8 * middle.apart + 5 * (before.apart + after.apart)) / 18;
  end.x[kE] += knot_.x[kE] - plain_ + fed + apart;
  end.x1[kE] += end.flow.rate() + end.flow.apart;
  end.x2[kE] += end.flow.change() + end.flow.apart1;
  return fed;
}

bool PathShaper::next(Phase& out) {
  if (!moving_) {
    if (!waiting_) return false;
    const Phase first = *std::exchange(waiting_, std::nullopt);
    begin(first);
    append(first, waiting_beads_);
  }
  go_on();
  bool unknown = false, curved = false;
  double turn = std::numeric_limits<double>::infinity();
  for (const Tap& tap : taps_) {
    if (const auto t = turn_of(tap, unknown)) turn = std::min(turn, *t);
    curved = curved || (tap.begun && tap.at != sources_.end() && sources_[tap.at].curved);
  }
  if (unknown || !(turn < std::numeric_limits<double>::infinity())) return false;
  curved = curved || (along_tip_ && bent());
  const Tap& earliest = taps_.front();
  if (earliest.begun && earliest.at != sources_.end()) advance_out_ = sources_[earliest.at].model;

  out = Phase{};
  out.timed = true;
  out.v0 = 1;
  out.line = line();
  out.piece.frame = frame_;
  double h = turn - now_s_;
  if (curved) h /= std::ceil(h / kLongestCurved_s);
  for (;;) {
    Knot end = evaluate(now_s_ + h);
    if (!along_tip_) end.x[kE] += offset_;
    const double plain = end.x[kE];
    const double from = knot_.flow.rate(), to = end.flow.rate();
    const double fed = along_tip_ ? follow_tip(h, end) : 0, mean = fed / h;
    hermite(knot_, end, h, out.piece);
    double missed = 0, missed_flow = 0;
    if (curved)
      for (std::size_t i = 0; i < kPoseAxes; ++i) {
        const double off =
            std::abs(end.x2[i] - 2 * out.piece.coefficients[i][2] - 6 * h * out.piece.coefficients[i][3]);
        missed = std::max(missed, off);
        if (i == kE && along_tip_) missed_flow = off;
      }
    // A cubic Hermite that misses the second derivative at its end by d is off by d h^2 / 32 in the middle.
    const bool holds = missed <= kAccelTolerance && missed * h * h <= 32 * kTolerance &&
                       missed_flow * advance_out_.most_gain() <= kAccelTolerance;
    if (!holds && h > kShortestCurved_s) {
      h /= 2;
      continue;
    }
    beads_out_ = {0, from, (3 * mean - 2 * from - to) / h, (from + to - 2 * mean) / (h * h)};
    if (!holds && along_tip_) {
      // The flow turns about within: one acceleration keeps it within those before and behind.
      end.x[kE] = knot_.x[kE] + 0.5 * h * (knot_.x1[kE] + end.x1[kE]);
      hermite(knot_, end, h, out.piece);
      beads_out_ = {0, from, (to - from) / (2 * h), 0};
    }
    knot_ = end;
    plain_ = plain;
    break;
  }
  out.piece.length = out.duration_s = h;
  now_s_ += h;
  const bool done = ended_ && now_s_ > end_s_ + duration_s() - kSameTime_s;
  if (done) {
    out.last = last_;
    moving_ = false;
    if (along_tip_) offset_ = knot_.x[kE] - stop_[kE];
  }
  return true;
}

}  // namespace kinebus
