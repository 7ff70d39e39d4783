#include "tools/kinematics/subject.hpp"

#include <cctype>

namespace kinebus::kinematics_tool {
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::string Subject::Axis::column(const char* per) const {
  return lower(name) + (rotary ? "_deg" : "_mm") + per;
}

Result<Subject, std::string> Subject::of(MachineDescription machine) {
  Subject s;
  auto kinematics = make_kinematics(machine);
  if (!kinematics) return Error<std::string>(kinematics.error().what);
  s.machine_ = std::move(machine);
  s.kinematics_ = std::move(*kinematics);
  s.collision_model_ = make_collision_model(s.machine_);
  bool table = false, tilts = !std::holds_alternative<CoreXyGeometry>(s.machine_.kinematics) &&
                              !std::holds_alternative<LinearDeltaGeometry>(s.machine_.kinematics);
  for (int j = 0; j < s.kinematics_->joint_count(); ++j) {
    const JointInfo info = s.kinematics_->joint_info(j);
    if (info.name == "E") continue;
    table = table || info.name == "C";
    s.joints_.push_back({info.name, static_cast<std::size_t>(j), info.rotary});
  }
  if (const auto* cartesian = std::get_if<CartesianGeometry>(&s.machine_.kinematics))
    tilts = cartesian->has_table;
  s.pose_axes_ = {{"X", kX, false}, {"Y", kY, false}, {"Z", kZ, false}};
  if (tilts) s.pose_axes_.push_back({"A", kA, true});
  if (table) s.pose_axes_.push_back({"C", kC, true});
  return s;
}

std::size_t Subject::mechanism_joints() const {
  if (std::holds_alternative<M1Geometry>(machine_.kinematics)) return 4;
  if (std::holds_alternative<M4Geometry>(machine_.kinematics)) return 3;
  return joints_.size();
}

}  // namespace kinebus::kinematics_tool
