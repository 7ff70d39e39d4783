// Threads: G33, G33.1, and G76 as LinuxCNC has it. The moves go with the spindle's angle
// (canonical::SpindleSync).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

// Path time can be slower than planned, not faster: a spindle may turn so much faster than it is told.
constexpr double kFasterThanTold = 1.1;
// A thread is some tens of passes; more are a slip of the decimal point.
constexpr double kMostPasses = 1000;
constexpr int kMostAngle_deg = 80;

}  // namespace

bool Core::may_thread(Code code, const std::string& name) {
  const ModalState& m = state_.modal;
  if (!options_.spindle_encoder) return fail(code.column, unknown_g(code.number));
  if (m.cutter != CutterSide::kOff) return refuse_beside_cutter(code, name);
  if (m.left_out || m.away)
    return fail(code.column, say("%1 cannot stand in an object that is left out", name));
  if (m.surface_speed) return fail(code.column, say("%1 needs a spindle of even speed: G97 first", name));
  if (m.spindle_turns == 0 || !(m.spindle_rpm > 0))
    return fail(code.column, say("%1 needs the spindle to turn (%2)", name, "M3"));
  return true;
}

void Core::begin_thread(double pitch_mm) {
  const double rpm = state_.modal.spindle_rpm * kFasterThanTold;
  emit(canonical::SpindleSync{rpm, pitch_mm * rpm / 60});
}

void Core::end_thread() {
  if (std::exchange(state_.modal.thread_mm, 0) > 0) emit(canonical::SpindleSync{});
}

/// K, and X Y Z: where the thread ends, program coordinates.
bool Core::thread_target(Code code, const std::string& name, double& pitch_mm, Vector3& point) {
  const ModalState& m = state_.modal;
  if (!has('K')) return fail(code.column, say("%1 needs K, the way of a turn", name));
  if (!take('K', pitch_mm)) return false;
  pitch_mm = length(pitch_mm);
  if (!(pitch_mm > 0)) return fail(block_.column_of('K'), say("the way of a turn K must be greater than 0"));
  for (const char letter : {'A', 'C', 'E'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 has no place in a thread", letter));
  point = xyz(m.program);
  for (const std::size_t axis : {kAxisX, kAxisY, kAxisZ}) {
    double value = 0;
    if (!has(kAxisLetters[axis])) continue;
    if (!take(kAxisLetters[axis], value)) return false;
    point[axis] = length(value) + (m.incremental ? point[axis] : 0);
  }
  return norm(to_canonical_xyz(point) - xyz(m.position)) > kNoMotion ||
         fail(code.column, say("%1 needs X, Y or Z, where the thread ends", name));
}

bool Core::thread(Code code) {
  ModalState& m = state_.modal;
  double pitch = 0;
  Vector3 point{};
  if (!may_thread(code, "G33") || !thread_target(code, "G33", pitch, point)) return false;
  if (m.thread_mm == 0) begin_thread(pitch);
  // Another pitch goes on with the same angle, as where the tool comes out along a slope.
  m.thread_mm = pitch;
  return thread_move(point, pitch);
}

bool Core::rigid_tap(Code code) {
  const ModalState& m = state_.modal;
  if (!(options_.tap_rpm_per_s > 0)) return fail(code.column, unknown_g(code.number));
  double pitch = 0, faster = 1;
  Vector3 point{};
  if (!may_thread(code, "G33.1") || !thread_target(code, "G33.1", pitch, point)) return false;
  if (!take_if_given('I', faster)) return false;
  if (faster > 1)
    return fail(block_.column_of('I'), say("I of G33.1 is 1 at most: the way out is as fast as the way in"));
  if (!m.exact_path) emit(canonical::PathMode{true, 0, 0, true});
  if (!tap(point, xyz(m.program), pitch)) return false;
  if (!m.exact_path) emit(path_mode());
  return true;
}

bool Core::taps_rigidly() const {
  const ModalState& m = state_.modal;
  return options_.tap_rpm_per_s > 0 && !m.surface_speed && !m.left_out && !m.away;
}

bool Core::tap(const Vector3& bottom, const Vector3& clear, double pitch_mm) {
  const ModalState& m = state_.modal;
  const double rpm = m.spindle_rpm * kFasterThanTold;
  const double deep = norm(to_canonical_xyz(bottom) - xyz(m.position));
  emit(canonical::SpindleSync{rpm, pitch_mm * rpm / 60, deep});
  if (!thread_move(bottom, pitch_mm) || !thread_move(clear, pitch_mm)) return false;
  emit(canonical::SpindleSync{});
  emit(canonical::Spindle{m.spindle_turns * m.spindle_rpm});
  return true;
}

bool Core::thread_move(const Vector3& program, double pitch_mm) {
  ModalState& m = state_.modal;
  set_xyz(m.program, program);
  set_xyz(m.position, to_canonical_xyz(program));
  emit(canonical::Feed{m.position, m.frame, pitch_mm * m.spindle_rpm * kFasterThanTold / 60, 0});
  return true;
}

/// Lengths in mm; what is along X counts from the drive line outwards, below 0 into an outside thread.
struct Core::ThreadCycle {
  double pitch = 0, end = 0;
  double crest = 0, first = 0, height = 0;  ///< I, J, K
  double degression = 1, angle_rad = 0, taper = 0;
  int spring_passes = 0, tapers = 0;
};

bool Core::thread_words(Code code, ThreadCycle& cycle) {
  const ModalState& m = state_.modal;
  for (const char letter : {'P', 'Z', 'I', 'J', 'K'})
    if (!has(letter))
      return fail(code.column, say("G76 needs %1 as P Z I J K: pitch, end, crest, first cut, height of the "
                                   "thread",
                                   std::string(1, letter)));
  for (const char letter : {'X', 'Y', 'A', 'C'})
    if (has(letter)) return fail(block_.column_of(letter), say("%1 has no place in a thread", letter));
  const auto take_length = [this](char letter, double& value) {
    if (!take_if_given(letter, value)) return false;
    value = length(value);
    return true;
  };
  if (!take_length('P', cycle.pitch) || !take_length('Z', cycle.end) || !take_length('I', cycle.crest) ||
      !take_length('J', cycle.first) || !take_length('K', cycle.height) || !take_length('E', cycle.taper) ||
      !take_if_given('R', cycle.degression) || !take_if_given('Q', cycle.angle_rad) ||
      !take_integer('H', 0, 100, cycle.spring_passes) || !take_integer('L', 0, 3, cycle.tapers))
    return false;
  if (m.incremental) cycle.end += m.program[kAxisZ];
  for (const auto& [letter, value] :
       {std::pair{'P', cycle.pitch}, std::pair{'J', cycle.first}, std::pair{'K', cycle.height}})
    if (!(value > 0))
      return fail(block_.column_of(letter), say("%1 must be greater than 0", std::string(1, letter)));
  if (cycle.crest == 0)
    return fail(block_.column_of('I'),
                say("I of G76 says on which side the thread is: below 0 outside, above "
                    "0 inside"));
  if (!(cycle.degression >= 1)) return fail(block_.column_of('R'), say("R of G76 is at least 1"));
  if (!(cycle.angle_rad >= 0 && cycle.angle_rad <= kMostAngle_deg))
    return fail(block_.column_of('Q'), say("Q of G76 is 0 to %1 degrees", kMostAngle_deg));
  cycle.angle_rad *= std::numbers::pi / 180;
  if (cycle.taper < 0) return fail(block_.column_of('E'), say("%1 cannot be below 0", "E"));
  if (cycle.tapers != 0 && cycle.taper == 0)
    return fail(block_.column_of('L'), say("L of G76 needs E, how long a taper is"));
  if (std::pow(cycle.height / cycle.first, cycle.degression) + cycle.spring_passes > kMostPasses)
    return fail(block_.column_of('J'), say("the first cut J is far too small for this thread"));
  const double way = std::abs(cycle.end - m.program[kAxisZ]);
  const int tapers = (cycle.tapers & 1) + cycle.tapers / 2;
  if (!(way > tapers * cycle.taper))
    return fail(block_.column_of('Z'), say("the thread of G76 has no length from here to Z"));
  return true;
}

/// From the drive line: back along Z to where the pass begins, in, along, out.
bool Core::thread_pass(const ThreadCycle& cycle, const Vector3& start, double depth) {
  const double out = cycle.crest > 0 ? 1 : -1, along = cycle.end > start[kAxisZ] ? 1 : -1;
  const double flank = std::tan(cycle.angle_rad) * along;
  const double shift = (depth - std::abs(cycle.crest)) * flank;
  const double end = cycle.end - cycle.height * flank + shift;
  const auto at = [&](double x, double z) { return Vector3{x, start[kAxisY], z}; };
  const double clear = start[kAxisX], cut = clear + out * depth, outside = cut - out * cycle.height;
  const double begin = start[kAxisZ] + shift, taper = along * cycle.taper;
  const bool in = (cycle.tapers & 1) != 0, leaves = (cycle.tapers & 2) != 0;
  // The pitch is that along Z.
  const double sloped = in || leaves ? cycle.pitch * std::hypot(taper, cycle.height) / cycle.taper : 0;
  if (!cycle_move(at(clear, begin), true) || !cycle_move(at(in ? outside : cut, begin), true)) return false;
  begin_thread(in ? std::min(sloped, cycle.pitch) : cycle.pitch);
  if (in && !thread_move(at(cut, begin + taper), sloped)) return false;
  if (!thread_move(at(cut, end - (leaves ? taper : 0)), cycle.pitch)) return false;
  if (leaves && !thread_move(at(outside, end), sloped)) return false;
  emit(canonical::SpindleSync{});
  return cycle_move(at(clear, end), true);
}

bool Core::threading_cycle(Code code) {
  ModalState& m = state_.modal;
  if (!may_thread(code, "G76")) return false;
  if (m.plane != Plane::kZx || m.tilted || is_turned())
    return fail(code.column, say("%1 works in the plane of G18, which is not tilted or turned", "G76"));
  ThreadCycle cycle;
  if (!thread_words(code, cycle)) return false;
  m.motion = Motion::kNone;
  m.cycle = 0;
  const Vector3 start = xyz(m.program);
  const double crest = std::abs(cycle.crest), full = crest + cycle.height;
  // Each pass takes as much of the flanks as the one before where the degression is 2.
  const auto depth_of = [&](int pass) { return crest + cycle.first * std::pow(pass, 1 / cycle.degression); };
  for (int pass = 1; depth_of(pass) < full; ++pass)
    if (!thread_pass(cycle, start, depth_of(pass))) return false;
  for (int pass = 0; pass <= cycle.spring_passes; ++pass)
    if (!thread_pass(cycle, start, full)) return false;
  return cycle_move({start[kAxisX], start[kAxisY], cycle.end}, true);
}

}  // namespace kinebus::gcode
