#include "gui/scene/machine_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

double share_of(const Range& range, double value) {
  const double half = (range.max - range.min) / 2;
  if (!(half > 0)) return 1;
  return std::clamp(std::min(value - range.min, range.max - value) / half, 0.0, 1.0);
}

/// A leg's platform joint as its rail sees it.
struct LegPlace {
  double along_mm = 0;      ///< the rail, from its foot
  double radicand_mm2 = 0;  ///< square of what of the leg lies along the rail; < 0: out of reach
};

/// For each leg, in their order: `take(index, place)`; until it says no. One sine and cosine an angle.
template <typename Take>
bool each_leg(const MachineModel& m, const PartPose& pose, Take take) {
  const bool delta = m.kind == MachineModel::Kind::kLinearDelta;
  const MachineModel::Platform platform = delta ? MachineModel::Platform{pose.q_mm, 0} : m.platform(pose);
  const double c = delta ? 1 : std::cos(platform.a_rad), s = delta ? 0 : std::sin(platform.a_rad);
  for (std::size_t i = 0; i < m.legs.size() && i < 4; ++i) {
    const MachineModel::Leg& leg = m.legs[i];
    const Vec3& at = leg.attachment_mm;
    const Vec3 joint =
        platform.p_mm + Vec3{at[0], c * at[1] - s * at[2], s * at[1] + c * at[2]} - leg.foot_mm;
    const double along = dot(leg.rail, joint);
    if (!take(i, LegPlace{along, leg.length_mm * leg.length_mm - dot(joint, joint) + along * along}))
      return false;
  }
  return true;
}

double carriage_mm(const MachineModel::Leg& leg, const LegPlace& place, double upright_mm) {
  return place.along_mm - leg.connector_mm + (leg.carriage_above ? 1 : -1) * upright_mm;
}

}  // namespace

MachineModel::Platform MachineModel::platform(const PartPose& pose) const {
  const Vec3 q = turn_z(pose.c_rad, pose.q_mm);
  if (tool_on_platform) return {table_mm + q - turn_x(-pose.a_rad, nozzle_mm), -pose.a_rad};
  return {nozzle_mm - turn_x(pose.a_rad, q), pose.a_rad};
}

std::optional<std::array<double, 4>> MachineModel::carriages_mm(const PartPose& pose) const {
  std::array<double, 4> travel{};
  const bool reached = each_leg(*this, pose, [&](std::size_t i, const LegPlace& place) {
    travel[i] = carriage_mm(legs[i], place, std::sqrt(std::max(0.0, place.radicand_mm2)));
    return place.radicand_mm2 >= 0;
  });
  return reached ? std::optional(travel) : std::nullopt;
}

double MachineModel::margin(const PartPose& pose) const {
  std::optional<std::array<double, 4>> travel;
  return margin(pose, travel);
}

double MachineModel::margin(const PartPose& pose, std::optional<std::array<double, 4>>& travel_mm) const {
  double least = share_of(z_mm, pose.q_mm[2] + (z_mm.max - z_mm.min) * 0.02);
  if (round())
    least = std::min(least, std::clamp(1 - std::hypot(pose.q_mm[0], pose.q_mm[1]) / radius_mm, 0.0, 1.0));
  else
    least = std::min({least, share_of(x_mm, pose.q_mm[0]), share_of(y_mm, pose.q_mm[1])});
  travel_mm.reset();
  if (legs.empty()) return least;
  std::array<double, 4> travel{};
  double cosine = 1;  // of the leg that leans most
  const bool reached = each_leg(*this, pose, [&](std::size_t i, const LegPlace& place) {
    if (place.radicand_mm2 < 0) return false;
    const double upright = std::sqrt(place.radicand_mm2);
    travel[i] = carriage_mm(legs[i], place, upright);
    least = std::min(least, share_of(legs[i].travel_mm, travel[i]));
    cosine = std::min(cosine, upright / legs[i].length_mm);
    return true;
  });
  if (!reached) return 0;
  travel_mm = travel;
  least = std::min(least, std::clamp(1 - std::acos(cosine) / max_leg_angle_rad, 0.0, 1.0) * 2);
  return std::clamp(least, 0.0, 1.0);
}

}  // namespace kinebus::gui
