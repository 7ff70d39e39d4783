// Coordinate systems, tool length, frames, tilted plane, and G28.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;

/// The angle nearest to `near_rad` that differs from `angle_rad` by whole turns.
double nearest_turn(double angle_rad, double near_rad) {
  return angle_rad + kTurn * std::round((near_rad - angle_rad) / kTurn);
}

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

bool Core::set_tool_length(Code code) {
  ModalState& m = state_.modal;
  int tools = static_cast<int>(options_.tool_length_mm.size());
  for (const ToolEntry& entry : state_.tools) tools = std::max(tools, entry.tool);
  int h = m.tool <= tools ? m.tool : 0;
  if (code.number != 490 && code.number != 431 && !take_integer('H', 0, tools, h)) return false;
  const ToolEntry tool = code.number == 490 || code.number == 431 ? ToolEntry{} : tool_entry(h);
  double tool_length = tool.offset_mm[2];
  if (code.number == 431) {
    if (block_.has(GGroup::kMotion) || !has('Z'))
      return fail(code.column, say("G43.1 needs the tool's length Z, and a line without motion"));
    if (!take('Z', tool_length)) return false;
    tool_length = length(tool_length);
  }
  if (tool_length != 0 && (code.number == 434 || (m.tilted && !m.plane_rotation)))
    return fail(
        code.column,
        say("G43.4 and G68.2 need a tool of length 0: the machine file says where the tool's tip is"));
  m.tool_length_mm = tool_length;
  m.tool_xy_mm = {tool.offset_mm[0], tool.offset_mm[1]};
  m.tool_centre_point = code.number == 434;
  change_frame();
  return true;
}

ToolEntry Core::tool_entry(int tool) const {
  for (const ToolEntry& entry : state_.tools)
    if (entry.tool == tool) return entry;
  ToolEntry entry{tool, {}, 0};
  const auto at = static_cast<std::size_t>(tool - 1);
  if (tool >= 1 && at < options_.tool_length_mm.size()) entry.offset_mm[2] = options_.tool_length_mm[at];
  if (tool >= 1 && at < options_.tool_diameter_mm.size()) entry.diameter_mm = options_.tool_diameter_mm[at];
  return entry;
}

/// G10 L1: the tool's offsets; L10: those by which the current point gets these coordinates; L11: the same in
/// G59.3, without G92. In force with the next G43.
bool Core::set_tool_table(Code code, int l) {
  const ModalState& m = state_.modal;
  int tool = 0;
  if (!has('P')) return fail(code.column, say("G10 L%1 needs the tool P", l));
  if (!take_integer('P', 1, 99'999, tool)) return false;
  ToolEntry entry = tool_entry(tool);
  const auto system = static_cast<std::size_t>(l == 11 ? kCoordinateSystems - 1 : m.coordinate_system);
  const Vector3 zero = xyz(m.coordinate_offsets[system]);
  const Vector3 g92 = l == 10 && m.g92_active ? xyz(m.g92_offset) : Vector3{};
  const Matrix3 turn = turn_of(system);
  // Not turned, an axis that is not given stays as it is to the last bit.
  const bool turned = m.coordinate_offsets[system][kSystemTurn] != 0;
  Vector3 point = transposed(turn) * (xyz(m.position) - zero - entry.offset_mm);
  std::array<bool, 3> given{};
  for (std::size_t axis = kAxisX; axis <= kAxisZ; ++axis) {
    double value = 0;
    given[axis] = has(kAxisLetters[axis]);
    if (!given[axis]) continue;
    if (!take(kAxisLetters[axis], value)) return false;
    if (l == 1) entry.offset_mm[axis] = length(value);
    point[axis] = length(value) + g92[axis];
  }
  const Vector3 found = xyz(m.position) - zero - turn * point;
  for (std::size_t axis = kAxisX; l != 1 && axis <= kAxisZ; ++axis)
    if (given[axis] || (turned && axis != kAxisZ)) entry.offset_mm[axis] = found[axis];
  double radius = entry.diameter_mm / 2;
  const bool has_radius = has('R');
  if (!take_if_given('R', radius)) return false;
  if (has_radius) entry.diameter_mm = 2 * length(radius);
  for (const char letter : {'I', 'J', 'Q'}) pass_over(letter);  // angles and orientation of lathe tools
  for (ToolEntry& known : state_.tools) {
    if (known.tool != tool) continue;
    known = entry;
    return true;
  }
  if (state_.tools.size() >= ToolEntry::kMost)
    return fail(code.column, say("too many tools are changed by G10 (1000 at most)"));
  state_.tools.push_back(entry);
  return true;
}

bool Core::set_tilt(Code code) {
  ModalState& m = state_.modal;
  if (code.number == 680) return rotate_plane(code);
  if (code.number == 690) {
    m.tilted = m.plane_rotation = false;
    change_frame();
    return true;
  }
  if (m.tilted) return fail(code.column, say("a tilted plane is active already: end it with G69 first"));
  if (m.tool_length_mm != 0)
    return fail(
        code.column,
        say("G43.4 and G68.2 need a tool of length 0: the machine file says where the tool's tip is"));
  double x = 0, y = 0, z = 0, i = 0, j = 0, k = 0;
  if (block_.has(GGroup::kMotion))
    return fail(code.column, say("G68.2 uses the line's axis words: write the motion in another line"));
  if (!take_if_given('X', x) || !take_if_given('Y', y) || !take_if_given('Z', z) || !take_if_given('I', i) ||
      !take_if_given('J', j) || !take_if_given('K', k))
    return false;
  m.tilt_origin_mm = {length(x), length(y), length(z)};
  m.tilt = euler_zxz(i * kRadians, j * kRadians, k * kRadians);
  m.tilted = true;
  change_frame();
  return true;
}

/// G68: about the point given, else about the current one.
bool Core::rotate_plane(Code code) {
  ModalState& m = state_.modal;
  if (m.tilted && !m.plane_rotation)
    return fail(code.column, say("a tilted plane is active already: end it with G69 first"));
  if (block_.has(GGroup::kMotion))
    return fail(code.column,
                say("%1 uses the line's axis words: write the motion in another line", g_name(680)));
  if (!has('R')) return fail(code.column, say("G68 needs R, the angle in degrees"));
  m.tilted = m.plane_rotation = false;
  refresh();
  const PlaneAxes plane = plane_axes();
  Vector3 centre = xyz(m.program);
  double value = 0;
  for (const std::size_t axis : {plane.u, plane.v}) {
    if (!has(kAxisLetters[axis])) continue;
    if (!take(kAxisLetters[axis], value)) return false;
    centre[axis] = length(value);
  }
  if (!take('R', value)) return false;
  const double cosine = std::cos(value * kRadians), sine = std::sin(value * kRadians);
  m.tilt = kIdentity;
  m.tilt[plane.u][plane.u] = m.tilt[plane.v][plane.v] = cosine;
  m.tilt[plane.v][plane.u] = sine;
  m.tilt[plane.u][plane.v] = -sine;
  m.tilt_origin_mm = centre - m.tilt * centre;
  m.tilted = m.plane_rotation = true;
  refresh();
  return true;
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

bool Core::orient_tool() {
  ModalState& m = state_.modal;
  const Code code = block_.code(GGroup::kNonmodal);
  if (!m.tilted || m.plane_rotation) return fail(code.column, say("G53.1 needs a tilted plane (G68.2)"));
  int choice = 0;
  if (!take_integer('P', 0, 2, choice)) return false;
  // R_X(A) R_Z(C) turns the plane's normal (in the part) to the machine's +Z, where the tool comes from.
  const Matrix3 axes = program_axes();
  const Vector3 normal = {axes[0][2], axes[1][2], axes[2][2]};
  const double slope = std::hypot(normal[0], normal[1]);
  constexpr double kLevel = 1e-12;
  constexpr double kRounding = 1e-9;
  bool found = false;
  Pose best = m.position;
  for (const int sign : {1, -1}) {
    if ((choice == 1 && sign < 0) || (choice == 2 && sign > 0)) continue;
    Pose pose = m.position;
    pose[kAxisA] = std::atan2(sign * slope, normal[2]);
    if (slope > kLevel)
      pose[kAxisC] = nearest_turn(std::atan2(sign * normal[0], sign * normal[1]), m.position[kAxisC]);
    if (pose[kAxisA] < options_.a_min_rad - kRounding || pose[kAxisA] > options_.a_max_rad + kRounding)
      continue;
    // The nearer C; of two as near, the positive A.
    const double turn = std::abs(pose[kAxisC] - m.position[kAxisC]);
    if (!found || turn < std::abs(best[kAxisC] - m.position[kAxisC]) - kRounding) best = pose;
    found = true;
  }
  if (!found)
    return fail(code.column, say("no A within the machine's range makes the tool normal to the plane"));

  if (std::abs(best[kAxisA] - m.position[kAxisA]) <= kRounding &&
      std::abs(best[kAxisC] - m.position[kAxisC]) <= kRounding)
    return true;
  if (m.tool_centre_point) {
    emit(canonical::Traverse{best, m.frame});
    m.position = best;
  } else {
    // Without tool centre point control only A and C turn; the machine's X Y Z stay.
    Pose machine = in_frame(m.position, m.frame, Frame::kMachine);
    emit(canonical::SetPosition{machine, Frame::kMachine});
    machine[kAxisA] = best[kAxisA];
    machine[kAxisC] = best[kAxisC];
    emit(canonical::Traverse{machine, Frame::kMachine});
    m.position = in_frame(machine, Frame::kMachine, m.frame);
    announce();
  }
  refresh();
  return true;
}

bool Core::home() {
  ModalState& m = state_.modal;
  unsigned axes = 0;
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis) {
    const char letter = kAxisLetters[axis];
    if (!has(letter)) continue;
    // G28 X0 is common; an intermediate point as in RS274/NGC has no meaning when home is a switch.
    if (!block_.is_bare(letter) && block_[letter] != 0)
      return fail(block_.column_of(letter), say("G28 finds the home switches: name axes without a number"));
    pass_over(letter);
    axes |= 1U << axis;
  }
  // G28 W: without bed levelling, which is never done here. G28 O: only where it is needed; a machine that
  // knows its position goes to its reference without looking for switches, whatever the word says.
  for (const char letter : {'W', 'O'})
    if (block_.is_bare(letter)) pass_over(letter);
  pass_over('R');  // how high other machines lift before it
  Pose machine = in_frame(m.position, m.frame, Frame::kMachine);
  for (std::size_t axis = kAxisX; axis <= kAxisC; ++axis)
    if (axes == 0 || (axes >> axis & 1U) != 0) machine[axis] = options_.home[axis];
  m.lifted_mm = 0;
  m.position = in_frame(machine, Frame::kMachine, m.frame);
  refresh();
  emit(canonical::Home{static_cast<std::uint8_t>(axes), m.position, m.frame});
  return true;
}

}  // namespace kinebus::gcode
