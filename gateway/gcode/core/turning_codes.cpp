// G70, G71 and G72: the moves of a subroutine are the profile that is cut.

#include <cmath>
#include <utility>
#include <variant>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::size_t kMostProfileMoves = 5000;
constexpr int kNoteForProfile = 100700;

}  // namespace

bool Core::turning_words(Code code, Turning& turning) {
  const bool finishes = code.number < 710;
  static constexpr std::array kKinds = {Turning::What::kAll, Turning::What::kOutside,
                                        Turning::What::kPockets};
  turning.what = finishes ? Turning::What::kFinish : kKinds[static_cast<std::size_t>(code.number % 10)];
  turning.facing = code.number >= 720;
  const auto take_length = [this](char letter, double& value) {
    if (!has(letter)) return true;
    if (!take(letter, value)) return false;
    value = length(value);
    return value >= 0 || fail(block_.column_of(letter), say("%1 cannot be below 0", std::string(1, letter)));
  };
  if (!take_length('D', turning.allowance_mm)) return false;
  if (finishes) return take_length('E', turning.last_mm) && take_integer('P', 1, 1000, turning.passes);
  if (!take_length('I', turning.depth_mm) || !take_length('R', turning.retract_mm)) return false;
  return turning.depth_mm > 0 ||
         fail(block_.column_of('I'), say("the depth of a cut I must be greater than 0"));
}

bool Core::begin_turning(Code code) {
  ModalState& m = state_.modal;
  const std::string name = g_name(code.number);
  if (profile_.open) return fail(code.column, say("%1 cannot stand in the profile of a cycle", name));
  if (m.cutter != CutterSide::kOff) return refuse_beside_cutter(code, name);
  if (m.plane != Plane::kZx || m.tilted || is_turned())
    return fail(code.column, say("%1 works in the plane of G18, which is not tilted or turned", name));
  if (m.left_out || m.away)
    return fail(code.column, say("%1 cannot stand in an object that is left out", name));
  if (m.inverse_time) return fail(code.column, say("a canned cycle needs feed per minute (G94)"));
  if (!m.feed_known) return fail(code.column, say("no feed rate is set: this move needs F"));
  if (!has('Q'))
    return fail(code.column, say("%1 needs Q, the number of the subroutine that has the profile", name));
  call_ = {};
  call_.what = ProgramCall::What::kProfile;
  call_.column = code.column;
  Profile profile{true, code.column, line_, m, m, {}, {}, {}, {}, false, 0};
  if (!take_integer('Q', 0, 999'999'999, call_.number) || !turning_words(code, profile.turning)) return false;
  Vector3 start = xyz(m.program);
  for (const std::size_t axis : {kAxisX, kAxisZ}) {
    double value = 0;
    if (!has(kAxisLetters[axis])) continue;
    if (!take(kAxisLetters[axis], value)) return false;
    start[axis] = length(value) + (m.incremental ? start[axis] : 0);
  }
  if (!cycle_move(start, true)) return false;
  m.cycle = 0;
  m.motion = Motion::kNone;
  profile.after = m;
  m.motion = Motion::kTraverse;  // how the tool comes to the profile
  profile.start = profile.here = {m.position[kAxisZ], m.position[kAxisX]};
  profile_ = std::move(profile);
  return true;
}

/// Moves that the profile's line has given out are its own.
bool Core::take_profile() {
  const std::size_t from = profile_.from;
  CommandBuffer& out = *out_;
  for (int i = 0; i < block_.m_count; ++i)
    if (m_group(block_.m[static_cast<std::size_t>(i)].number) == MGroup::kStop)
      return fail(1, say("only G0 to G3 can stand in the profile of a cycle"));
  const auto add = [this](const Pose& target, Curve curve) {
    const Pose& start = profile_.after.position;
    if (std::abs(target[kAxisY] - start[kAxisY]) > kNoMotion)
      return fail(1, say("the profile of a cycle lies in the plane of X and Z"));
    for (const Axis axis : {kAxisA, kAxisC, kAxisE})
      if (std::abs(target[axis] - start[axis]) > kNoMotion)
        note(kNoteForProfile, say("A, C and E do not move in the profile of a cycle"));
    if (profile_.moves.size() == kMostProfileMoves)
      return fail(1, say("the profile of a cycle has %1 moves at most", kMostProfileMoves));
    curve.from = profile_.here;
    curve.to = profile_.here = {target[kAxisZ], target[kAxisX]};
    profile_.moves.push_back(curve);
    return true;
  };
  for (std::size_t i = from; i < out.size(); ++i) {
    const canonical::Command& command = out[i].command;
    bool taken = false;
    if (const auto* traverse = std::get_if<canonical::Traverse>(&command)) {
      taken = add(traverse->target, {});
    } else if (const auto* feed = std::get_if<canonical::Feed>(&command)) {
      taken = add(feed->target, {});
    } else if (const auto* arc = std::get_if<canonical::Arc>(&command)) {
      Curve curve;
      curve.arc = true;
      curve.turn = arc->normal[kAxisY] < 0 ? -1 : 1;
      curve.centre = {arc->centre_mm[kAxisZ], arc->centre_mm[kAxisX]};
      curve.radius = length_of(profile_.here - curve.centre);
      curve.sweep = arc->sweep_rad;
      taken = add(arc->target, curve);
    } else {
      fail(1, say("only G0 to G3 can stand in the profile of a cycle"));
    }
    if (!taken) return false;
  }
  out.resize(from);
  return true;
}

bool Core::execute_in_profile(std::string_view line, std::uint32_t line_number, CommandBuffer& out) {
  const ModalState before = state_.modal;
  const std::size_t from = out.size(), moves = profile_.moves.size();
  const Point2 here = profile_.here;
  profile_.from = from;
  profile_.at_work = true;
  // A plain line assigns nothing: what it gives out is taken here, that of others before they assign.
  if (execute(line, line_number, out) && take_profile()) return true;
  state_.modal = before;
  follow_dialect();
  refresh_shift();
  call_ = {};
  out.resize(from);
  profile_.moves.resize(moves);
  profile_.here = here;
  return false;
}

void Core::drop_profile() {
  if (!profile_.open) return;
  state_.modal = profile_.before;
  profile_ = {};
  refresh_shift();
}

bool Core::cut_profile(CommandBuffer& out) {
  const Profile profile = std::exchange(profile_, {});
  ModalState& m = state_.modal;
  m = profile.after;
  refresh_shift();
  out_ = &out;
  line_ = profile.line;
  const auto moves = turn(profile.moves, profile.start, profile.turning);
  if (!moves) return fail(profile.column, moves.error());
  for (const TurningMove& move : *moves) {
    const Curve& curve = move.curve;
    m.position[kAxisZ] = curve.to[0], m.position[kAxisX] = curve.to[1];
    for (const std::size_t axis : {kAxisX, kAxisZ}) m.program[axis] = m.position[axis] - shift_[axis];
    const double feed = m.feed_mm_per_s * m.feed_ratio;
    if (move.traverse) {
      emit(canonical::Traverse{m.position, m.frame, 0});
    } else if (curve.arc) {
      canonical::Arc arc;
      arc.target = m.position;
      arc.frame = m.frame;
      arc.centre_mm = {curve.centre[1], m.position[kAxisY], curve.centre[0]};
      arc.normal[kAxisY] = curve.turn;
      arc.sweep_rad = curve.sweep;
      arc.feed_per_s = feed;
      emit(arc);
    } else {
      emit(canonical::Feed{m.position, m.frame, feed, 0});
    }
    m.motion = move.traverse ? Motion::kTraverse : Motion::kFeed;
    follow_surface(false);
  }
  m.motion = Motion::kNone;
  return true;
}

}  // namespace kinebus::gcode
