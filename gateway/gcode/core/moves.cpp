// G0 to G3, G53 and retraction.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/curves/arc.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::uint32_t bits(std::string_view letters) {
  std::uint32_t result = 0;
  for (const char c : letters) result |= Block::bit(c);
  return result;
}
constexpr int kNoteForLevelling = 100800;
constexpr std::uint32_t kLinear = bits("XYZ"), kTurning = bits("AC"), kAllAxes = bits("XYZACE");
constexpr std::uint32_t kCentreWords = bits("IJKR");

constexpr std::array<char, 3> kCentreLetters = {'I', 'J', 'K'};

Motion motion_of(int g_tenths) {
  switch (g_tenths) {
    case 0:
      return Motion::kTraverse;
    case 10:
      return Motion::kFeed;
    case 20:
      return Motion::kArcClockwise;
    case 30:
      return Motion::kArcCounterclockwise;
    default:
      return Motion::kNone;
  }
}

}  // namespace

Core::PlaneAxes Core::plane_axes() const {
  switch (state_.modal.plane) {
    case Plane::kXy:
      return {kAxisX, kAxisY, kAxisZ};
    case Plane::kZx:
      return {kAxisZ, kAxisX, kAxisY};
    case Plane::kYz:
      return {kAxisY, kAxisZ, kAxisX};
  }
  return {kAxisX, kAxisY, kAxisZ};
}

bool Core::run_motion() {
  ModalState& m = state_.modal;
  if (has_polar() && !polar_words()) [[unlikely]]
    return false;
  const bool spline_before = std::exchange(m.spline, false);
  if (m.nurbs != 0) return run_nurbs();
  const bool machine_coordinates =
      block_.has(GGroup::kNonmodal) && block_.code(GGroup::kNonmodal).number == 530;
  if (block_.has(GGroup::kMotion)) {
    const Code code = block_.code(GGroup::kMotion);
    m.motion = motion_of(code.number);
    if (machine_coordinates &&
        (code.number == kThread || code.number == kRigidTap || code.number == kThreadingCycle))
      return fail(block_.code(GGroup::kNonmodal).column, say("G53 needs G0 or G1, in this line or active"));
    if (code.number == 52 || code.number == 53 || code.number == 62) return run_nurbs();
    if (code.number == 50 || code.number == 51) {
      if (m.cutter != CutterSide::kOff) return refuse_beside_cutter(code, g_name(code.number));
      m.cycle = 0;
      m.spline = spline_before;
      return run_spline(code);
    }
    if (code.number == kThread) return thread(code);
    if (code.number == kRigidTap) return rigid_tap(code);
    if (code.number == kThreadingCycle) return threading_cycle(code);
    if (code.number >= 700 && code.number < 730) return begin_turning(code);
    if (code.number < 730 || code.number == 800) m.cycle = 0;
    if (code.number >= 380 && code.number < 390)
      return m.cutter == CutterSide::kOff ? probe(code) : refuse_beside_cutter(code, g_name(code.number));
    if (code.number == 800 && (block_.present & bits("WH")) != 0) {
      // Printers level the named part of the bed.
      used_ |= block_.present & bits("XYWHNPC");
      note(kNoteForLevelling, say("%1 has no effect on this machine", "G80 X Y W H"));
      return true;
    }
  }
  if (m.cycle != 0 || (block_.has(GGroup::kMotion) && block_.code(GGroup::kMotion).number >= 730)) {
    if (machine_coordinates)
      return fail(block_.code(GGroup::kNonmodal).column, say("G53 needs G0 or G1, in this line or active"));
    if (!block_.has(GGroup::kMotion) || block_.code(GGroup::kMotion).number != 800) {
      if (m.cutter != CutterSide::kOff &&
          (block_.has(GGroup::kMotion) || (block_.present & ~used_ & kLinear) != 0))
        return refuse_beside_cutter(block_.code(GGroup::kMotion),
                                    g_name(m.cycle != 0 ? m.cycle : block_.code(GGroup::kMotion).number));
      return run_cycle();
    }
  }
  const bool clockwise = m.motion == Motion::kArcClockwise;
  const bool is_arc = clockwise || m.motion == Motion::kArcCounterclockwise;
  if (machine_coordinates) return run_machine_coordinates();

  const std::uint32_t words = block_.present & ~used_;
  if (is_arc && ((words & (kAllAxes | kCentreWords)) != 0 || block_.has(GGroup::kMotion)))
    return run_arc(clockwise);
  if (m.motion == Motion::kTraverse && traverse_has_feed_ && block_.has('F')) m.traverse_limited = true;
  if (is_arc || m.motion == Motion::kNone || (words & kAllAxes) == 0) return true;
  for (const char letter : kAxisLetters)
    if ((words & block_.bare & Block::bit(letter)) != 0)
      return fail(block_.column_of(letter), say("%1 needs a number", letter));
  return run_straight(m.motion == Motion::kTraverse);
}

void Core::program_target(Pose& program) const {
  const ModalState& m = state_.modal;
  const std::uint32_t words = block_.present & ~used_;
  const double unit = m.inches ? 25.4 : 1.0;
  const auto put = [&](char letter, Axis axis, double scale, bool incremental) {
    if ((words & Block::bit(letter)) == 0) return;
    const double value = block_[letter] * scale;
    program[axis] = incremental ? program[axis] + value : value;
  };
  put('X', kAxisX, unit, m.incremental);
  put('Y', kAxisY, unit, m.incremental);
  put('Z', kAxisZ, unit, m.incremental);
  put('E', kAxisE, unit, m.incremental_e);
  if ((words & kTurning) != 0) {
    put('A', kAxisA, std::numbers::pi / 180, m.incremental);
    put('C', kAxisC, std::numbers::pi / 180, m.incremental);
  }
}

bool Core::check_turning() {
  const ModalState& m = state_.modal;
  if (!m.tilted || m.plane_rotation || m.tool_centre_point || (block_.present & ~used_ & kTurning) == 0)
    return true;
  const char letter = block_.has('A') ? 'A' : 'C';
  return fail(block_.column_of(letter), say("in a tilted plane A and C turn only under G43.4, or by G53.1"));
}

bool Core::run_straight(bool traverse) {
  const ModalState& m = state_.modal;
  if (!check_turning()) return false;
  Pose program = m.program;
  program_target(program);
  Pose target = m.position;
  // Axes without a word keep their very value: adding the shift again could change the last bit.
  const std::uint32_t words = block_.present & ~used_;
  if (m.tilted || is_turned()) {
    if ((words & kLinear) != 0) set_xyz(target, to_canonical_xyz(xyz(program)));
  } else {
    if ((words & Block::bit('X')) != 0) target[kAxisX] = program[kAxisX] + shift_[kAxisX];
    if ((words & Block::bit('Y')) != 0) target[kAxisY] = program[kAxisY] + shift_[kAxisY];
    if ((words & Block::bit('Z')) != 0) target[kAxisZ] = program[kAxisZ] + shift_[kAxisZ];
  }
  if ((words & Block::bit('A')) != 0) target[kAxisA] = program[kAxisA] + shift_[kAxisA];
  if ((words & Block::bit('C')) != 0) target[kAxisC] = program[kAxisC] + shift_[kAxisC];
  if ((words & Block::bit('E')) != 0) target[kAxisE] = canonical_e(program[kAxisE]);
  return move_to(program, target, traverse);
}

bool Core::move_to(const Pose& program, const Pose& target, bool traverse) {
  ModalState& m = state_.modal;
  const std::uint32_t words = block_.present & ~used_;
  FeedRate feed{m.feed_known, m.feed_mm_per_s, m.feed_rad_per_s};
  if ((words & Block::bit('F')) != 0 && !m.inverse_time && !feed_from(block_['F'], feed)) return false;

  double linear = 0;
  for (std::size_t axis = kAxisX; axis <= kAxisZ; ++axis)
    linear = std::max(linear, std::abs(target[axis] - m.position[axis]));
  const double extruded = std::abs(target[kAxisE] - m.position[kAxisE]);
  const double turned =
      std::max(std::abs(target[kAxisA] - m.position[kAxisA]), std::abs(target[kAxisC] - m.position[kAxisC]));
  const bool comes_back = m.cutter == CutterSide::kBeside && (words & kLinear) != 0;
  const bool moves = linear > kNoMotion || extruded > kNoMotion || turned > kNoMotion || comes_back;
  const bool turns_alone = linear <= kNoMotion && turned > kNoMotion && turned >= extruded;
  const bool limited = m.traverse_limited || (traverse && traverse_has_feed_ && block_.has('F'));
  if (moves && traverse && extruded <= kNoMotion) {
    canonical::Traverse command{target, m.frame, 0};
    if (limited && feed.known && !m.inverse_time)
      command.speed_per_s = turns_alone ? feed.rad_per_s : feed.mm_per_s;
    out_->push_back({line_, command});
    m.position = target;
  } else if (moves) {
    canonical::Feed command{target, m.frame, 0, 0};
    if (!speed_for(turns_alone, feed, command.feed_per_s, command.inverse_time_s)) return false;
    if (m.inverse_time && cutter_is_on() && !turns_alone) {
      // The tool's way beside the contour has another length: the contour's own says how fast.
      const double way = norm(xyz(target) - xyz(m.position));
      if (way > kNoMotion) command.feed_per_s = way / std::exchange(command.inverse_time_s, 0);
    }
    out_->push_back({line_, command});
    m.position = target;
    m.e_max_mm = std::max(m.e_max_mm, target[kAxisE]);
  }
  m.program = program;
  m.traverse_limited = limited;
  m.feed_known = feed.known;
  m.feed_mm_per_s = feed.mm_per_s;
  m.feed_rad_per_s = feed.rad_per_s;
  used_ |= words & (kAllAxes | Block::bit('F'));
  return true;
}

bool Core::speed_for(bool turns_alone, const FeedRate& feed, double& feed_per_s, double& inverse_time_s) {
  const ModalState& m = state_.modal;
  if (m.inverse_time) {
    if (!has('F')) return fail(1, say("in inverse time mode (G93) every G1, G2 and G3 needs F"));
    double f = block_['F'];
    if (!(f > 0)) return fail(block_.column_of('F'), say("F must be greater than 0"));
    inverse_time_s = 60 / (f * m.feed_ratio);
    return true;
  }
  if (!feed.known) {
    const std::uint32_t column = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion).column : 1;
    return fail(column, say("no feed rate is set: this move needs F"));
  }
  feed_per_s = (turns_alone ? feed.rad_per_s : feed.mm_per_s) * m.feed_ratio;
  return true;
}

bool Core::arc_words(const Pose& start, bool& by_radius, double& radius_mm, std::array<double, 2>& centre,
                     int& turns) {
  const ModalState& m = state_.modal;
  const PlaneAxes plane = plane_axes();
  const Code code = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion) : Code{0, 1};
  const std::string name = m.motion == Motion::kArcClockwise ? "G2" : "G3";
  const char first = kCentreLetters[plane.u], second = kCentreLetters[plane.v],
             third = kCentreLetters[plane.w];
  by_radius = has('R');
  const bool by_centre = has(first) || has(second);
  const auto expected = [&] { return say("%1 and %2, or R", first, second); };
  if (has(third))
    return fail(block_.column_of(third),
                say("%1 does not belong to the arc's plane: %2 needs %3", third, name, expected()));
  if (by_radius && by_centre)
    return fail(block_.column_of('R'), say("%1 needs %2, not both", name, expected()));
  if (!by_radius && !by_centre) return fail(code.column, say("%1 needs %2", name, expected()));
  if (!take_integer('P', 1, 1000, turns)) return false;
  if (by_radius) {
    if (!take('R', radius_mm)) return false;
    radius_mm = length(radius_mm);
    return true;
  }
  if (m.absolute_centre && !(has(first) && has(second)))
    return fail(code.column, say("with G90.1 an arc needs both %1 and %2", first, second));
  double u = 0, v = 0;
  if (!take_if_given(first, u) || !take_if_given(second, v)) return false;
  centre = {length(u), length(v)};
  if (!m.absolute_centre) centre = {start[plane.u] + centre[0], start[plane.v] + centre[1]};
  return true;
}

bool Core::run_arc(bool clockwise) {
  ModalState& m = state_.modal;
  const PlaneAxes plane = plane_axes();
  const std::uint32_t column = block_.has(GGroup::kMotion) ? block_.code(GGroup::kMotion).column : 1;
  for (const char letter : kAxisLetters)
    if ((block_.present & ~used_ & block_.bare & Block::bit(letter)) != 0)
      return fail(block_.column_of(letter), say("%1 needs a number", letter));
  if (!check_turning()) return false;

  const Pose start = m.program;
  bool by_radius = false;
  double radius_mm = 0;
  std::array<double, 2> given_centre{};
  int turns = 1;
  if (!arc_words(start, by_radius, radius_mm, given_centre, turns)) return false;
  Pose program = start;
  program_target(program);
  const Point2 from = {start[plane.u], start[plane.v]}, to = {program[plane.u], program[plane.v]};
  const double tolerance = options_.arc_radius_tolerance_mm;
  if (!by_radius && is_spiral(from, to, given_centre)) {
    used_ |= block_.present & (kAllAxes | Block::bit('F'));
    return run_spiral(program, given_centre, clockwise, turns);
  }
  const auto geometry = by_radius ? arc_by_radius(from, to, radius_mm, clockwise, turns, tolerance)
                                  : arc_by_centre(from, to, given_centre, clockwise, turns, tolerance);
  if (!geometry) return fail(column, geometry.error());

  canonical::Arc command;
  const FeedRate feed{m.feed_known, m.feed_mm_per_s, m.feed_rad_per_s};
  if (!speed_for(false, feed, command.feed_per_s, command.inverse_time_s)) return false;
  if (m.inverse_time && cutter_is_on()) {
    const double round = length_of(from - geometry->centre) * geometry->sweep_rad;
    const double along = program[plane.w] - start[plane.w];
    command.feed_per_s = std::hypot(round, along) / std::exchange(command.inverse_time_s, 0);
  }
  used_ |= block_.present & (kAllAxes | Block::bit('F'));

  Vector3 centre = xyz(start), normal{};
  centre[plane.u] = geometry->centre[0];
  centre[plane.v] = geometry->centre[1];
  normal[plane.w] = clockwise ? -1 : 1;
  Pose arc_end = program;
  arc_end[plane.u] = geometry->end[0];
  arc_end[plane.v] = geometry->end[1];
  command.target = canonical_pose(arc_end);
  command.frame = m.frame;
  command.centre_mm = to_canonical_xyz(centre);
  command.normal = m.tilted || is_turned() ? program_axes() * normal : normal;
  command.sweep_rad = geometry->sweep_rad;
  out_->push_back({line_, command});
  m.position = command.target;
  m.e_max_mm = std::max(m.e_max_mm, m.position[kAxisE]);
  m.program = program;

  // What the end misses its circle by (within the tolerance) is left to a line.
  const Pose target = canonical_pose(program);
  if (norm(xyz(target) - xyz(m.position)) > kNoMotion) {
    const double radius = std::hypot(from[0] - geometry->centre[0], from[1] - geometry->centre[1]);
    const double speed =
        m.inverse_time ? radius * geometry->sweep_rad / command.inverse_time_s : command.feed_per_s;
    out_->push_back({line_, canonical::Feed{target, m.frame, speed, 0}});
    m.position = target;
  }
  return true;
}

bool Core::run_machine_coordinates() {
  const ModalState& m = state_.modal;
  const Code code = block_.code(GGroup::kNonmodal);
  if (m.motion != Motion::kTraverse && m.motion != Motion::kFeed)
    return fail(code.column, say("G53 needs G0 or G1, in this line or active"));
  if (m.frame != Frame::kMachine)
    return fail(code.column,
                say("%1 needs G49 and G69: machine coordinates do not turn with the part", "G53"));
  if (m.incremental) return fail(code.column, say("G53 needs absolute distances (G90)"));
  Pose target = m.position;
  Pose program = m.program;
  program_target(program);
  for (int axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    double value = 0;
    if (!has(letter)) continue;
    if (!take(letter, value)) return false;
    const auto at = static_cast<std::size_t>(axis);
    target[at] = axis_value(axis, value);
    program[at] = target[at] - shift_[at];
  }
  if (has('E')) {
    double value = 0;
    if (!take('E', value)) return false;
    target[kAxisE] = canonical_e(program[kAxisE]);
  }
  if (!move_to(program, target, m.motion == Motion::kTraverse)) return false;
  if (m.tilted || is_turned()) refresh();  // the point as the turned plane has it
  return true;
}

bool Core::retract() {
  ModalState& m = state_.modal;
  if (m.retracted) return true;
  m.retracted = true;
  m.retracted_mm = m.retract_length_mm;
  m.lifted_mm = m.retract_lift_mm;
  Pose target = m.position;
  target[kAxisE] -= m.retracted_mm;
  if (m.retracted_mm > 0) emit(canonical::Feed{target, m.frame, m.retract_mm_per_s, 0});
  m.position = target;
  move_lift(m.lifted_mm);
  return true;
}

bool Core::recover() {
  ModalState& m = state_.modal;
  if (!m.retracted) return true;
  const double lifted = m.lifted_mm;
  m.lifted_mm = 0;
  move_lift(-lifted);
  Pose target = m.position;
  target[kAxisE] += m.retracted_mm + m.recover_extra_mm;
  m.e_canonical_base_mm += m.recover_extra_mm;
  if (m.retracted_mm + m.recover_extra_mm != 0) emit(canonical::Feed{target, m.frame, m.recover_mm_per_s, 0});
  m.position = target;
  m.e_max_mm = std::max(m.e_max_mm, target[kAxisE]);
  m.retracted = false;
  m.retracted_mm = 0;
  return true;
}

void Core::move_lift(double height_mm) {
  ModalState& m = state_.modal;
  if (height_mm == 0) return;
  const Vector3 up = m.tilted ? program_axes() * Vector3{0, 0, height_mm} : Vector3{0, 0, height_mm};
  set_xyz(m.position, xyz(m.position) + up);
  emit(canonical::Traverse{m.position, m.frame});
  refresh_shift();
}

}  // namespace kinebus::gcode
