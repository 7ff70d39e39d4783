// Planes that are tilted (G68.2, G53.1) or turned (G68).

#include <cmath>
#include <numbers>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kTurn = 2 * std::numbers::pi;

/// The angle nearest to `near_rad` that differs from `angle_rad` by whole turns.
double nearest_turn(double angle_rad, double near_rad) {
  return angle_rad + kTurn * std::round((near_rad - angle_rad) / kTurn);
}

}  // namespace

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
  m.tilt = euler_zxz(i * kDegree, j * kDegree, k * kDegree);
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
  const double cosine = std::cos(value * kDegree), sine = std::sin(value * kDegree);
  m.tilt = kIdentity;
  m.tilt[plane.u][plane.u] = m.tilt[plane.v][plane.v] = cosine;
  m.tilt[plane.v][plane.u] = sine;
  m.tilt[plane.u][plane.v] = -sine;
  m.tilt_origin_mm = centre - m.tilt * centre;
  m.tilted = m.plane_rotation = true;
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

}  // namespace kinebus::gcode
