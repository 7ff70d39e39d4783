#include "tools/calibrate/hidden.hpp"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "gateway/calibration/joint_map.hpp"

namespace kinebus {
namespace {

double edge_side(const JointDescription& joint) {
  return joint.homing ? joint.homing->edge_direction() : 1;
}

double drive_at(const JointCalibration& c, double position, double side) {
  return (JointMap(c).to_drive(position) + side * c.backlash / 2) / (1 + c.scale);
}

void print(std::string& out, const char* format, auto... values) {
  char text[256];
  std::snprintf(text, sizeof text, format, values...);
  out += text;
}

}  // namespace

double anchor_of(const JointDescription& joint) {
  return joint.homing ? joint.homing->switch_position : 0;
}

double drive_from_home(const JointDescription& joint, double position, int direction) {
  const JointCalibration& c = joint.calibration;
  return drive_at(c, position, direction) - drive_at(c, anchor_of(joint) + c.offset, edge_side(joint));
}

double true_position(const JointDescription& believed, const JointDescription& truth, double position,
                     int direction) {
  const JointCalibration& t = truth.calibration;
  const double drive = drive_at(t, anchor_of(truth) + t.offset, edge_side(truth)) +
                       drive_from_home(believed, position, direction);
  return JointMap(t).to_joint(drive * (1 + t.scale) - direction * t.backlash / 2);
}

MachineDescription with_hidden_errors(const MachineDescription& machine, const HiddenErrors& errors,
                                      std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto within = [&](double most) {
    return std::uniform_real_distribution<double>(-most, most)(engine);
  };
  MachineDescription truth = machine;
  truth.geometry_calibration.emplace();
  for (std::size_t i = 0; i < 4; ++i) {
    M1LegCorrection& leg = truth.geometry_calibration->legs[i];
    for (std::size_t k = 0; k < 3; ++k) {
      leg.foot_mm[k] = within(errors.geometry_mm);
      leg.attachment_mm[k] = within(errors.geometry_mm);
    }
    leg.rail = {within(errors.lean), within(errors.lean), 0};
    leg.length_mm = within(errors.geometry_mm);
    JointCalibration& c = truth.joints[i].calibration;
    c.scale = within(errors.scale);
    c.offset = within(errors.switch_mm);
    c.backlash = errors.backlash_mm * (0.75 + within(0.25));
    if (errors.periodic_mm > 0) {
      c.pitch = truth.joints[i].drive.travel_per_turn;
      c.periodic_sine = within(errors.periodic_mm);
      c.periodic_cosine = within(errors.periodic_mm);
    }
  }
  return truth;
}

std::string measure_rails(const MachineDescription& believed, const MachineDescription& truth, double step,
                          double noise_mm, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0, noise_mm);
  std::string out = "joint,commanded_mm,measured_mm,direction\n";
  for (std::size_t i = 0; i < believed.joints.size(); ++i) {
    const JointDescription& j = believed.joints[i];
    if (j.rotary || !j.travel.limited()) continue;
    const int steps = static_cast<int>((j.travel.max - j.travel.min) / step);
    for (const int direction : {1, -1})
      for (int k = 0; k <= steps; ++k) {
        const double at = direction > 0 ? j.travel.min + k * step : j.travel.min + (steps - k) * step;
        // The device is set to zero where it begins.
        const double q = true_position(j, truth.joints[i], at, direction) - j.travel.min;
        print(out, "%s,%.4f,%.5f,%d\n", j.name.c_str(), at, q + noise(engine), direction);
      }
  }
  return out;
}

namespace {

/// Where the tool of the true machine is when the controller stands at `pose`.
struct TrueMachine {
  TrueMachine(const MachineDescription& b, const MachineDescription& t)
      : believed(b),
        truth(t),
        believed_kinematics(std::move(*make_kinematics(b))),
        true_kinematics(std::move(*make_kinematics(t))) {}

  std::optional<Pose> tool(const Pose& pose, const std::array<int, 4>& directions) const {
    JointVector joints{};
    if (!believed_kinematics->inverse(Frame::kPart, pose, joints)) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i)
      joints[i] = true_position(believed.joints[i], truth.joints[i], joints[i], directions[i]);
    Pose found = pose;
    if (!true_kinematics->forward(Frame::kPart, joints, found)) return std::nullopt;
    return found;
  }

  const MachineDescription &believed, &truth;
  std::unique_ptr<Kinematics> believed_kinematics, true_kinematics;
};

}  // namespace

std::string measure_points(const MachineDescription& believed, const MachineDescription& truth,
                           const std::vector<Pose>& poses, double noise_mm, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0, noise_mm);
  const TrueMachine machine(believed, truth);
  std::string out = "x_mm,y_mm,z_mm,a_deg,measured_x_mm,measured_y_mm,measured_z_mm,noise_um\n";
  for (const Pose& pose : poses) {
    const auto tool = machine.tool(pose, {1, 1, 1, 1});
    if (!tool) continue;
    print(out, "%.4f,%.4f,%.4f,%.5f,%.5f,%.5f,%.5f,%g\n", pose[kX], pose[kY], pose[kZ], pose[kA] / kRadPerDeg,
          (*tool)[kX] + noise(engine), (*tool)[kY] + noise(engine), (*tool)[kZ] + noise(engine),
          std::max(0.1, 1000 * noise_mm));
  }
  return out;
}

std::vector<Pose> random_poses(const MachineDescription& machine, int count, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  const auto kinematics = make_kinematics(machine);
  std::vector<Pose> out;
  if (!kinematics) return out;
  const PoseLimits limits = pose_limits(machine.kinematics) ? *pose_limits(machine.kinematics) : PoseLimits{};
  const double radius = limits.radius_mm > 0 ? limits.radius_mm : 100;
  const Interval z = limits.z_mm.limited() ? limits.z_mm : Interval{0, 200};
  for (int tries = 0; static_cast<int>(out.size()) < count && tries < 200 * count; ++tries) {
    const double r = radius * std::sqrt(uniform(0, 1)), f = uniform(-std::numbers::pi, std::numbers::pi);
    // Four digits, as a file of measurements states a pose.
    const auto digits = [](double v) { return std::round(v * 1e4) / 1e4; };
    const Pose pose{digits(r * std::cos(f)),
                    digits(r * std::sin(f)),
                    digits(uniform(z.min, z.max)),
                    digits(uniform(limits.a_rad.min, limits.a_rad.max) / kRadPerDeg) * kRadPerDeg,
                    0,
                    0};
    if ((*kinematics)->check(Frame::kPart, pose)) out.push_back(pose);
  }
  return out;
}

Accuracy accuracy(const MachineDescription& believed, const MachineDescription& truth, int poses,
                  std::uint64_t seed) {
  const TrueMachine machine(believed, truth);
  std::mt19937_64 engine(seed ^ 0x51ED270B9ULL);
  Accuracy a;
  double squares = 0;
  for (const Pose& pose : random_poses(believed, poses, seed)) {
    std::array<int, 4> directions{};
    for (int& d : directions) d = (engine() & 1) != 0 ? 1 : -1;
    const auto tool = machine.tool(pose, directions);
    if (!tool) continue;
    const double error = std::hypot((*tool)[kX] - pose[kX], (*tool)[kY] - pose[kY], (*tool)[kZ] - pose[kZ]);
    squares += error * error;
    a.worst_mm = std::max(a.worst_mm, error);
    ++a.poses;
  }
  a.rms_mm = a.poses > 0 ? std::sqrt(squares / a.poses) : 0;
  return a;
}

}  // namespace kinebus
