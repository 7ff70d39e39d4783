// M4: table 6, and the path of table 4.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "gateway/kinematics/m4.hpp"
#include "tools/paper_numbers/numbers.hpp"

namespace kinebus::papers {
namespace {

struct PrintedRow {
  double phi_deg, y_mm, x_mm;
};
constexpr PrintedRow kTable6[] = {
    {36.5, 163, -7.1}, {115.27, 219.5, -49.7}, {-249.91, 232, 248.8}, {77.46, 250.9, 221}};
constexpr Vector3 kInputs{932.6, 1029.4, 283.4};

/// Substitution: both rods' length errors and the height error of C, of one triangle or of its mirror image.
Eigen::Vector3d substituted(const M4Geometry& g, const PlanarPose& p, bool mirrored) {
  const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), l = g.triangle_mm / 2;
  const double height = (mirrored ? -1 : 1) * std::sqrt(3.0) * l;
  return {std::hypot(p.x_mm - l * c + g.rails_mm / 2, p.y_mm - l * s - kInputs[0]) - g.rod_mm,
          std::hypot(p.x_mm + l * c - g.rails_mm / 2, p.y_mm + l * s - kInputs[1]) - g.rod_mm,
          p.y_mm + height * c - kInputs[2]};
}

/// The closure next to a printed row: Newton by differences, no more than the paper's equations.
PlanarPose closed_next_to(const M4Geometry& g, PlanarPose p, bool mirrored) {
  for (int step = 0; step < 30; ++step) {
    const Eigen::Vector3d r = substituted(g, p, mirrored);
    Eigen::Matrix3d j;
    constexpr double h = 1e-4;
    j.col(0) = (substituted(g, {p.x_mm + h, p.y_mm, p.phi_rad}, mirrored) - r) / h;
    j.col(1) = (substituted(g, {p.x_mm, p.y_mm + h, p.phi_rad}, mirrored) - r) / h;
    j.col(2) = (substituted(g, {p.x_mm, p.y_mm, p.phi_rad + h / 100}, mirrored) - r) * (100 / h);
    const Eigen::Vector3d move = j.fullPivLu().solve(-r);
    p = {p.x_mm + move(0), p.y_mm + move(1), p.phi_rad + move(2)};
  }
  return p;
}

/// How far a printed row is from closing.
double open_by(const M4Geometry& g, const PrintedRow& row, double turned_deg, bool mirrored) {
  return substituted(g, {row.x_mm, row.y_mm, (row.phi_deg + turned_deg) * kRadPerDeg}, mirrored)
      .cwiseAbs()
      .maxCoeff();
}

void table6(Table& t, const M4Geometry& g) {
  const auto found = m4_assemblies(g, kInputs);
  const auto own = std::count_if(found.begin(), found.end(), [](const M4Assembly& a) { return !a.mirrored; });
  int closing = 0;
  for (const PrintedRow& row : kTable6) {
    // As printed, with the half turn that the arc tangent loses, or with the triangle's mirror image.
    double turned_deg = 0;
    bool mirrored = false;
    for (const bool mirror : {false, true})
      for (const double turn : {0.0, 180.0})
        if (open_by(g, row, turn, mirror) < open_by(g, row, turned_deg, mirrored)) {
          turned_deg = turn;
          mirrored = mirror;
        }
    closing += mirrored ? 0 : 1;
    const PlanarPose follows =
        closed_next_to(g, {row.x_mm, row.y_mm, (row.phi_deg + turned_deg) * kRadPerDeg}, mirrored);
    const M4Assembly* here = nullptr;
    const auto distance = [&](const M4Assembly& a) {
      return std::hypot(a.pose.x_mm - follows.x_mm, a.pose.y_mm - follows.y_mm) +
             (a.mirrored == mirrored ? 0 : 1e6);
    };
    for (const M4Assembly& a : found)
      if (here == nullptr || distance(a) < distance(*here)) here = &a;
    t.note(printed("row (%.2f, %.1f, %.1f): as printed it is open by %.3g mm", row.phi_deg, row.y_mm,
                   row.x_mm, open_by(g, row, 0, false)) +
           (turned_deg != 0 ? "; closes half a turn on" : "") +
           (mirrored ? "; closes with the mirrored triangle only" : ""));
    const auto degrees = [](double rad) { return std::remainder(rad / kRadPerDeg, 360); };
    t.compare("    phi", row.phi_deg, degrees(follows.phi_rad), here ? degrees(here->pose.phi_rad) : NAN,
              0.05, "deg");
    t.compare("    yp", row.y_mm, follows.y_mm, here ? here->pose.y_mm : NAN, 0.1, "mm");
    t.compare("    xp", row.x_mm, follows.x_mm, here ? here->pose.x_mm : NAN, 0.1, "mm");
  }
  t.compare("poses of the machine's own triangle", static_cast<double>(std::size(kTable6)), closing,
            static_cast<double>(own), 0, "");
  double residual = 0;
  for (const M4Assembly& a : found)
    residual = std::max(residual, substituted(g, a.pose, a.mirrored).cwiseAbs().maxCoeff());
  t.compare("largest residual of all assemblies found, by substitution", {}, 0, residual, 1e-9, "mm");
}

}  // namespace

int m4(const std::string& folder) {
  Table t(
      "M4, hybrid mill: forward kinematics (table 6) for 932.6, 1029.4, 283.4 mm, and the path of table 4");
  const MachineDescription machine = shipped("m4");
  const auto& g = std::get<M4Geometry>(machine.kinematics);
  table6(t, g);
  m4_path(t, machine, folder);
  if (!folder.empty()) write_picture(folder, "m4-assemblies.svg", draw_m4_assemblies(g));
  return t.wrong();
}

}  // namespace kinebus::papers
