#include "gateway/kinematics/m1_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinebus {
namespace m1_geometry {

std::optional<Sentence> wrong_numbers(const M1Geometry& g) {
  for (std::size_t i = 0; i < g.legs.size(); ++i) {
    const M1Leg& leg = g.legs[i];
    const Sentence name = say("leg %1", i + 1);
    for (const Vector3& v : {leg.foot_mm, leg.rail, leg.attachment_mm})
      for (const double x : v)
        if (!std::isfinite(x)) return say("%1: a coordinate is not a number", name);
    if (!(leg.length_mm > 0) || !std::isfinite(leg.length_mm))
      return say("%1: its length must be above 0 mm", name);
    if (!(std::hypot(leg.rail[0], leg.rail[1], leg.rail[2]) > 0))
      return say("%1: its rail has no direction", name);
    if (!std::isfinite(leg.connector_mm)) return say("%1: its connector offset is not a number", name);
    if (!(leg.travel_mm.min <= leg.travel_mm.max))
      return say("%1: its travel's minimum is above the maximum", name);
  }
  for (const Interval& i : {g.limits.x_mm, g.limits.y_mm, g.limits.z_mm, g.limits.a_rad, g.limits.c_rad})
    if (!(i.min <= i.max)) return say("a pose limit's minimum is above its maximum");
  for (const Vector3& v : {g.nozzle_mm, g.table_mm})
    for (const double x : v)
      if (!std::isfinite(x)) return say("tool or table position is not a number");
  if (!(g.rotation_scale_mm > 0)) return say("rotation_scale_mm must be above 0");
  if (!(g.max_condition >= 1)) return say("max_condition must be 1 or more");
  return std::nullopt;
}

std::optional<Sentence> wrong_everywhere(const Kinematics& m1, const M1Geometry& g) {
  const auto sample = [](const Interval& limits, double otherwise, int k, int n) {
    const Interval i = limits.limited() ? limits : Interval{-otherwise, otherwise};
    return i.min + (i.max - i.min) * k / n;
  };
  const double radius = g.limits.radius_mm > 0 ? g.limits.radius_mm : 100;
  int reached = 0;
  double best = std::numeric_limits<double>::infinity();
  for (int z = 0; z <= 4; ++z)
    for (int a = 0; a <= 4; ++a)
      for (int k = 0; k <= 12; ++k) {
        // Poses off every plane of symmetry, so that a mirror's own plane does not stand for the whole
        // workspace.
        const double angle = 0.3 + k * (2 * std::numbers::pi / 12.7),
                     r = k == 0 ? 0 : radius * (0.2 + 0.04 * k);
        const Pose pose{r * std::cos(angle),
                        r * std::sin(angle),
                        sample(g.limits.z_mm, 100, z, 4),
                        sample(g.limits.a_rad, 0.5, a, 4) * 0.97,
                        0,
                        0};
        JointVector joints{};
        if (!m1.inverse(Frame::kPart, pose, joints)) continue;
        ++reached;
        best = std::min(best, m1.condition(Frame::kPart, pose));
      }
  if (reached == 0)
    return say("no pose of the workspace can be reached: the legs are too short or the rails too far away");
  if (best <= g.max_condition) return std::nullopt;
  return say(
      "the mechanism is singular or nearly so at every pose: the best condition number in the workspace is "
      "%1, the limit is %2; rails and attachments leave one motion of the platform without control (for "
      "instance attachments mirrored about the YZ plane)",
      printed("%.3g", best), printed("%.3g", g.max_condition));
}

}  // namespace m1_geometry

M1Geometry corrected(const M1Geometry& nominal, const M1Correction& correction) {
  M1Geometry g = nominal;
  for (std::size_t i = 0; i < g.legs.size(); ++i) {
    M1Leg& leg = g.legs[i];
    const M1LegCorrection& c = correction.legs[i];
    const double norm = std::hypot(leg.rail[0], leg.rail[1], leg.rail[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      leg.foot_mm[k] += c.foot_mm[k];
      leg.rail[k] = leg.rail[k] / norm + c.rail[k];
      leg.attachment_mm[k] += c.attachment_mm[k];
    }
    const double again = std::hypot(leg.rail[0], leg.rail[1], leg.rail[2]);
    for (double& v : leg.rail) v /= again;
    leg.length_mm += c.length_mm;
  }
  return g;
}

}  // namespace kinebus
