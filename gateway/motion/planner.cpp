#include "gateway/motion/planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "gateway/motion/arc_piece.hpp"
#include "gateway/motion/jerk_lookahead.hpp"
#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/path_builder.hpp"
#include "gateway/motion/path_limits.hpp"
#include "gateway/motion/phase_emitter.hpp"

namespace kinebus {
namespace {

// Shorter moves are not moves of their own; what they add up to comes with the next one. 1 nm (or nrad).
constexpr double kShortestMove = 1e-6;
// A move whose rotations or filament dwarf its tool motion is measured by them: s grows at least by this
// share of their dynamically equal length. For table C at 3600 deg/s2 this begins at 2 rad a millimetre.
constexpr double kDwarfs = 0.01;
// Motion added at most until the time ahead is summed up anew.
constexpr double kUnsummed_s = 0.05;

bool finite(const Pose& pose) {
  return std::all_of(pose.begin(), pose.end(), [](double x) { return std::isfinite(x); });
}

double lower(double machine, double asked) {
  return asked > 0 ? std::min(machine, asked) : machine;
}

}  // namespace

struct Planner::Impl {
  Impl(const Kinematics& kinematics, const MotionLimits& machine_limits, Options options)
      : machine(machine_limits),
        limits(machine_limits),
        current(machine_limits),
        lookahead(options.window_pieces, !machine_limits.limits_jerk()),
        path_limits(kinematics, machine_limits, lookahead),
        builder(machine_limits, path_limits, lookahead),
        jerk_lookahead(lookahead) {
    reset_modes();
  }

  void reset_modes() {
    current = limits;
    asked_speed_e = asked_accel_e = 0;
    path_limits.set_limits(current);
    builder.set_limits(current);
    exact = false;
    tolerance_mm = limits.blend_tolerance_mm;
    merge_tolerance_mm = limits.merge_tolerance_mm;
    feed_ratio = 1;
    print_accel = travel_accel = retract_accel = limits.tool_accel_mm_per_s2;
  }

  Result<void, PlanError> fail(PlanError::Kind kind, std::uint32_t line, PoseError pose = {}) {
    failed = PlanError{kind, line, pose};
    has_failed = true;
    return Error<PlanError>(failed);
  }
  Result<void, PlanError> take(const Result<void, PathBuilder::Unreachable>& built) {
    if (built) return {};
    return fail(PlanError::Kind::kPose, built.error().line, built.error().pose);
  }

  Result<void, PlanError> come_to_rest() {
    auto ok = take(builder.close());
    if (ok) lookahead.stop_here();
    return ok;
  }

  Result<void, PlanError> add_straight(const Pose& target, Frame in, double feed, double duration,
                                       bool traverse, std::uint32_t line);
  Result<void, PlanError> add_arc(const canonical::Arc& arc, std::uint32_t line);
  Result<void, PlanError> complete(Move& move, double feed, double duration, double feed_length);
  Result<void, PlanError> set_position(const canonical::SetPosition& set);
  Result<void, PlanError> set_limits(const canonical::Limits& asked);

  Result<void, PlanError> rest_between(bool tool_moves);
  Result<void, PlanError> limit_filament(const FilamentLimits& asked);

  MotionLimits machine;  ///< without what filament is limited to besides
  MotionLimits limits;   ///< the machine's
  FilamentLimits filament;
  double asked_speed_e = 0, asked_accel_e = 0;  ///< of E, by the job; 0: nothing
  bool tool_moved = false;                      ///< in the move added last
  MotionLimits current;                         ///< lowered by the job
  Lookahead lookahead;
  PathLimits path_limits;
  PathBuilder builder;
  PhaseEmitter emitter;
  JerkLookahead jerk_lookahead;
  bool early = false;  ///< plan_known() was called
  Pose end{};
  Frame frame = Frame::kMachine;
  bool exact = false;
  double tolerance_mm = 0, merge_tolerance_mm = 0, feed_ratio = 1;
  double print_accel = 0, travel_accel = 0, retract_accel = 0;
  bool has_failed = false;
  PlanError failed{};
  std::uint64_t phases = 0;
  Counters counters;
  Ahead ahead;            ///< as summed up last, less what was pulled since
  double unsummed_s = 0;  ///< of the moves added since, each from rest to rest
};

Result<void, PlanError> Planner::Impl::add_straight(const Pose& target, Frame in, double feed,
                                                    double duration, bool traverse, std::uint32_t line) {
  if (!finite(target)) return fail(PlanError::Kind::kBadNumber, line);
  if (in != frame) return fail(PlanError::Kind::kFrame, line);
  Pose delta;
  for (std::size_t i = 0; i < kPoseAxes; ++i) delta[i] = target[i] - end[i];
  const double tool = norm_xyz(delta);
  std::size_t dominant = kA;
  double others = 0;
  for (std::size_t i = 3; i < kPoseAxes; ++i) {
    if (std::abs(delta[i]) > std::abs(delta[dominant])) dominant = i;
    if (std::isfinite(limits.axis_accel_per_s2[i])) {
      others =
          std::max(others, std::abs(delta[i]) * limits.tool_accel_mm_per_s2 / limits.axis_accel_per_s2[i]);
    } else {
      others = std::max(others, std::abs(delta[i]));
    }
  }
  const bool tool_motion = tool >= kShortestMove;
  if (!tool_motion && others < kShortestMove) return {};
  if (const auto rested = rest_between(tool_motion); !rested) return rested;

  Move& move = builder.new_move();
  move.length = tool_motion ? std::max(tool, kDwarfs * others) : others;
  for (std::size_t i = 0; i < kPoseAxes; ++i) move.u[i] = delta[i] / move.length;
  move.u_end = move.u;
  move.from = end;
  move.to = target;
  move.arc = false;
  move.tool_motion = tool_motion && move.length == tool;
  move.traverse = traverse;
  move.line = line;
  const bool retracting = delta[kE] < 0 || (!tool_motion && delta[kE] != 0);
  move.accel_mm_per_s2 =
      retracting ? retract_accel : (traverse || delta[kE] == 0 ? travel_accel : print_accel);
  return complete(move, feed, duration, tool_motion ? tool : std::abs(delta[dominant]));
}

Result<void, PlanError> Planner::Impl::add_arc(const canonical::Arc& arc, std::uint32_t line) {
  if (!finite(arc.target)) return fail(PlanError::Kind::kBadNumber, line);
  if (arc.frame != frame) return fail(PlanError::Kind::kFrame, line);
  if (const auto rested = rest_between(true); !rested) return rested;
  Move& move = builder.new_move();
  if (!shape_arc(arc, end, move)) {
    builder.discard_move();
    return fail(PlanError::Kind::kArc, line);
  }
  move.from = end;
  move.to = arc.target;
  move.tool_motion = true;
  move.traverse = false;
  move.line = line;
  move.accel_mm_per_s2 = arc.target[kE] == end[kE] ? travel_accel : print_accel;
  return complete(move, arc.feed_per_s, arc.inverse_time_s, move.length);
}

/// What lines and arcs have in common. `feed_length`: the length that the feed is measured along.
Result<void, PlanError> Planner::Impl::complete(Move& move, double feed, double duration,
                                                double feed_length) {
  if (move.traverse) {
    const bool slower = limits.traverse_mm_per_s < limits.tool_speed_mm_per_s && norm_xyz(move.u) > 0;
    const double ratio = move.length / feed_length;
    move.speed = slower ? limits.traverse_mm_per_s * ratio : kUnlimited;
    if (feed > 0) move.speed = std::min(move.speed, feed * ratio);
  } else if (duration > 0) {
    move.speed = move.length / duration * feed_ratio;
  } else {
    move.speed = feed * feed_ratio * move.length / feed_length;
  }
  if (!(move.speed > 0)) {
    builder.discard_move();
    return fail(PlanError::Kind::kBadNumber, move.line);
  }
  move.exact = exact;
  move.tolerance_mm = tolerance_mm;
  move.merge_tolerance_mm = merge_tolerance_mm;
  move.frame = frame;
  end = move.to;
  const double v = std::min(move.speed, limits.tool_speed_mm_per_s), a = move.accel_mm_per_s2;
  unsummed_s += move.length * a > v * v ? move.length / v + v / a : 2 * std::sqrt(move.length / a);
  return take(builder.move_added());
}

/// Before a move of the tool that comes after filament alone, or the other way round.
Result<void, PlanError> Planner::Impl::rest_between(bool tool_moves) {
  const bool same = std::exchange(tool_moved, tool_moves) == tool_moves;
  if (!filament.rests || same || builder.empty()) return {};
  return come_to_rest();
}

Result<void, PlanError> Planner::Impl::limit_filament(const FilamentLimits& asked) {
  auto ok = come_to_rest();
  if (asked == filament) return ok;
  filament = asked;
  const auto apply = [&](MotionLimits& to, const MotionLimits& from) {
    to.axis_speed_per_s[kE] = std::min(from.axis_speed_per_s[kE], filament.speed_mm_per_s);
    to.axis_accel_per_s2[kE] = std::min(from.axis_accel_per_s2[kE], filament.accel_mm_per_s2);
    to.flow_accel_mm_per_s2 = std::min(from.flow_accel_mm_per_s2, filament.flow_accel_mm_per_s2);
    to.flow_jerk_mm_per_s3 = std::min(from.flow_jerk_mm_per_s3, filament.flow_jerk_mm_per_s3);
  };
  limits = machine;
  apply(limits, machine);
  const double speed = asked_speed_e > 0 ? asked_speed_e : kUnlimited;
  const double accel = asked_accel_e > 0 ? asked_accel_e : kUnlimited;
  current.axis_speed_per_s[kE] = std::min(limits.axis_speed_per_s[kE], speed);
  current.axis_accel_per_s2[kE] = std::min(limits.axis_accel_per_s2[kE], accel);
  current.flow_accel_mm_per_s2 = limits.flow_accel_mm_per_s2;
  current.flow_jerk_mm_per_s3 = limits.flow_jerk_mm_per_s3;
  path_limits.set_limits(current);
  builder.set_limits(current);
  return ok;
}

Result<void, PlanError> Planner::Impl::set_position(const canonical::SetPosition& set) {
  if (set.pose == end && set.frame == frame) return {};
  auto ok = come_to_rest();
  end = set.pose;
  frame = set.frame;
  return ok;
}

Result<void, PlanError> Planner::Impl::set_limits(const canonical::Limits& asked) {
  if (asked.print_accel_mm_per_s2 > 0)
    print_accel = lower(limits.tool_accel_mm_per_s2, asked.print_accel_mm_per_s2);
  if (asked.travel_accel_mm_per_s2 > 0) {
    travel_accel = lower(limits.tool_accel_mm_per_s2, asked.travel_accel_mm_per_s2);
  }
  if (asked.retract_accel_mm_per_s2 > 0) {
    retract_accel = lower(limits.tool_accel_mm_per_s2, asked.retract_accel_mm_per_s2);
  }
  if (asked.axis_speed_per_s[kE] > 0) asked_speed_e = asked.axis_speed_per_s[kE];
  if (asked.axis_accel_per_s2[kE] > 0) asked_accel_e = asked.axis_accel_per_s2[kE];
  MotionLimits changed = current;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    if (asked.axis_speed_per_s[i] > 0) {
      changed.axis_speed_per_s[i] = lower(limits.axis_speed_per_s[i], asked.axis_speed_per_s[i]);
    }
    if (asked.axis_accel_per_s2[i] > 0) {
      changed.axis_accel_per_s2[i] = lower(limits.axis_accel_per_s2[i], asked.axis_accel_per_s2[i]);
    }
  }
  if (changed.axis_speed_per_s == current.axis_speed_per_s &&
      changed.axis_accel_per_s2 == current.axis_accel_per_s2) {
    return {};
  }
  // Axis limits hold for what comes after them: the path rests in between, which jobs do only before they
  // begin.
  auto ok = come_to_rest();
  current = changed;
  path_limits.set_limits(current);
  builder.set_limits(current);
  return ok;
}

Planner::Planner(const Kinematics& kinematics, const MotionLimits& limits)
    : Planner(kinematics, limits, Options{}) {}
Planner::Planner(const Kinematics& kinematics, const MotionLimits& limits, Options options)
    : impl_(std::make_unique<Impl>(kinematics, limits, options)) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

Result<void, PlanError> Planner::add(const canonical::Line& line) {
  Impl& d = *impl_;
  if (d.has_failed) return Error<PlanError>(d.failed);
  if (const auto* feed = std::get_if<canonical::Feed>(&line.command)) {
    return d.add_straight(feed->target, feed->frame, feed->feed_per_s, feed->inverse_time_s, false,
                          line.line);
  }
  if (const auto* traverse = std::get_if<canonical::Traverse>(&line.command)) {
    return d.add_straight(traverse->target, traverse->frame, traverse->speed_per_s, 0, true, line.line);
  }
  if (const auto* arc = std::get_if<canonical::Arc>(&line.command)) return d.add_arc(*arc, line.line);
  if (const auto* mode = std::get_if<canonical::PathMode>(&line.command)) {
    d.exact = mode->exact;
    d.tolerance_mm = mode->exact
                         ? d.limits.exact_tolerance_mm
                         : (mode->tolerance_mm > 0 ? mode->tolerance_mm : d.limits.blend_tolerance_mm);
    d.merge_tolerance_mm = !mode->merge                   ? 0
                           : mode->merge_tolerance_mm > 0 ? mode->merge_tolerance_mm
                                                          : d.limits.merge_tolerance_mm;
    return {};
  }
  if (const auto* set = std::get_if<canonical::SetPosition>(&line.command)) return d.set_position(*set);
  if (const auto* asked = std::get_if<canonical::Limits>(&line.command)) return d.set_limits(*asked);
  if (const auto* ratio = std::get_if<canonical::Override>(&line.command)) {
    if (ratio->feed > 0) d.feed_ratio = ratio->feed;
  }
  return {};
}

Result<void, PlanError> Planner::limit_filament(const FilamentLimits& limits) {
  if (impl_->has_failed) return Error<PlanError>(impl_->failed);
  return impl_->limit_filament(limits);
}

Result<void, PlanError> Planner::finish() {
  if (impl_->has_failed) return Error<PlanError>(impl_->failed);
  auto ok = impl_->come_to_rest();
  if (ok) impl_->lookahead.finish();
  return ok;
}

void Planner::plan_known() {
  impl_->lookahead.plan_known();
  impl_->early = true;
}

Planner::Ahead Planner::ahead() {
  Impl& d = *impl_;
  if (d.unsummed_s > kUnsummed_s || idle()) {
    const Lookahead::Ahead pieces = d.limits.limits_jerk() ? d.jerk_lookahead.ahead() : d.lookahead.ahead();
    const double given = d.emitter.left_s();
    d.ahead.final_s = given + pieces.final_s;
    d.ahead.all_s = given + pieces.all_s + d.builder.open_s(d.limits.tool_speed_mm_per_s);
    d.unsummed_s = 0;
  }
  return {std::max(0.0, d.ahead.final_s), std::max(0.0, d.ahead.all_s) + d.unsummed_s};
}

bool Planner::wants_more() const {
  return !impl_->lookahead.full();
}

bool Planner::next(Phase& phase) {
  Impl& d = *impl_;
  if (d.limits.limits_jerk()) {
    if (!d.jerk_lookahead.next(phase, std::exchange(d.early, false))) return false;
  } else {
    while (!d.emitter.next(phase)) {
      Lookahead::Step step;
      if (!d.lookahead.take(step)) return false;
      d.emitter.start(step);
    }
  }
  ++d.phases;
  d.ahead.final_s -= phase.duration_s;
  d.ahead.all_s -= phase.duration_s;
  return true;
}

bool Planner::idle() const {
  return impl_->lookahead.empty() && impl_->emitter.empty() && impl_->builder.empty();
}
const Pose& Planner::end_pose() const {
  return impl_->end;
}
Frame Planner::end_frame() const {
  return impl_->frame;
}

void Planner::limit_machine(const MotionLimits& limits) {
  impl_->machine = impl_->limits = limits;
  impl_->filament = {};
}

void Planner::reset(const Pose& pose, Frame frame) {
  impl_->lookahead.clear();
  impl_->jerk_lookahead.clear();
  impl_->early = false;
  impl_->builder.clear();
  impl_->emitter.clear();
  impl_->has_failed = false;
  impl_->end = pose;
  impl_->frame = frame;
  impl_->ahead = {};
  impl_->unsummed_s = 0;
  impl_->reset_modes();
}

const Planner::Counters& Planner::counters() const {
  const auto& built = impl_->builder.counters();
  impl_->counters = {built.moves,   built.merged,
                     built.blends,  impl_->lookahead.added(),
                     impl_->phases, impl_->lookahead.forced() + impl_->jerk_lookahead.forced()};
  return impl_->counters;
}

}  // namespace kinebus
