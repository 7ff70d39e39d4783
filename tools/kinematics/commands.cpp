#include "tools/kinematics/commands.hpp"

#include <algorithm>
#include <cmath>

#include "tools/kinematics/assemblies.hpp"

namespace kinebus::kinematics_tool {
namespace {

template <typename Vector>
Vector filled(const std::vector<Subject::Axis>& axes, std::span<const double> values) {
  Vector v{};
  for (std::size_t k = 0; k < axes.size(); ++k) v[axes[k].index] = values[k] * axes[k].unit();
  return v;
}

template <typename Vector>
void append(std::vector<double>& values, const std::vector<Subject::Axis>& axes, const Vector& v) {
  for (const Subject::Axis& axis : axes) values.push_back(v[axis.index] / axis.unit());
}

template <typename Vector>
Json named(const std::vector<Subject::Axis>& axes, const Vector& v, const char* per = "") {
  Json json = Json::object();
  for (const Subject::Axis& axis : axes) json[axis.column(per)] = v[axis.index] / axis.unit();
  return json;
}

std::vector<std::string> names(const std::vector<Subject::Axis>& axes, const char* per = "") {
  std::vector<std::string> out;
  out.reserve(axes.size());
  for (const Subject::Axis& axis : axes) out.push_back(axis.column(per));
  return out;
}

void extend(std::vector<std::string>& to, const std::vector<std::string>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

constexpr const char* kKinds[] = {"out_of_reach", "joint_limit", "leg_angle",     "clearance",
                                  "pose_limit",   "singular",    "no_convergence"};

Answer refused(Answer answer, const Subject& subject, const PoseError& error) {
  answer.error = to_string(error, subject.kinematics());
  Json& json = answer.json["error"];
  json["words"] = *answer.error;
  json["kind"] = kKinds[static_cast<std::size_t>(error.kind)];
  if (error.joint >= 0 && error.joint < subject.kinematics().joint_count())
    json["joint"] = subject.kinematics().joint_info(error.joint).name;
  if (error.kind == PoseError::Kind::kOutOfReach) json["short_by_mm"] = error.amount;
  return answer;
}

/// Which of the machine's rules a pose breaks, in words; empty: none.
std::string broken_rule(const Question& q, const Pose& pose) {
  const auto allowed = q.subject.kinematics().check(q.frame, pose);
  return allowed ? "" : to_string(allowed.error(), q.subject.kinematics()).english();
}

void add_rule(Answer& answer, const std::string& broken) {
  answer.json["allowed"] = broken.empty();
  if (!broken.empty()) answer.json["breaks"] = broken;
}

/// The answer to a row that is a pose, begun.
Answer about_pose(const Question& q, Pose& pose) {
  const auto& axes = q.subject.pose_axes();
  pose = filled<Pose>(axes, q.values);
  Answer answer;
  answer.json["pose"] = named(axes, pose);
  return answer;
}

// ---- inverse

NumberColumns pose_columns(const Subject& s) {
  return {names(s.pose_axes()), 3};
}

std::vector<std::string> joint_columns(const Subject& s) {
  return names(s.joints());
}

Answer inverse(const Question& q) {
  const Subject& s = q.subject;
  Pose pose{};
  Answer answer = about_pose(q, pose);
  JointVector joints{};
  if (const auto reached = s.kinematics().inverse(q.frame, pose, joints); !reached)
    return refused(std::move(answer), s, reached.error());
  const std::string broken = broken_rule(q, pose);
  answer.lines.push_back({{}, broken});
  append(answer.lines[0].values, s.joints(), joints);
  answer.json["joints"] = named(s.joints(), joints);
  add_rule(answer, broken);
  return answer;
}

// ---- forward

NumberColumns forward_columns(const Subject& s) {
  return {names(s.joints()), s.mechanism_joints()};
}

std::vector<std::string> mechanism_columns(const Subject& s) {
  const KinematicsGeometry& g = s.machine().kinematics;
  if (std::holds_alternative<M4Geometry>(g)) return {"phi_deg", "yp_mm", "xp_mm"};
  if (std::holds_alternative<M1Geometry>(g) || std::holds_alternative<M5Geometry>(g))
    return {"px_mm", "py_mm", "pz_mm"};
  return {};
}

std::vector<std::string> forward_result(const Subject& s) {
  std::vector<std::string> out = mechanism_columns(s);
  extend(out, names(s.pose_axes()));
  out.emplace_back("residual_mm");
  return out;
}

Answer forward(const Question& q) {
  const Subject& s = q.subject;
  Answer answer;
  const auto joints = filled<JointVector>(s.joints(), q.values);
  answer.json["joints"] = named(s.joints(), joints);
  answer.json["assemblies"] = Json::array();
  for (const Assembly& a : assemblies(s.machine(), s.kinematics(), q.frame, joints, q.mirrored)) {
    Answer::Line line{{}, a.words};
    Json one;
    for (const auto& [name, value] : a.mechanism) {
      line.values.push_back(value);
      one["mechanism"][name] = value;
    }
    append(line.values, s.pose_axes(), a.pose);
    line.values.push_back(a.residual_mm);
    one["pose"] = named(s.pose_axes(), a.pose);
    one["residual_mm"] = a.residual_mm;
    one["mirrored"] = a.mirrored;
    one["as_described"] = a.as_described;
    one["words"] = a.words;
    if (a.as_described) {
      const std::string broken = broken_rule(q, a.pose);
      one["allowed"] = broken.empty();
      if (!broken.empty()) {
        line.remark += "; " + broken;
        one["breaks"] = broken;
      }
    }
    answer.lines.push_back(std::move(line));
    answer.json["assemblies"].push_back(std::move(one));
  }
  if (answer.lines.empty()) {
    answer.error = "the mechanism closes in no pose with these joints";
    answer.json["error"] = {{"words", *answer.error}, {"kind", "no_assembly"}};
  }
  return answer;
}

// ---- jacobian

std::vector<std::string> jacobian_result(const Subject& s) {
  std::vector<std::string> out;
  for (const Subject::Axis& axis : s.pose_axes()) out.push_back("per_" + axis.column());
  return out;
}

Answer jacobian(const Question& q) {
  const Subject& s = q.subject;
  Pose pose{};
  Answer answer = about_pose(q, pose);
  std::array<double, std::size_t{kMaxJoints} * kPoseAxes> matrix{};
  JointVector joints{};
  if (const auto reached = s.kinematics().jacobian(q.frame, pose, joints, matrix); !reached)
    return refused(std::move(answer), s, reached.error());
  for (const Subject::Axis& joint : s.joints()) {
    Answer::Line line{{}, "d " + joint.column()};
    Json row = Json::object();
    for (const Subject::Axis& axis : s.pose_axes()) {
      line.values.push_back(matrix[joint.index * kPoseAxes + axis.index] * axis.unit() / joint.unit());
      row["per_" + axis.column()] = line.values.back();
    }
    answer.lines.push_back(std::move(line));
    answer.json["jacobian"][joint.column()] = std::move(row);
  }
  const double condition = s.kinematics().condition(q.frame, pose);
  answer.lines.push_back({{}, "condition number " + printed("%.6g", condition)});
  if (std::isfinite(condition))
    answer.json["condition"] = condition;
  else
    answer.json["condition"] = nullptr;
  add_rule(answer, broken_rule(q, pose));
  return answer;
}

// ---- acceleration

NumberColumns path_columns(const Subject& s) {
  NumberColumns columns{names(s.pose_axes()), 3 * s.pose_axes().size()};
  extend(columns.names, names(s.pose_axes(), "_per_s"));
  extend(columns.names, names(s.pose_axes(), "_per_s2"));
  return columns;
}

std::vector<std::string> motion_columns(const Subject& s) {
  std::vector<std::string> out = names(s.joints());
  extend(out, names(s.joints(), "_per_s"));
  extend(out, names(s.joints(), "_per_s2"));
  return out;
}

/// Joints whose speed or acceleration is beyond the machine file's.
std::string too_fast(const Subject& s, const JointPoint& joints) {
  std::string words;
  for (const Subject::Axis& joint : s.joints()) {
    const JointDescription& d = s.machine().joints[joint.index];
    const auto judge = [&](const char* what, double value, double limit, const char* unit) {
      if (std::abs(value) <= limit) return;
      words += (words.empty() ? "" : ", ") + joint.name + ": " + what + " " +
               printed("%.4g of %.4g %s%s", std::abs(value) / joint.unit(), limit / joint.unit(),
                       joint.rotary ? "deg" : "mm", unit);
    };
    judge("speed", joints.q1[joint.index], d.speed_per_s, "/s");
    judge("acceleration", joints.q2[joint.index], d.accel_per_s2, "/s^2");
  }
  return words;
}

Answer acceleration(const Question& q) {
  const Subject& s = q.subject;
  Answer answer;
  const std::size_t n = s.pose_axes().size();
  const PosePoint path{filled<Pose>(s.pose_axes(), q.values.first(n)),
                       filled<Pose>(s.pose_axes(), q.values.subspan(n, n)),
                       filled<Pose>(s.pose_axes(), q.values.subspan(2 * n, n))};
  answer.json["pose"] = named(s.pose_axes(), path.x);
  answer.json["pose_speed"] = named(s.pose_axes(), path.x1, "_per_s");
  answer.json["pose_acceleration"] = named(s.pose_axes(), path.x2, "_per_s2");
  JointPoint joints;
  if (const auto reached = s.kinematics().inverse_along(q.frame, path, joints); !reached)
    return refused(std::move(answer), s, reached.error());
  std::string broken = broken_rule(q, path.x);
  if (const std::string fast = too_fast(s, joints); !fast.empty())
    broken += (broken.empty() ? "" : ", ") + fast;
  Answer::Line line{{}, broken};
  append(line.values, s.joints(), joints.q);
  append(line.values, s.joints(), joints.q1);
  append(line.values, s.joints(), joints.q2);
  answer.lines.push_back(std::move(line));
  answer.json["joints"] = named(s.joints(), joints.q);
  answer.json["speed"] = named(s.joints(), joints.q1, "_per_s");
  answer.json["acceleration"] = named(s.joints(), joints.q2, "_per_s2");
  add_rule(answer, broken);
  return answer;
}

// ---- clearance

std::vector<std::string> clearance_result(const Subject& s) {
  std::vector<std::string> out = names(s.pose_axes());
  out.emplace_back("clearance_mm");
  return out;
}

Answer clearance(const Question& q) {
  const Subject& s = q.subject;
  const bodies::CollisionModel& model = *s.collision_model();
  Pose pose{};
  Answer answer = about_pose(q, pose);
  JointVector joints{};
  if (const auto reached = s.kinematics().inverse(q.frame, pose, joints); !reached)
    return refused(std::move(answer), s, reached.error());
  const auto nearest = model.clearance(q.frame, pose);
  if (!nearest) return refused(std::move(answer), s, {PoseError::Kind::kOutOfReach});
  std::string broken = broken_rule(q, pose);
  if (nearest->mm < model.wanted_mm())
    broken += (broken.empty() ? "" : ", ") + model.words(*nearest).english();
  const std::string first = model.name(nearest->first).english(),
                    second = model.name(nearest->second).english();
  Answer::Line line{{}, first + " and " + second + (broken.empty() ? "" : "; " + broken)};
  append(line.values, s.pose_axes(), pose);
  line.values.push_back(nearest->mm);
  answer.lines.push_back(std::move(line));
  answer.json["clearance_mm"] = nearest->mm;
  answer.json["between"] = {first, second};
  answer.json["kept_mm"] = model.wanted_mm();
  add_rule(answer, broken);
  return answer;
}

constexpr Command kCommands[] = {
    {"inverse", "joints for a pose; what is broken of the machine's rules stands behind a #", pose_columns,
     joint_columns, inverse},
    {"forward",
     "every pose that joints allow, with the closure error; trailing joints of a table may be left out",
     forward_columns, forward_result, forward},
    {"jacobian", "d joints / d pose, a line for each joint, and the condition number", pose_columns,
     jacobian_result, jacobian},
    {"acceleration", "joints, their speed and acceleration for a pose, its speed and acceleration",
     path_columns, motion_columns, acceleration},
    {"clearance",
     "smallest clearance of all bodies of the machine file's [bodies] at a pose, and which two it is between",
     pose_columns, clearance_result, clearance, true},
};

}  // namespace

std::span<const Command> commands() {
  return kCommands;
}

}  // namespace kinebus::kinematics_tool
