// The path of M4's table 4 (figure 10): where the mechanism loses control of the tool, which other assembly
// does not, and the shipped machine driving it.

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "gateway/kinematics/m4.hpp"
#include "gateway/kinematics/pose_limits.hpp"
#include "tools/paper_numbers/m4_path.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

constexpr int kSteps = 3000;

/// d(y1, y2, y3) / d(x, y, phi * scale), by differences of the closures.
struct Differential {
  double m[9]{};
  double determinant() const {
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
  }
};
std::optional<Differential> differential(const M4Geometry& g, const PlanarPose& p, const M4Build& build) {
  constexpr double h = 1e-3;
  const double turn = h / g.rotation_scale_mm;
  const PlanarPose ahead[] = {
      {p.x_mm + h, p.y_mm, p.phi_rad}, {p.x_mm, p.y_mm + h, p.phi_rad}, {p.x_mm, p.y_mm, p.phi_rad + turn}};
  const PlanarPose behind[] = {
      {p.x_mm - h, p.y_mm, p.phi_rad}, {p.x_mm, p.y_mm - h, p.phi_rad}, {p.x_mm, p.y_mm, p.phi_rad - turn}};
  Differential d;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto a = m4_blocks(g, ahead[k], build), b = m4_blocks(g, behind[k], build);
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

Survey survey(const M4Geometry& g, const M4Build& build) {
  Survey s;
  double before = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const double t = kM4PathEnd_s * k / kSteps;
    const auto d = differential(g, m4_path_at(t, build), build);
    const auto y = m4_blocks(g, m4_path_at(t, build), build);
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
      double low = t - kM4PathEnd_s / kSteps, high = t;
      for (int halving = 0; halving < 40; ++halving) {
        const double middle = (low + high) / 2;
        const auto there = differential(g, m4_path_at(middle, build), build);
        (there && there->determinant() * before > 0 ? low : high) = middle;
      }
      s.crossings_s.push_back(low);
    }
    before = determinant;
  }
  return s;
}

/// The paper's speed times this keeps the rails' limits of the file.
double fastest(const M4Geometry& g, const MachineDescription& machine, const M4Build& build) {
  double factor = HUGE_VAL;
  constexpr double h = 1e-3;
  for (int k = 1; k < kSteps; ++k) {
    const double t = kM4PathEnd_s * k / kSteps;
    const auto a = m4_blocks(g, m4_path_at(t - h, build), build),
               b = m4_blocks(g, m4_path_at(t, build), build),
               c = m4_blocks(g, m4_path_at(t + h, build), build);
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

}  // namespace

void m4_path(Table& table, const MachineDescription& machine, const std::string& folder) {
  const auto& g = std::get<M4Geometry>(machine.kinematics);
  double apart = 0, back = 0;
  for (int k = 0; k <= kSteps; ++k) {
    const PlanarPose p = m4_path_at(kM4PathEnd_s * k / kSteps);
    const auto here = m4_inputs(g, p);
    const auto follows = m4_blocks(g, p, {});
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
    const PlanarPose p = m4_path_at(t);
    table.note(
        printed("    not in the paper: singular at t = %.4f s, pose x %.2f, y %.2f mm, phi %.3f deg: with "
                "blocks at rest",
                t, p.x_mm, p.y_mm, p.phi_rad / kRadPerDeg) +
        " the tool can still move there");
  }
  table.note(
      "    speed does not help: the pose is singular however fast it is passed. Other assemblies on the same "
      "path of the tool:");
  const M4Build builds[] = {{1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}};
  constexpr const char* kNames[] = {"block 2 below the tool", "block 1 below the tool", "both blocks below"};
  const auto say_survey = [&](const std::string& name, const M4Build& build) {
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
  const M4Drive drive = drive_m4_path(machine);
  table.note("    pre-flight of the path on the paper's own assembly: " + drive.refusal);
  table.note(
      printed("    run on the whole simulated machine, m4.toml as shipped: %s, from rest to rest in %.3f s "
              "(the paper's path, never at rest: %.0f s)",
              drive.outcome.c_str(), drive.duration_s, kM4PathEnd_s));
  table.ours("      its blocks are off figure 10's curves of that assembly by", drive.off_um, 10, "um");
  table.ours("      fastest block over what its rail may do", drive.speed_ratio, 1.001, "");
  if (folder.empty()) return;
  write_text(folder, "m4-path.ngc", m4_path_job(g));
  write_picture(folder, "m4-figure10.svg",
                draw_figure10(g, paper.crossings_s, builds[0], drive.blocks_driven));
}

}  // namespace kinebus::papers
