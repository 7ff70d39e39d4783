#include "gateway/machine/manual_motion.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// Between two poses of a jog: the workspace is checked so often.
constexpr double kCheckStep = 1.0;  // mm
constexpr double kCheckStepRad = 0.01;

constexpr double kDefaultJogSpeed = 20;       // mm/s
constexpr double kDefaultTurnSpeed = 0.3;     // rad/s
constexpr double kDefaultExtrusionSpeed = 3;  // mm/s of filament

}  // namespace

Result<canonical::Command, Refusal> ManualMotion::jog(const command::Jog& asked, const Pose& from,
                                                      const Heat& heat) {
  const Pose& d = asked.delta;
  for (const double value : d)
    if (!std::isfinite(value)) return refused(say("a jog needs numbers"));
  if (!std::isfinite(asked.speed_per_s) || asked.speed_per_s < 0)
    return refused(say("a jog's speed is 0 or more"));
  const double mm = std::sqrt(d[kX] * d[kX] + d[kY] * d[kY] + d[kZ] * d[kZ]);
  const double rad = std::max(std::abs(d[kA]), std::abs(d[kC]));
  if (mm == 0 && rad == 0 && d[kE] == 0) return refused(say("a jog needs a distance"));
  if (d[kE] > 0)
    if (auto cold = heat.too_cold()) return refused(std::move(*cold));
  const double steps = std::clamp(std::ceil(std::max(mm / kCheckStep, rad / kCheckStepRad)), 1.0, 2000.0);
  const auto at = [&](double i) {
    Pose pose = from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) pose[axis] += d[axis] * i / steps;
    return pose;
  };
  way_.jump();
  const bool stands_well =
      kinematics_.check(Frame::kMachine, from) && !way_.collision(Frame::kMachine, 0, 0, at);
  for (double i = 1; i <= steps && (mm > 0 || rad > 0); ++i)
    if (auto broken = way_.broken(Frame::kMachine, i - 1, i, at))
      return refused(stands_well ? std::move(*broken)
                                 : say("%1: go to the bed reference first", std::move(*broken)));
  Pose target = from;
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis) target[axis] += d[axis];
  double speed = asked.speed_per_s;
  if (speed == 0) speed = mm > 0 ? kDefaultJogSpeed : rad > 0 ? kDefaultTurnSpeed : kDefaultExtrusionSpeed;
  return canonical::Feed{.target = target, .frame = Frame::kMachine, .feed_per_s = speed};
}

canonical::Command ManualMotion::reference(const Pose& from) const {
  Pose target = kinematics_.bed_reference();
  target[kE] = from[kE];
  return canonical::Traverse{target, Frame::kMachine};
}

std::optional<Sentence> ManualMotion::in_the_way_to_reference(const Pose& from) {
  const Pose to = kinematics_.bed_reference();
  double mm = 0, rad = 0;
  for (const PoseAxis axis : {kX, kY, kZ}) mm = std::hypot(mm, to[axis] - from[axis]);
  for (const PoseAxis axis : {kA, kC}) rad = std::max(rad, std::abs(to[axis] - from[axis]));
  const double steps = std::clamp(std::ceil(std::max(mm / kCheckStep, rad / kCheckStepRad)), 1.0, 20000.0);
  const auto at = [&](double i) {
    Pose pose = from;
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) pose[axis] += (to[axis] - from[axis]) * i / steps;
    return pose;
  };
  way_.jump();
  bool leaving = true;  // what is near at the beginning
  for (double i = 0; i <= steps; ++i) {
    auto near = way_.collision(Frame::kMachine, std::max(i - 1, 0.0), i, at);
    if (near && !leaving) return near;
    leaving = leaving && near;
  }
  return std::nullopt;
}

void ManualMotion::start(std::vector<canonical::Line> commands, const Pose& from, double override_ratio,
                         Then then) {
  then_ = then;
  runner_.start_commands(std::move(commands), from);
  runner_.set_override(override_ratio);
}

}  // namespace kinebus
