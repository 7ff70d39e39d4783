#include "tools/compose/arms.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace kinebus::compose {
namespace {

constexpr double kStepOfWidth = 0.12;
constexpr double kTurnOfAStep_rad = 0.2;
constexpr double kWider = 1.3;  // than just before: there the arm ends in a body
constexpr int kMostSteps = 2000;
constexpr double kOnBase_mm = 0.5;
// Near a tip sections that cut its edge off are smaller than those square to the arm.
constexpr double kTipOfWidth = 0.5;
constexpr double kShortestStretchOfWidth = 0.6;
constexpr double kSmoothOfWidth = 0.25;  // to either side: round bends come in facets
constexpr double kPlate = 2;             // sections of a plate are this much longer than a square's side
constexpr double kLikeBase_rad = 0.01;

struct Walk {
  std::vector<ArmPoint> line;
  bool free = false;  // it ends in the air, or on the base
};

Walk walk(const Sections& sections, const ArmPoint& from, double sign) {
  Walk out;
  ArmPoint here = from;
  here.along *= sign;
  double usual_mm2 = here.area_mm2;
  const double step_mm = std::clamp(kStepOfWidth * std::sqrt(from.area_mm2), 0.2, 4.0);
  for (int i = 0; i < kMostSteps; ++i) {
    const auto next = sections.smallest_near(here.at + step_mm * here.along, here.along, kTurnOfAStep_rad);
    if (!next) {
      out.free = true;
      break;
    }
    if (next->section.area_mm2 > kWider * usual_mm2) break;
    const Vector moved = next->section.centre - here.at;
    if (moved.dot(here.along) < 0.2 * step_mm) break;
    here = {next->section.centre, next->normal, next->section.area_mm2, next->section.extent_mm};
    usual_mm2 += 0.15 * (here.area_mm2 - usual_mm2);
    out.line.push_back(here);
  }
  if (out.free) {
    const double last = kTipOfWidth * std::sqrt(usual_mm2);
    const Vector tip = here.at;
    std::size_t first = out.line.size();
    while (first > 0 && (out.line[first - 1].at - tip).norm() < last) --first;
    for (std::size_t i = first; i < out.line.size(); ++i)
      out.line[i].along = first > 0 ? out.line[first - 1].along : Vector(sign * from.along);
  }
  return out;
}

double angle_between(const Vector& a, const Vector& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

double Arm::width_mm() const {
  return std::sqrt(line[line.size() / 2].area_mm2);
}

double Arm::length_mm() const {
  double sum = 0;
  for (std::size_t i = 1; i < line.size(); ++i) sum += (line[i].at - line[i - 1].at).norm();
  return sum;
}

Vector Arm::where(const Plane& plane) const {
  const auto straight_on = [&](const ArmPoint& p) {
    const double slope = plane.normal.dot(p.along);
    return std::abs(slope) < 0.05 ? p.at : Vector(p.at - plane.over(p.at) / slope * p.along);
  };
  if (plane.over(line.front().at) > 0) return straight_on(line.front());
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double a = plane.over(line[i - 1].at), b = plane.over(line[i].at);
    if (a <= 0 && b > 0) return line[i - 1].at + a / (a - b) * (line[i].at - line[i - 1].at);
  }
  return straight_on(line.back());
}

std::optional<Arm> arm_around(const Solid& solid, const Sections& sections, const Vector& inside) {
  auto middle = sections.smallest(inside);
  for (int i = 0; i < 4 && middle; ++i)
    middle = sections.smallest_near(middle->section.centre, middle->normal, std::numbers::pi);
  if (!middle) return {};
  const ArmPoint start{middle->section.centre, middle->normal, middle->section.area_mm2,
                       middle->section.extent_mm};
  Walk one = walk(sections, start, -1), other = walk(sections, start, 1);
  if (!one.free && !other.free) return {};
  const auto on_base = [&](const Walk& walked) {
    const ArmPoint& end = walked.line.empty() ? start : walked.line.back();
    return walked.free && solid.base.over(end.at) < kOnBase_mm + kStepOfWidth * std::sqrt(end.area_mm2) * 1.5;
  };
  // The root: on the base, else where it ends in a body.
  const bool other_is_root = on_base(other) || (!on_base(one) && !other.free);
  if (other_is_root) std::swap(one, other);
  Arm arm;
  arm.from_base = on_base(one);
  if (one.free && !arm.from_base) return {};  // it touches nothing
  const double sign = other_is_root ? -1 : 1;
  for (auto p = one.line.rbegin(); p != one.line.rend(); ++p)
    arm.line.push_back({p->at, -p->along, p->area_mm2, p->extent_mm});
  arm.line.push_back({start.at, sign * start.along, start.area_mm2, start.extent_mm});
  arm.line.insert(arm.line.end(), other.line.begin(), other.line.end());
  double widest_mm = 0;
  for (const ArmPoint& p : arm.line) widest_mm = std::max(widest_mm, p.extent_mm);
  const bool plate = arm.line[arm.line.size() / 2].extent_mm > kPlate * arm.width_mm();
  if (arm.line.size() < 3 || plate || arm.length_mm() < widest_mm) return {};
  return arm;
}

Vector tilted_at_most(const Vector& along, double max_tilt_rad) {
  const double level = std::hypot(along[0], along[1]);
  if (std::atan2(level, along[2]) <= max_tilt_rad || level < 1e-9) return along;
  const double s = std::sin(max_tilt_rad) / level;
  return {along[0] * s, along[1] * s, std::cos(max_tilt_rad)};
}

std::vector<Stretch> stretches(const Arm& arm, const Vector& base_normal, double bend_rad,
                               double max_tilt_rad) {
  std::vector<double> from_root_mm{0};
  for (std::size_t i = 1; i < arm.line.size(); ++i)
    from_root_mm.push_back(from_root_mm.back() + (arm.line[i].at - arm.line[i - 1].at).norm());
  std::vector<Vector> wanted;
  const double reach_mm = kSmoothOfWidth * arm.width_mm();
  for (std::size_t i = 0; i < arm.line.size(); ++i) {
    Vector sum = Vector::Zero();
    for (std::size_t k = 0; k < arm.line.size(); ++k)
      if (std::abs(from_root_mm[k] - from_root_mm[i]) <= reach_mm) sum += arm.line[k].along;
    Vector along = tilted_at_most(sum.normalized(), max_tilt_rad);
    if (angle_between(along, base_normal) < kLikeBase_rad) along = base_normal;
    wanted.push_back(along);
  }
  // From the root on, each as far as its direction serves.
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < wanted.size();) {
    // As far as one direction serves all of it: none is farther from the middle one than allowed.
    const bool keeps = arm.from_base && i == 0;
    std::size_t k = i + 1;
    while (k < wanted.size() &&
           angle_between(keeps ? base_normal : wanted[i], wanted[k]) <= (keeps ? 1 : 2) * bend_rad)
      ++k;
    out.push_back({i, base_normal});
    i = k;
  }
  // Those too short to be worth a turn of the table go half to either neighbour.
  const double shortest_mm = kShortestStretchOfWidth * arm.width_mm();
  const auto end_mm = [&](std::size_t k) {
    return k + 1 < out.size() ? from_root_mm[out[k + 1].first] : from_root_mm.back();
  };
  while (out.size() > 1) {
    std::size_t least = out.size();
    double least_mm = shortest_mm;
    for (std::size_t k = arm.from_base ? 1 : 0; k < out.size(); ++k)
      if (const double length = end_mm(k) - from_root_mm[out[k].first]; length < least_mm)
        least = k, least_mm = length;
    if (least == out.size()) break;
    if (least == 0) {
      out[1].first = 0;
    } else if (least + 1 < out.size()) {
      out[least + 1].first = (out[least].first + out[least + 1].first) / 2;
    }
    out.erase(out.begin() + static_cast<std::ptrdiff_t>(least));
  }
  for (std::size_t k = arm.from_base ? 1 : 0; k < out.size(); ++k) {
    const std::size_t end = k + 1 < out.size() ? out[k + 1].first : wanted.size();
    out[k].normal = wanted[(out[k].first + end) / 2];
  }
  return out;
}

}  // namespace kinebus::compose
