#include "gateway/motion/tests/trajectory_probe.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "gateway/motion/path_distance.hpp"

namespace kinebus::probe {
namespace {

double greatest(const Pose& a, const Pose& b) {
  double most = 0;
  for (std::size_t i = 0; i < kPoseAxes; ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

double length3(const Pose& v) {
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

class Prober {
 public:
  Prober(const Kinematics& kinematics, const MotionLimits& limits, int samples)
      : kinematics_(kinematics), limits_(limits), samples_(samples) {}

  void phase(const Phase& phase, Measured& m, PathDistance& path) {
    const PosePoint start = phase.at(0), end = phase.at(phase.duration_s);
    if (m.phases == 0) {
      m.speed_at_ends = phase.v0;
    } else {
      m.position_jump = std::max(m.position_jump, greatest(start.x, last_.x));
      m.velocity_jump = std::max(m.velocity_jump, greatest(start.x1, last_.x1));
      Pose jump;
      for (std::size_t i = 0; i < kPoseAxes; ++i) jump[i] = start.x2[i] - last_.x2[i];
      m.accel_jump_mm_per_s2 = std::max(m.accel_jump_mm_per_s2, length3(jump));
    }
    const int steps = std::max(samples_, static_cast<int>(phase.duration_s * 1000));
    for (int i = 0; i <= steps; ++i) sample(phase, phase.duration_s * i / steps, m, path);
    if (limits_.limits_jerk()) jerks(phase, m);
    last_ = end;
    last_speed_ = phase.speed(phase.duration_s);
    m.duration_s += phase.duration_s;
    m.last_marked = phase.last && !marked_;
    marked_ = marked_ || phase.last;
    ++m.phases;
  }

  void finish(Measured& m, const Pose& programmed_end) const {
    if (m.phases == 0) return;
    m.speed_at_ends = std::max(m.speed_at_ends, std::abs(last_speed_));
    m.end_error = greatest(last_.x, programmed_end);
  }

  /// Third differences of positions a millisecond apart, over the whole run.
  void jerks(const Phase& phase, Measured& m) {
    constexpr double h = 1e-3;
    for (; next_s_ <= m.duration_s + phase.duration_s; next_s_ += h) {
      const double t = std::clamp(next_s_ - m.duration_s, 0.0, phase.duration_s);
      const Pose pose = phase.piece.evaluate(phase.s(t)).x;
      JointVector joints{};
      if (!kinematics_.inverse(phase.piece.frame, pose, joints)) return;
      std::move_backward(poses_, poses_ + 3, poses_ + 4);
      std::move_backward(joints_, joints_ + 3, joints_ + 4);
      poses_[0] = pose;
      joints_[0] = joints;
      if (++in_a_row_ < 4) continue;
      Pose jerk;
      for (std::size_t i = 0; i < kPoseAxes; ++i)
        jerk[i] = (poses_[0][i] - 3 * poses_[1][i] + 3 * poses_[2][i] - poses_[3][i]) / (h * h * h);
      m.tool_jerk_mm_per_s3 = std::max(m.tool_jerk_mm_per_s3, length3(jerk));
      for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_.joint_count()); ++j)
        m.joint_jerk_ratio = std::max(m.joint_jerk_ratio, std::abs(joints_[0][j] - 3 * joints_[1][j] +
                                                                   3 * joints_[2][j] - joints_[3][j]) /
                                                              (h * h * h) / limits_.joint_jerk_per_s3[j]);
    }
  }

  void sample(const Phase& phase, double t, Measured& m, PathDistance& path) {
    const PosePoint p = phase.at(t);
    m.tool_speed_mm_per_s = std::max(m.tool_speed_mm_per_s, length3(p.x1));
    m.tool_accel_mm_per_s2 = std::max(m.tool_accel_mm_per_s2, length3(p.x2));
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      m.axis_speed_ratio = std::max(m.axis_speed_ratio, std::abs(p.x1[i]) / limits_.axis_speed_per_s[i]);
      m.axis_accel_ratio = std::max(m.axis_accel_ratio, std::abs(p.x2[i]) / limits_.axis_accel_per_s2[i]);
    }
    JointPoint joints;
    if (!kinematics_.inverse_along(phase.piece.frame, p, joints)) {
      m.error = "a planned pose is out of reach, line " + std::to_string(phase.line);
      return;
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_.joint_count()); ++j) {
      m.joint_speed_ratio =
          std::max(m.joint_speed_ratio, std::abs(joints.q1[j]) / limits_.joint_speed_per_s[j]);
      m.joint_accel_ratio =
          std::max(m.joint_accel_ratio, std::abs(joints.q2[j]) / limits_.joint_accel_per_s2[j]);
    }
    const double off = path.distance_mm(p.x, phase.line);
    if (off > m.path_error_mm) {
      m.path_error_mm = off;
      m.path_error_line = phase.line;
    }
  }

  const Kinematics& kinematics_;
  const MotionLimits& limits_;
  int samples_;
  PosePoint last_{};
  double last_speed_ = 0;
  bool marked_ = false;
  double next_s_ = 0;
  int in_a_row_ = 0;
  Pose poses_[4]{};
  JointVector joints_[4]{};
};

}  // namespace

Measured measure(const Kinematics& kinematics, const MotionLimits& limits, const Lines& lines, int samples,
                 bool keep, Planner::Options options) {
  Measured m;
  Planner planner(kinematics, limits, options);
  PathDistance path;
  Prober prober(kinematics, limits, samples);
  Phase phase;
  const auto pull = [&] {
    while (planner.next(phase)) {
      prober.phase(phase, m, path);
      if (keep) m.all.push_back(phase);
    }
  };
  for (const auto& line : lines) {
    path.add(line);
    if (const auto ok = planner.add(line); !ok) {
      m.error = to_string(ok.error()).english();
      return m;
    }
    if (!planner.wants_more()) pull();
  }
  if (const auto ok = planner.finish(); !ok) {
    m.error = to_string(ok.error()).english();
    return m;
  }
  pull();
  prober.finish(m, planner.end_pose());
  m.counters = planner.counters();
  m.planned = m.error.empty() && planner.idle();
  return m;
}

Job::Job(const Pose& start, Frame frame) : at_(start), frame_(frame) {
  add(canonical::SetPosition{start, frame_});
}

Job& Job::add(const canonical::Command& command) {
  lines_.push_back({static_cast<std::uint32_t>(lines_.size() + 1), command});
  return *this;
}
Job& Job::to(const Pose& target) {
  at_ = target;
  return add(canonical::Feed{target, frame_, feed_, 0});
}
Job& Job::by(const Pose& delta) {
  Pose target = at_;
  for (std::size_t i = 0; i < kPoseAxes; ++i) target[i] += delta[i];
  return to(target);
}
Job& Job::rapid(const Pose& target) {
  at_ = target;
  return add(canonical::Traverse{target, frame_});
}
Job& Job::arc(const Pose& target, const std::array<double, 3>& centre, const std::array<double, 3>& normal,
              double sweep_rad) {
  at_ = target;
  return add(canonical::Arc{target, frame_, centre, normal, sweep_rad, feed_, 0});
}

}  // namespace kinebus::probe
