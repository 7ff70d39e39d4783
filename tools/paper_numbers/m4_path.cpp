// The path of M4's table 4 and its figure 10: blocks over time, where the mechanism loses control of the
// tool, and which other assembly does not.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "gateway/kinematics/m4.hpp"
#include "gateway/kinematics/pose_limits.hpp"
#include "tools/drawing/chart.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

using drawing::Point;

constexpr double kEnd_s = 3;
constexpr int kSteps = 3000;

/// How the mechanism is put together: blocks above (+1) or below (-1) the tool, the triangle turned against
/// the tool, rad.
struct Build {
  double side1 = 1, side2 = 1, turned_rad = 0;
};

PlanarPose at(double t, const Build& build = {}) {
  return {200 * std::cos(t), 100 + 200 * std::sin(t), -0.3 + 0.2 * t + build.turned_rad};
}

/// The paper's closures: blocks for a pose. nullopt: a rod is too short.
std::optional<Vector3> blocks(const M4Geometry& g, const PlanarPose& p, const Build& build) {
  const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), l = g.triangle_mm / 2;
  const double h1 = p.x_mm - l * c + g.rails_mm / 2, h2 = p.x_mm + l * c - g.rails_mm / 2;
  if (std::abs(h1) >= g.rod_mm || std::abs(h2) >= g.rod_mm) return std::nullopt;
  return Vector3{p.y_mm - l * s + build.side1 * std::sqrt(g.rod_mm * g.rod_mm - h1 * h1),
                 p.y_mm + l * s + build.side2 * std::sqrt(g.rod_mm * g.rod_mm - h2 * h2),
                 p.y_mm + std::sqrt(3.0) * l * c};
}

/// d(y1, y2, y3) / d(x, y, phi * scale), by differences of the closures.
struct Differential {
  double m[9]{};
  double determinant() const {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
  }
};
std::optional<Differential> differential(const M4Geometry& g, const PlanarPose& p, const Build& build) {
  constexpr double h = 1e-3;
  const double turn = h / g.rotation_scale_mm;
  const PlanarPose ahead[] = {
      {p.x_mm + h, p.y_mm, p.phi_rad}, {p.x_mm, p.y_mm + h, p.phi_rad}, {p.x_mm, p.y_mm, p.phi_rad + turn}};
  const PlanarPose behind[] = {
      {p.x_mm - h, p.y_mm, p.phi_rad}, {p.x_mm, p.y_mm - h, p.phi_rad}, {p.x_mm, p.y_mm, p.phi_rad - turn}};
  Differential d;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = blocks(g, ahead[k], build), b = blocks(g, behind[k], build);
    if (!a || !b) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) d.m[3 * i + k] = ((*a)[i] - (*b)[i]) / (2 * h);
  }
  return d;
}

struct Survey {
  bool reached = true;
  std::vector<double> crossings_s;  ///< the determinant changes sign
  double worst_condition = 0, worst_s = 0;
  Interval used[3]{{1e9, -1e9}, {1e9, -1e9}, {1e9, -1e9}};
};

Survey survey(const M4Geometry& g, const Build& build) {
  Survey s;
  double before = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double t = kEnd_s * k / kSteps;
    const auto d = differential(g, at(t, build), build);
    const auto y = blocks(g, at(t, build), build);
    if (!d || !y) {
      s.reached = false;
      return s;
    }
    for (std::size_t i = 0; i < 3; ++i)
      s.used[i] = {std::min(s.used[i].min, (*y)[i]), std::max(s.used[i].max, (*y)[i])};
    const double determinant = d->determinant(), condition = condition_number(d->m, 3);
    if (condition > s.worst_condition) {
      s.worst_condition = condition;
      s.worst_s = t;
    }
    if (k > 0 && determinant * before < 0) {
      double low = t - kEnd_s / kSteps, high = t;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = (low + high) / 2;
        const auto there = differential(g, at(middle, build), build);
        (there && there->determinant() * before > 0 ? low : high) = middle;
      }
      s.crossings_s.push_back(low);
    }
    before = determinant;
  }
  return s;
}

/// The paper's speed times this keeps the rails' limits of the file.
double fastest(const M4Geometry& g, const MachineDescription& machine, const Build& build) {
  double factor = HUGE_VAL;
  constexpr double h = 1e-3;
  for (int k = 1; k < kSteps; ++k) {
    const double t = kEnd_s * k / kSteps;
    const auto a = blocks(g, at(t - h, build), build), b = blocks(g, at(t, build), build),
               c = blocks(g, at(t + h, build), build);
    if (!a || !b || !c) return 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double speed = std::abs((*c)[i] - (*a)[i]) / (2 * h);
      const double acceleration = std::abs((*c)[i] - 2 * (*b)[i] + (*a)[i]) / (h * h);
      factor = std::min({factor, machine.joints[i].speed_per_s / std::max(speed, 1e-9),
                         std::sqrt(machine.joints[i].accel_per_s2 / std::max(acceleration, 1e-9))});
    }
  }
  return factor;
}

std::string draw_figure10(const M4Geometry& g, const std::vector<double>& crossings_s, const Build& other) {
  drawing::Document document(1180, 560);
  document.heading(
      40, "M4: blocks along the path of table 4 (the paper's figure 10)",
      "x = 200 cos t, y = 100 + 200 sin t mm, phi = -0.3 + 0.2 t. Dashed: y2 with block 2 below the "
      "tool, which meets no singular pose.");
  double low = 1e9, high = -1e9;
  std::vector<Point> curve[4];
  for (int k = 0; k <= 300; ++k) {
    const double t = kEnd_s * k / 300;
    const auto y = blocks(g, at(t), {}), below = blocks(g, at(t, other), other);
    if (!y || !below) continue;
    for (std::size_t i = 0; i < 3; ++i) curve[i].push_back({t, (*y)[i]});
    curve[3].push_back({t, (*below)[1]});
    low = std::min({low, (*y)[0], (*y)[1], (*y)[2], (*below)[1]});
    high = std::max({high, (*y)[0], (*y)[1], (*y)[2], (*below)[1]});
  }
  const double step = drawing::round_step(high - low, 8);
  const drawing::Chart chart{
      {90, 120, 1040, 370}, 0, kEnd_s, step * std::floor(low / step), step * std::ceil(high / step)};
  drawing::draw_frame(document, chart, {.x_step = 0.5, .y_step = step, .x_name = "t, s", .y_name = "mm"});
  constexpr const char* kColours[] = {"#29788e", "#e07b39", "#6a4c93"};
  for (std::size_t i = 0; i < 3; ++i) drawing::draw_curve(document, chart, curve[i], kColours[i], 2.5);
  std::vector<Point> dashed;
  for (const Point& p : curve[3]) dashed.push_back(chart.at(p.x, p.y));
  document.polyline(dashed, {.stroke = kColours[1], .width = 2, .dash = "7 5"});
  for (const double t : crossings_s) {
    document.line(chart.at(t, chart.y_low), chart.at(t, chart.y_high),
                  {.stroke = "#b3261e", .width = 1.5, .dash = "4 4"});
    const Point top = chart.at(t, chart.y_high);
    document.text({top.x + 8, top.y + 18}, printed("singular at t = %.3f s", t),
                  {.fill = "#b3261e", .halo = "white"});
  }
  drawing::draw_legend(
      document, {1130, 104},
      std::vector<drawing::LegendEntry>{{"y1", kColours[0]}, {"y2", kColours[1]}, {"y3", kColours[2]}});
  return document.svg();
}

}  // namespace

void m4_path(Table& table, const MachineDescription& machine, const std::string& folder) {
  const auto& g = std::get<M4Geometry>(machine.kinematics);
  double apart = 0, back = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const PlanarPose p = at(kEnd_s * k / kSteps);
    const auto here = m4_inputs(g, p);
    const auto follows = blocks(g, p, {});
    if (!here || !follows) {
      apart = HUGE_VAL;
      break;
    }
    for (std::size_t i = 0; i < 3; ++i) apart = std::max(apart, std::abs((*here)[i] - (*follows)[i]));
    if (k % 20 != 0) continue;
    double nearest = HUGE_VAL;
    for (const M4Assembly& a : m4_assemblies(g, *here))
      if (a.physical()) nearest = std::min(nearest, std::hypot(a.pose.x_mm - p.x_mm, a.pose.y_mm - p.y_mm));
    back = std::max(back, nearest);
  }
  table.note("path of table 4: x = 200 cos t, y = 100 + 200 sin t mm, phi = -0.3 + 0.2 t, t = 0 .. 3 s");
  table.compare("    y1, y2, y3 (figure 10) are off the closures by", {}, 0, apart, 1e-9, "mm");
  table.ours("    its poses found again by elimination, off by", back, 1e-6, "mm");
  const Survey paper = survey(g, {});
  for (std::size_t i = 0; i < 3; ++i)
    table.note(printed("    y%zu runs from %.1f to %.1f mm", i + 1, paper.used[i].min, paper.used[i].max));
  for (const double t : paper.crossings_s) {
    const PlanarPose p = at(t);
    table.note(
        printed("    not in the paper: singular at t = %.4f s, pose x %.2f, y %.2f mm, phi %.3f deg: with "
                "blocks at rest",
                t, p.x_mm, p.y_mm, p.phi_rad / kRadPerDeg) +
        " the tool can still move there");
  }
  table.note(
      "    speed does not help: the pose is singular however fast it is passed. Other assemblies on the same "
      "path of the tool:");
  const Build builds[] = {{1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}};
  constexpr const char* kNames[] = {"block 2 below the tool", "block 1 below the tool", "both blocks below"};
  const auto say_survey = [&](const std::string& name, const Build& build) {
    const Survey s = survey(g, build);
    if (!s.reached) {
      table.note("      " + name + ": out of reach");
      return;
    }
    std::string words = "      " + name + ": ";
    if (s.crossings_s.empty())
      words += printed(
          "no singular pose; condition number %.3g at most (t = %.3f s), %.2f of the paper's speed "
          "within the file's rails",
          s.worst_condition, s.worst_s, std::min(1.0, fastest(g, machine, build)));
    else
      words += printed("singular at t = %.4f s", s.crossings_s.front());
    table.note(words);
  };
  for (std::size_t k = 0; k < std::size(builds); ++k) say_survey(kNames[k], builds[k]);
  // The triangle mounted turned against the tool, as the shipped file has it: the least angle that does.
  std::optional<double> least;
  for (int degrees = 1; degrees <= 90 && !least; ++degrees)
    for (const double way : {1.0, -1.0}) {
      const Survey s = survey(g, {1, 1, way * degrees * kRadPerDeg});
      if (!least && s.reached && s.crossings_s.empty() && s.worst_condition <= g.max_condition)
        least = way * degrees;
    }
  if (least)
    say_survey(
        printed("blocks above, the triangle mounted %.0f deg to the tool (the least that keeps the file's "
                "condition number)",
                *least),
        {1, 1, *least * kRadPerDeg});
  say_survey(printed("blocks above, the triangle mounted %.0f deg to the tool, as the file has it",
                     g.spindle_rad / kRadPerDeg),
             {1, 1, g.spindle_rad});
  if (!folder.empty())
    write_picture(folder, "m4-figure10.svg", draw_figure10(g, paper.crossings_s, builds[0]));
}

}  // namespace kinebus::papers
