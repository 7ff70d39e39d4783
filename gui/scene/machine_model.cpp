#include "gui/scene/machine_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

/// Leg vector from the platform's joint to the carriage's joint has this angle to its rail; 0 when upright.
double leg_angle_rad(double along_mm, double length_mm) {
  return std::acos(std::clamp(std::abs(along_mm) / length_mm, 0.0, 1.0));
}

double share_of(const Range& range, double value) {
  const double half = (range.max - range.min) / 2;
  if (!(half > 0)) return 1;
  return std::clamp(std::min(value - range.min, range.max - value) / half, 0.0, 1.0);
}

/// Platform's joint seen from the rail's foot.
Vec3 joint_from_foot(const MachineModel& m, const MachineModel::Leg& leg, const PartPose& pose) {
  if (m.kind == MachineModel::Kind::kLinearDelta) return pose.q_mm + leg.attachment_mm - leg.foot_mm;
  return m.platform_mm(pose) + turn_x(pose.a_rad, leg.attachment_mm) - leg.foot_mm;
}

}  // namespace

Vec3 MachineModel::platform_mm(const PartPose& pose) const {
  return nozzle_mm - turn_x(pose.a_rad, turn_z(pose.c_rad, pose.q_mm));
}

std::optional<std::array<double, 4>> MachineModel::carriages_mm(const PartPose& pose) const {
  std::array<double, 4> travel{};
  for (std::size_t i = 0; i < legs.size() && i < travel.size(); ++i) {
    const Leg& leg = legs[i];
    const Vec3 s = joint_from_foot(*this, leg, pose);
    const double along = dot(leg.rail, s);
    const double radicand = leg.length_mm * leg.length_mm - dot(s, s) + along * along;
    if (radicand < 0) return std::nullopt;
    travel[i] = along - leg.connector_mm + (leg.carriage_above ? 1 : -1) * std::sqrt(radicand);
  }
  return travel;
}

double MachineModel::margin(const PartPose& pose) const {
  double least = share_of(z_mm, pose.q_mm[2] + (z_mm.max - z_mm.min) * 0.02);
  if (round())
    least = std::min(least, std::clamp(1 - std::hypot(pose.q_mm[0], pose.q_mm[1]) / radius_mm, 0.0, 1.0));
  else
    least = std::min({least, share_of(x_mm, pose.q_mm[0]), share_of(y_mm, pose.q_mm[1])});
  if (legs.empty()) return least;
  const auto travel = carriages_mm(pose);
  if (!travel) return 0;
  for (std::size_t i = 0; i < legs.size() && i < travel->size(); ++i) {
    const Leg& leg = legs[i];
    least = std::min(least, share_of(leg.travel_mm, (*travel)[i]));
    const Vec3 s = joint_from_foot(*this, leg, pose);
    const double along = dot(leg.rail, s) - (*travel)[i] - leg.connector_mm;
    least = std::min(least,
                     std::clamp(1 - leg_angle_rad(along, leg.length_mm) / max_leg_angle_rad, 0.0, 1.0) * 2);
  }
  return std::clamp(least, 0.0, 1.0);
}

}  // namespace kinebus::gui
