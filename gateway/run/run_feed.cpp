#include "gateway/run/run_feed.hpp"

#include <algorithm>
#include <iterator>

namespace kinebus {
namespace {

/// From the naming of a run's START to path time: knots lie on a 16 us grid, and START must lie ahead of tau.
constexpr PathTime kStartLead = std::chrono::milliseconds{1};
/// Less than this of a phase is as good as none: at 450 mm/s 0.45 um.
constexpr double kNothing_s = 1e-6;
/// Slower than this is rest: what the planner's rounding may leave of a stop, mm/s.
constexpr double kRestSpeed = 1e-3;

PathTime after(PathTime start, double seconds) {
  return start + PathTime{static_cast<std::int64_t>(seconds * 16e6)};
}

}  // namespace

void RunFeed::reset() {
  originals_.clear();
  pieces_.clear();
  first_ = 0;
  next_ = at_piece_ = 0;
  next_from_s_ = 0;
  passed_.reset();
  ramp_.start(0);
  ramp_s_ = fed_s_ = job_s_ = extruder_shift_mm_ = 0;
  streaming_ = released_ = replaying_ = false;
  begun_.reset();
}

Phase RunFeed::shifted(Phase phase) const {
  phase.piece.coefficients[kE][0] += extruder_shift_mm_;
  return phase;
}

void RunFeed::add(const Phase& phase) {
  if (replaying_) return replay(phase);
  originals_.push_back({phase, job_s_});
  job_s_ += phase.duration_s;
}

bool RunFeed::wants_phase(PathTime tau) const {
  return !pending() && (!streaming_ || !released_ || group_.wants_phases(tau));
}

double RunFeed::pending_s() const {
  double pending = -next_from_s_;
  for (std::size_t i = next_; i < originals_.size(); ++i) pending += originals_[i].phase.duration_s;
  for (std::size_t i = at_piece_; i < pieces_.size(); ++i) pending += pieces_[i].phase.duration_s;
  return std::max(0.0, pending);
}

void RunFeed::begin_run() {
  run_.from = {first_ + next_, next_from_s_};
  const bool moves = originals_[next_].phase.pose_speed(next_from_s_) > kRestSpeed;
  run_.ramp_s = moves ? ramp_s_ : 0;
  ramp_.start(run_.ramp_s);
  fed_s_ = 0;
  group_.begin_run();
  streaming_ = true;
  released_ = false;
}

/// The next original becomes pieces.
void RunFeed::cut_next() {
  const Phase& phase = originals_[next_].phase;
  const std::uint64_t ordinal = first_ + next_;
  const bool ramped = ramp_.active();
  double from_s = std::exchange(next_from_s_, 0);
  cut_.clear();
  if (!ramped && from_s == 0)
    cut_.push_back(phase);
  else
    ramp_.apply(phase, from_s, cut_);
  ++next_;
  for (Phase& part : cut_) {
    pieces_.push_back({run_.start, fed_s_, ordinal, from_s, ramped, shifted(part)});
    fed_s_ += part.duration_s;
  }
}

Result<void, StreamError> RunFeed::pump(PathTime tau) {
  for (;;) {
    if (at_piece_ == pieces_.size()) {
      if (next_ == originals_.size()) return {};
      if (!streaming_) begin_run();
      cut_next();
      continue;
    }
    if (released_ && !group_.wants_phases(tau)) return {};
    Piece& piece = pieces_[at_piece_];
    if (auto pushed = group_.push(piece.phase); !pushed) return pushed;
    if (!std::exchange(released_, true)) {
      group_.release(tau + kStartLead);
      run_.start = group_.run_start();
      begun_ = run_;
    }
    piece.start = run_.start;
    ++at_piece_;
  }
}

void RunFeed::end_run() {
  streaming_ = released_ = false;
  ramp_s_ = 0;
}

// Places
// -------------------------------------------------------------------------------------------------------

PathTime RunFeed::end_of(const Piece& piece) {
  return after(piece.start, piece.start_s + piece.phase.duration_s);
}

const RunFeed::Piece* RunFeed::covering(PathTime tau) const {
  const auto end = pieces_.begin() + static_cast<std::ptrdiff_t>(at_piece_);
  const auto found = std::upper_bound(pieces_.begin(), end, tau, [](PathTime t, const Piece& piece) {
    return t < after(piece.start, piece.start_s);
  });
  return found == pieces_.begin() ? nullptr : &*std::prev(found);
}

double RunFeed::original_time(const Piece& piece, double into_s) const {
  if (!piece.ramped) return piece.from_s + into_s;
  return time_at(original(piece.ordinal).phase, piece.phase.s(into_s));
}

JobPlace RunFeed::place(PathTime tau) const {
  if (!streaming_) return {first_ + next_, pending() ? next_from_s_ : 0};
  const Piece* piece = covering(tau);
  if (piece == nullptr || piece->ordinal < run_.from.phase) return run_.from;
  const double into_s = to_seconds(tau - piece->start) - piece->start_s;
  return {piece->ordinal, original_time(*piece, std::clamp(into_s, 0.0, piece->phase.duration_s))};
}

std::optional<PathTime> RunFeed::start_of(std::uint64_t phase) const {
  const auto end = pieces_.begin() + static_cast<std::ptrdiff_t>(at_piece_);
  const auto found =
      std::lower_bound(pieces_.begin(), end, phase,
                       [](const Piece& piece, std::uint64_t wanted) { return piece.ordinal < wanted; });
  if (!streaming_ || found == end || found->ordinal != phase) return std::nullopt;
  return after(found->start, found->start_s);
}

double RunFeed::done_s(PathTime tau) const {
  const JobPlace here = place(tau);
  if (here.phase >= added() || here.phase < first_) return job_s_;
  return original(here.phase).job_s + here.phase_s;
}

void RunFeed::drop_first() {
  passed_ = originals_.front().phase;
  originals_.pop_front();
  ++first_;
  if (next_ > 0) --next_;
}

void RunFeed::forget_before(PathTime tau) {
  while (at_piece_ > 1 && end_of(pieces_.front()) < tau) {
    pieces_.pop_front();
    --at_piece_;
  }
  while (at_piece_ > 0 && first_ < pieces_.front().ordinal) drop_first();
}

std::optional<PosePoint> RunFeed::pose(PathTime tau, Frame& frame, std::uint32_t& line) const {
  const Piece* piece = covering(tau);
  if (piece == nullptr) return std::nullopt;
  const double into_s = to_seconds(tau - piece->start) - piece->start_s;
  if (into_s > piece->phase.duration_s + 1e-6) return std::nullopt;
  frame = piece->phase.piece.frame;
  line = piece->phase.line;
  return piece->phase.at(std::clamp(into_s, 0.0, piece->phase.duration_s));
}

// Interruption
// -------------------------------------------------------------------------------------------------

void RunFeed::suspend(PathTime tau) {
  if (streaming_) keep_from(place(tau));
  streaming_ = released_ = false;
  begun_.reset();
}

void RunFeed::cut() {
  keep_from({added(), 0});
  passed_.reset();
  streaming_ = released_ = false;
  ramp_s_ = 0;
  begun_.reset();
}

void RunFeed::keep_from(const JobPlace& place) {
  while (!originals_.empty() && first_ < place.phase) drop_first();
  pieces_.clear();
  at_piece_ = next_ = 0;
  next_from_s_ = originals_.empty() ? 0 : place.phase_s;
  if (!originals_.empty() && originals_.front().phase.duration_s - next_from_s_ < kNothing_s) {
    drop_first();
    next_from_s_ = 0;
  }
}

bool RunFeed::rest_pose(Pose& pose, Frame& frame, std::uint32_t& line) const {
  const bool ahead = next_ < originals_.size();
  if (!ahead && !passed_ && originals_.empty()) return false;
  const Phase phase = shifted(ahead                ? originals_[next_].phase
                              : originals_.empty() ? *passed_
                                                   : originals_.back().phase);
  pose = phase.piece.evaluate(phase.s(ahead ? next_from_s_ : phase.duration_s)).x;
  frame = phase.piece.frame;
  line = phase.line;
  return true;
}

// Replay
// -------------------------------------------------------------------------------------------------------

void RunFeed::replay_to(const JobPlace& place) {
  reset();
  replaying_ = true;
  replays_run_ = false;
  replay_place_ = place;
}

void RunFeed::replay_to(const Run& run, PathTime target) {
  replay_to(run.from);
  replays_run_ = true;
  replay_target_ = target;
  run_ = run;
  ramp_.start(run.ramp_s);
}

void RunFeed::replay(const Phase& phase) {
  originals_.push_back({phase, job_s_});
  job_s_ += phase.duration_s;
  if (added() <= replay_place_.phase) return drop_first();
  if (!replays_run_) {
    replaying_ = false;
    return keep_from(replay_place_);
  }
  if (added() == replay_place_.phase + 1) next_from_s_ = replay_place_.phase_s;
  next_ = originals_.size() - 1;
  cut_next();
  at_piece_ = pieces_.size();
  const bool reached = after(run_.start, fed_s_) > replay_target_;
  if (!reached && !phase.last) return forget_before(replay_target_);
  replaying_ = false;
  streaming_ = true;
  if (reached)
    suspend(replay_target_);
  else
    end_replay();
}

void RunFeed::skip_to(std::uint64_t phases) {
  keep_from({added(), 0});
  passed_.reset();
  first_ = std::max(first_, phases);
}

void RunFeed::end_replay() {
  keep_from({added(), 0});
  replaying_ = streaming_ = released_ = false;
}

}  // namespace kinebus
