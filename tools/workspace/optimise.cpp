#include "tools/workspace/optimise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlopt.hpp>
#include <numbers>
#include <vector>

#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus::workspace {
namespace {

// x of the rails, y of the right and of the left ones; the same of the attachments; leg length.
constexpr std::size_t kUnknowns = 7;
using Unknowns = std::array<double, kUnknowns>;

double sign_of(double v) {
  return v < 0 ? -1 : 1;
}

Unknowns unknowns_of(const M1Geometry& g) {
  return {std::abs(g.legs[0].foot_mm[0]),
          std::abs(g.legs[0].foot_mm[1]),
          std::abs(g.legs[2].foot_mm[1]),
          std::abs(g.legs[0].attachment_mm[0]),
          std::abs(g.legs[0].attachment_mm[1]),
          std::abs(g.legs[2].attachment_mm[1]),
          g.legs[0].length_mm};
}

M1Geometry with(const M1Geometry& start, const Unknowns& u) {
  M1Geometry g = start;
  for (std::size_t i = 0; i < 4; ++i) {
    M1Leg& leg = g.legs[i];
    leg.foot_mm[0] = sign_of(leg.foot_mm[0]) * u[0];
    leg.foot_mm[1] = sign_of(leg.foot_mm[1]) * (i < 2 ? u[1] : u[2]);
    leg.attachment_mm[0] = sign_of(leg.attachment_mm[0]) * u[3];
    leg.attachment_mm[1] = sign_of(leg.attachment_mm[1]) * (i < 2 ? u[4] : u[5]);
    leg.length_mm = u[6];
  }
  return g;
}

}  // namespace

Fitness fitness(const M1Geometry& geometry, const Room& room) {
  Fitness f;
  M1Geometry g = geometry;
  g.limits = {};
  for (M1Leg& leg : g.legs) leg.travel_mm = {};
  g.max_condition = 1000;
  const double allowed_angle = g.max_leg_angle_rad, allowed_condition = geometry.max_condition;
  g.max_leg_angle_rad = std::numbers::pi / 2;
  for (const M1Leg& leg : g.legs)
    f.footprint_mm = std::max(f.footprint_mm, std::hypot(leg.foot_mm[0], leg.foot_mm[1]));
  f.cost = 1e6;
  const auto made = make_m1_kinematics(g);
  if (!made) return f;
  const Kinematics& kinematics = **made;
  int poses = 0, reached = 0;
  double beyond = 0;
  f.travel_mm = {1e9, -1e9};
  for (int z = 0; z <= 3; ++z)
    for (int tilt = 0; tilt <= 4; ++tilt)
      for (int ray = 0; ray < 12; ++ray)
        for (int radius = ray == 0 ? 0 : 1; radius <= 2; ++radius) {
          const double r = room.radius_mm * radius / 2, a = 2 * std::numbers::pi * ray / 12;
          const Pose pose{r * std::cos(a),
                          r * std::sin(a),
                          room.z_min_mm + (room.z_max_mm - room.z_min_mm) * z / 3,
                          room.tilt_min_rad + (room.tilt_max_rad - room.tilt_min_rad) * tilt / 4,
                          0,
                          0};
          ++poses;
          JointVector q{};
          if (const auto ok = kinematics.inverse(Frame::kPart, pose, q); !ok) {
            beyond += 1 + ok.error().amount / 100;
            continue;
          }
          // The leg's angle from how far the carriage is ahead of the platform joint along the rail.
          double angle = 0;
          const PlatformPose at = platform_at(g, Frame::kPart, pose);
          const double ca = std::cos(at.a_rad), sa = std::sin(at.a_rad);
          for (std::size_t i = 0; i < 4; ++i) {
            const M1Leg& leg = g.legs[i];
            const Vector3& b = leg.attachment_mm;
            const double p[3] = {at.p_mm[0] + b[0], at.p_mm[1] + ca * b[1] - sa * b[2],
                                 at.p_mm[2] + sa * b[1] + ca * b[2]};
            double along = 0;
            const double norm = std::hypot(leg.rail[0], leg.rail[1], leg.rail[2]);
            for (std::size_t k = 0; k < 3; ++k)
              along += (leg.foot_mm[k] + (q[i] + leg.connector_mm) * leg.rail[k] / norm - p[k]) *
                       leg.rail[k] / norm;
            angle = std::max(angle, std::acos(std::clamp(std::abs(along) / leg.length_mm, 0.0, 1.0)));
            f.travel_mm.min = std::min(f.travel_mm.min, q[i]);
            f.travel_mm.max = std::max(f.travel_mm.max, q[i]);
          }
          const double condition = kinematics.condition(Frame::kPart, pose);
          f.worst_condition = std::max(f.worst_condition, condition);
          f.worst_leg_angle_rad = std::max(f.worst_leg_angle_rad, angle);
          const bool good = angle <= allowed_angle && condition <= allowed_condition;
          reached += good ? 1 : 0;
          // A thousandth of a turn inside the rule, so that rounding leaves it kept; steep, since one pose in
          // hundreds that breaks it must cost more than shorter legs everywhere save.
          constexpr double kInside_rad = 2 * std::numbers::pi * 1e-3;
          if (angle > allowed_angle - kInside_rad) beyond += (angle - allowed_angle + kInside_rad) * 40;
          if (condition > allowed_condition) beyond += std::min(2.0, condition / allowed_condition - 1);
        }
  f.reached = static_cast<double>(reached) / poses;
  // First everything must be reached; then well conditioned, in a small frame with short rails.
  f.cost = 200 * beyond / poses + f.worst_condition + 0.004 * f.footprint_mm +
           0.002 * (f.travel_mm.max - f.travel_mm.min) + f.worst_leg_angle_rad;
  return f;
}

namespace {

struct Trials {
  const M1Geometry& start;
  const Room& room;
  int* tried;
};

double cost_of(unsigned count, const double* x, double*, void* trials) {
  const auto& t = *static_cast<const Trials*>(trials);
  ++*t.tried;
  Unknowns u{};
  std::copy_n(x, count, u.begin());
  return fitness(with(t.start, u), t.room).cost;
}

}  // namespace

Optimised optimise(const M1Geometry& start, const Room& room) {
  Optimised result;
  Unknowns best = unknowns_of(start);
  result.before = result.after = fitness(start, room);
  // The four legs share seven numbers here: the start itself is one of the candidates.
  Fitness value = fitness(with(start, best), room);
  // Subplex: simplices in a few unknowns at a time, which neither needs derivatives nor minds the kinks that
  // the worst pose makes.
  nlopt::opt search(nlopt::LN_SBPLX, kUnknowns);
  Trials trials{start, room, &result.tried};
  search.set_min_objective(cost_of, &trials);
  search.set_lower_bounds(10);
  search.set_initial_step({40, 40, 40, 15, 15, 15, 60});
  search.set_xtol_abs(0.25);
  search.set_maxeval(4000);
  std::vector<double> x(best.begin(), best.end());
  for (double& v : x) v = std::max(v, 10.0);
  double cost = 0;
  // A search that has stalled on the ridge of two rules goes on when its steps begin anew.
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const double before = cost;
    try {
      search.optimize(x, cost);
    } catch (const nlopt::roundoff_limited&) {
      // x is the best found until the steps drowned in rounding.
    }
    if (round > 0 && cost > 0.99 * before) break;
  }
  Unknowns found = best;
  std::copy(x.begin(), x.end(), found.begin());
  if (const Fitness f = fitness(with(start, found), room); f.cost < value.cost) {
    value = f;
    best = found;
  }
  if (value.cost > result.before.cost) {
    result.geometry = start;
    return result;
  }
  for (double& v : best) v = std::round(v * 2) / 2;
  result.geometry = with(start, best);
  result.after = fitness(result.geometry, room);
  constexpr double kSpare_mm = 10;
  for (M1Leg& leg : result.geometry.legs)
    leg.travel_mm = {std::floor(result.after.travel_mm.min - kSpare_mm),
                     std::ceil(result.after.travel_mm.max + kSpare_mm)};
  result.geometry.limits.radius_mm = room.radius_mm;
  result.geometry.limits.z_mm = {room.z_min_mm, room.z_max_mm};
  result.geometry.limits.a_rad = {room.tilt_min_rad, room.tilt_max_rad};
  return result;
}

std::string geometry_toml(const M1Geometry& g) {
  std::string out;
  char text[256];
  for (std::size_t i = 0; i < 4; ++i) {
    const M1Leg& leg = g.legs[i];
    std::snprintf(
        text, sizeof text,
        "[kinematics.leg%zu]\nfoot_mm = [%g, %g, %g]\nattachment_mm = [%g, %g, %g]\nlength_mm = %g\n"
        "connector_mm = %g\n# [joint.*] travel_mm = [%g, %g]\n\n",
        i + 1, leg.foot_mm[0], leg.foot_mm[1], leg.foot_mm[2], leg.attachment_mm[0], leg.attachment_mm[1],
        leg.attachment_mm[2], leg.length_mm, leg.connector_mm, leg.travel_mm.min, leg.travel_mm.max);
    out += text;
  }
  return out;
}

}  // namespace kinebus::workspace
