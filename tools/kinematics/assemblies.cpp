#include "tools/kinematics/assemblies.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/kinematics/m4.hpp"
#include "gateway/kinematics/table_rotation.hpp"
#include "gateway/kinematics/tool_placement.hpp"
#include "tools/kinematics/m1_assemblies.hpp"

namespace kinebus {
namespace {

class Forward {
 public:
  Forward(const MachineDescription& machine, const Kinematics& kinematics, Frame frame,
          const JointVector& joints, bool mirrored)
      : machine_(machine), kinematics_(kinematics), frame_(frame), joints_(joints), mirrored_(mirrored) {}

  std::vector<Assembly> operator()(const M1Geometry& nominal) const {
    const M1Geometry g =
        machine_.geometry_calibration ? corrected(nominal, *machine_.geometry_calibration) : nominal;
    const bool table = kinematics_.joint_count() > 4;
    const double c_rad = table ? joints_[4] : 0, e_mm = table ? joints_[5] : 0;
    std::vector<Assembly> found;
    for (const M1Assembly& a : m1_assemblies(g, joints_)) {
      Assembly one;
      const Vector3& p = a.platform_mm;
      one.mechanism = {{"px_mm", p[0]}, {"py_mm", p[1]}, {"pz_mm", p[2]}};
      one.pose = pose_at(g, frame_, {p, a.a_rad}, c_rad, e_mm);
      one.residual_mm = a.residual_mm;
      one.as_described = a.physical();
      for (std::size_t i = 0; i < 4; ++i) {
        if (a.as_described[i]) continue;
        one.words += (one.words.empty() ? "carriage of leg " : ", ") + std::to_string(i + 1);
      }
      one.words = one.words.empty() ? "as described" : one.words + " on the other side of the platform";
      found.push_back(std::move(one));
    }
    return found;
  }
  std::vector<Assembly> operator()(const M5Geometry& g) const {
    return (*this)(static_cast<const M1Geometry&>(g));
  }

  std::vector<Assembly> operator()(const M4Geometry& g) const {
    std::vector<Assembly> found;
    for (const M4Assembly& a : m4_assemblies(g, {joints_[0], joints_[1], joints_[2]})) {
      if (a.mirrored && !mirrored_) continue;
      Assembly one;
      const PlanarPose& p = a.pose;
      one.mechanism = {{"phi_deg", p.phi_rad / kRadPerDeg}, {"yp_mm", p.y_mm}, {"xp_mm", p.x_mm}};
      // From P, the middle of AB, to the tip, as the part sees it.
      const double a_rad = std::remainder(g.spindle_rad - p.phi_rad, 2 * std::numbers::pi);
      Vector3 v{joints_[3], p.x_mm - g.tool_mm * std::sin(a_rad) - g.table_y_mm,
                p.y_mm - g.tool_mm * std::cos(a_rad) - g.table_z_mm};
      v = frame_ == Frame::kPart ? turn_back_z(Turn(joints_[4]), v) : turn_x(Turn(a_rad), v);
      one.pose = {v[0], v[1], v[2], a_rad, joints_[4], 0};
      one.residual_mm = a.residual_mm;
      one.mirrored = a.mirrored;
      one.as_described = a.physical();
      one.words = a.mirrored ? "mirrored triangle" : "";
      for (std::size_t i = 0; i < 2; ++i)
        if (!a.block_above[i])
          one.words +=
              (one.words.empty() ? "block " : ", block ") + std::to_string(i + 1) + " below the tool";
      if (one.words.empty()) one.words = "as described";
      found.push_back(std::move(one));
    }
    return found;
  }

  /// The effector may hang below its carriages, or stand above them: mirrored at the plane through them.
  std::vector<Assembly> operator()(const LinearDeltaGeometry& g) const {
    std::vector<Assembly> found = only();
    if (found.empty()) return found;
    std::array<Vector3, 3> k{};
    for (std::size_t i = 0; i < 3; ++i)
      k[i] = {g.radius_mm * std::cos(g.tower_angle_rad[i]), g.radius_mm * std::sin(g.tower_angle_rad[i]),
              joints_[i]};
    const auto less = [](const Vector3& a, const Vector3& b) {
      return Vector3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const Vector3 u = less(k[1], k[0]), v = less(k[2], k[0]);
    const Vector3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const Vector3 from = less({found[0].pose[kX], found[0].pose[kY], found[0].pose[kZ]}, k[0]);
    const double nn = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
    const double twice = 2 * (from[0] * n[0] + from[1] * n[1] + from[2] * n[2]) / nn;
    Assembly other = found[0];
    for (std::size_t i = 0; i < 3; ++i) other.pose[i] -= twice * n[i];
    other.residual_mm = 0;
    for (const Vector3& carriage : k) {
      const Vector3 arm = less({other.pose[kX], other.pose[kY], other.pose[kZ]}, carriage);
      other.residual_mm =
          std::max(other.residual_mm, std::abs(std::hypot(arm[0], arm[1], arm[2]) - g.arm_length_mm));
    }
    other.as_described = false;
    other.words = "effector above the carriages";
    found.push_back(std::move(other));
    return found;
  }

  /// A joint for each axis: one pose.
  std::vector<Assembly> operator()(const CartesianGeometry&) const { return only(); }
  std::vector<Assembly> operator()(const CoreXyGeometry&) const { return only(); }

 private:
  std::vector<Assembly> only() const {
    Assembly one;
    one.pose = kinematics_.bed_reference();
    if (!kinematics_.forward(frame_, joints_, one.pose)) return {};
    JointVector again{};
    if (!kinematics_.inverse(frame_, one.pose, again)) return {};
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_.joint_count()); ++j)
      if (!kinematics_.joint_info(static_cast<int>(j)).rotary)
        one.residual_mm = std::max(one.residual_mm, std::abs(again[j] - joints_[j]));
    one.words = "as described";
    return {one};
  }

  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  Frame frame_;
  const JointVector& joints_;
  bool mirrored_;
};

}  // namespace

bool can_be_mirrored(const KinematicsGeometry& geometry) {
  return std::holds_alternative<M4Geometry>(geometry);
}

std::vector<Assembly> assemblies(const MachineDescription& machine, const Kinematics& kinematics, Frame frame,
                                 const JointVector& joints, bool mirrored) {
  return std::visit(Forward(machine, kinematics, frame, joints, mirrored), machine.kinematics);
}

}  // namespace kinebus
