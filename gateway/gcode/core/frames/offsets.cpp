// Coordinate systems, G92 and G52, and from the program's point to the canonical one.

#include <cmath>
#include <numbers>
#include <optional>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
}  // namespace

Vector3 Core::offset_xyz() const {
  const ModalState& m = state_.modal;
  const auto system = static_cast<std::size_t>(m.coordinate_system);
  Vector3 offset = xyz(m.coordinate_offsets[system]);
  // The turn is about the system's zero: G92 lies within it, the tool does not.
  if (m.g92_active) offset = offset + (turned_ ? turn_of(system) * xyz(m.g92_offset) : xyz(m.g92_offset));
  for (std::size_t axis = kAxisX; axis <= kAxisY; ++axis) offset[axis] += m.tool_xy_mm[axis];
  offset[2] += m.tool_length_mm;
  return offset;
}

Matrix3 Core::turn_of(std::size_t system) const {
  return rotation_z(state_.modal.coordinate_offsets[system][kSystemTurn]);
}

Matrix3 Core::program_axes() const {
  const ModalState& m = state_.modal;
  const Matrix3 tilt = m.tilted ? m.tilt : kIdentity;
  return turned_ ? turn_of(static_cast<std::size_t>(m.coordinate_system)) * tilt : tilt;
}

void Core::refresh_shift() {
  const ModalState& m = state_.modal;
  shift_ = m.coordinate_offsets[static_cast<std::size_t>(m.coordinate_system)];
  turned_ = shift_[kSystemTurn] != 0;
  if (m.g92_active)
    for (std::size_t axis = kAxisA; axis <= kAxisC; ++axis) shift_[axis] += m.g92_offset[axis];
  set_xyz(shift_, offset_xyz());
  shift_[kAxisZ] += m.lifted_mm;
}

void Core::refresh() {
  refresh_shift();
  ModalState& m = state_.modal;
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) m.program[axis] = m.position[axis] - shift_[axis];
  if (!m.tilted && !turned_) return;
  Vector3 point = xyz(m.position) - offset_xyz();
  if (turned_) point = transposed(turn_of(static_cast<std::size_t>(m.coordinate_system))) * point;
  if (m.tilted) point = transposed(m.tilt) * (point - m.tilt_origin_mm);
  point[2] -= m.lifted_mm;
  set_xyz(m.program, point);
}

Vector3 Core::to_canonical_xyz(const Vector3& program) const {
  const ModalState& m = state_.modal;
  Vector3 point = program;
  if (!m.tilted && !turned_) return point + xyz(shift_);
  point[2] += m.lifted_mm;
  if (m.tilted) point = m.tilt * point + m.tilt_origin_mm;
  if (turned_) point = turn_of(static_cast<std::size_t>(m.coordinate_system)) * point;
  return point + offset_xyz();
}

double Core::canonical_e(double program_e) const {
  const ModalState& m = state_.modal;
  return m.e_canonical_base_mm + m.flow_ratio * (program_e - m.e_program_base_mm) - m.retracted_mm;
}

Pose Core::canonical_pose(const Pose& program) const {
  Pose pose{};
  set_xyz(pose, to_canonical_xyz(xyz(program)));
  pose[kAxisA] = program[kAxisA] + shift_[kAxisA];
  pose[kAxisC] = program[kAxisC] + shift_[kAxisC];
  pose[kAxisE] = canonical_e(program[kAxisE]);
  return pose;
}

void Core::base_e_here(double program_e) {
  ModalState& m = state_.modal;
  m.e_canonical_base_mm = m.position[kAxisE] + m.retracted_mm;
  m.e_program_base_mm = program_e;
  m.program[kAxisE] = program_e;
}

Frame Core::wanted_frame() const {
  const ModalState& m = state_.modal;
  return m.tool_centre_point || (m.tilted && !m.plane_rotation) ? Frame::kPart : Frame::kMachine;
}

void Core::change_frame() {
  ModalState& m = state_.modal;
  const Frame frame = wanted_frame();
  if (frame != m.frame) {
    m.position = in_frame(m.position, m.frame, frame);
    m.frame = frame;
    announce();
  }
  refresh();
}

bool Core::refuse_in_tilt(Code code) {
  if (!state_.modal.tilted) return true;
  return fail(code.column,
              say("%1 cannot change offsets in a tilted plane: end it with G69 first", g_name(code.number)));
}

bool Core::select_coordinate_system(Code code) {
  if (!refuse_in_tilt(code)) return false;
  const int tenths = code.number;
  state_.modal.coordinate_system = tenths < 590 ? (tenths - 540) / 10 : 5 + tenths - 590;
  refresh();
  return true;
}

bool Core::set_coordinate_system() {
  ModalState& m = state_.modal;
  const Code code = block_.code(GGroup::kNonmodal);
  if (!refuse_in_tilt(code)) return false;
  double l = 0;
  if (!take('L', l)) return false;
  if (l == 1 || l == 10 || l == 11) return set_tool_table(code, static_cast<int>(l));
  if (l != 2 && l != 20)
    return fail(block_.column_of('L'), say("G10 needs L1, L2, L10, L11 or L20 (or no L: retract)"));
  if (!has('P'))
    return fail(code.column, say("G10 needs P: 1 for G54 ... 9 for G59.3, 0 for the active one"));
  int p = 0;
  if (!take_integer('P', 0, kCoordinateSystems, p)) return false;
  const auto system = static_cast<std::size_t>(p == 0 ? m.coordinate_system : p - 1);
  if (l == 2 && has('R')) {
    double degrees = 0;
    if (!take('R', degrees)) return false;
    m.coordinate_offsets[system][kSystemTurn] = std::fmod(degrees, 360.0) * kRadians;
  }
  std::array<std::optional<double>, 2> xy;
  const bool turned = l == 20 && (turned_ || m.coordinate_offsets[system][kSystemTurn] != 0);
  for (int axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    double value = 0;
    if (!has(letter)) continue;
    if (!take(letter, value)) return false;
    if (turned && axis <= kAxisY)
      xy[static_cast<std::size_t>(axis)] = length(value);
    else
      set_offset(system, static_cast<std::size_t>(axis), axis_value(axis, value), l == 20);
  }
  if (turned) set_turned_offset(system, xy);
  refresh();
  return true;
}

/// `here`: the current point gets this coordinate, were this the active system.
void Core::set_offset(std::size_t system, std::size_t axis, double value, bool here) {
  ModalState& m = state_.modal;
  const double active = m.coordinate_offsets[static_cast<std::size_t>(m.coordinate_system)][axis];
  const double without = m.position[axis] - (shift_[axis] - active);
  m.coordinate_offsets[system][axis] = here ? without - value : value;
  refresh_shift();
}

void Core::set_turned_offset(std::size_t system, const std::array<std::optional<double>, 2>& xy) {
  ModalState& m = state_.modal;
  const Vector3 g92 = m.g92_active ? xyz(m.g92_offset) : Vector3{};
  Vector3 without = xyz(m.position);
  for (std::size_t axis = kAxisX; axis <= kAxisY; ++axis) without[axis] -= m.tool_xy_mm[axis];
  const Matrix3 turn = turn_of(system);
  Vector3 wanted = transposed(turn) * (without - xyz(m.coordinate_offsets[system]));
  for (std::size_t axis = kAxisX; axis <= kAxisY; ++axis)
    if (xy[axis]) wanted[axis] = *xy[axis] + g92[axis];
  const Vector3 zero = without - turn * wanted;
  for (std::size_t axis = kAxisX; axis <= kAxisY; ++axis) m.coordinate_offsets[system][axis] = zero[axis];
  refresh_shift();
}

bool Core::set_work_offset(int system, const Pose& offset, bool here) {
  if (!refuse_in_tilt(Code{.number = 100})) return false;
  const auto at = static_cast<std::size_t>(system);
  const bool turned = here && (turned_ || state_.modal.coordinate_offsets[at][kSystemTurn] != 0);
  for (std::size_t axis = turned ? kAxisZ : kAxisX; axis <= kAxisC; ++axis)
    set_offset(at, axis, offset[axis], here);
  if (turned) set_turned_offset(at, {offset[kAxisX], offset[kAxisY]});
  refresh();
  return true;
}

bool Core::set_g92(Code code) {
  ModalState& m = state_.modal;
  if (code.number != 920) {
    if (!refuse_in_tilt(code)) return false;
    if (code.number == 921) m.g92_offset = {};
    m.g92_active = code.number == 923;
    refresh();
    return true;
  }
  bool any = false;
  Pose program = m.program;
  for (int axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    double value = 0;
    if (!has(letter)) continue;
    if (!refuse_in_tilt(code) || !take(letter, value)) return false;
    program[static_cast<std::size_t>(axis)] = axis_value(axis, value);
    any = true;
  }
  if (any) {
    if (!m.g92_active) m.g92_offset = {};
    for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
      m.g92_offset[axis] += m.program[axis] - program[axis];
    m.g92_active = true;
    refresh();
  }
  if (has('E')) {
    double value = 0;
    if (!take('E', value)) return false;
    base_e_here(length(value));
    any = true;
  }
  return any || fail(code.column, say("G92 needs at least one axis word"));
}

/// G52: as LinuxCNC has it, the same values that G92 sets.
bool Core::set_local_offset(Code code) {
  ModalState& m = state_.modal;
  if (!refuse_in_tilt(code)) return false;
  if (!m.g92_active) m.g92_offset = {};
  bool any = false;
  for (int axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[static_cast<std::size_t>(axis)];
    double value = 0;
    if (!has(letter)) continue;
    if (!take(letter, value)) return false;
    m.g92_offset[static_cast<std::size_t>(axis)] = axis_value(axis, value);
    any = true;
  }
  if (!any) return fail(code.column, say("G52 needs at least one axis word"));
  m.g92_active = true;
  refresh();
  return true;
}

}  // namespace kinebus::gcode
