// M5: rail correction factors, and straightness by the switches.

#include <cmath>
#include <cstdio>
#include <random>

#include "gateway/calibration/geometry_fit.hpp"
#include "gateway/calibration/rail_fit.hpp"
#include "gateway/calibration/robust.hpp"
#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/readings.hpp"
#include "tools/calibrate/residual_plot.hpp"
#include "tools/papers/numbers.hpp"

namespace kinebus::papers {
namespace {

constexpr double kFactors[] = {-0.00025, -0.0003, 0.0014, 0.0001};

void rails(Table& t, const std::string& folder) {
  MachineDescription machine = default_m1(), truth = machine;
  for (std::size_t i = 0; i < 4; ++i) {
    truth.joints[i].calibration.scale = kFactors[i];
    truth.joints[i].calibration.backlash = 0.03;
  }
  const auto samples = rail_samples(*Csv::parse(measure_rails(machine, truth, 10, 0.01, 5)), machine);
  std::vector<ResidualPanel> panels;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& own = samples->at(machine.joints[i].name);
    const RailFit fit = fit_rail(own, {.anchor = anchor_of(machine.joints[i])});
    t.compare("correction factor of rail " + std::to_string(i + 1), kFactors[i], fit.calibration.scale, 2e-5,
              "");
    ResidualPanel panel{"Rail " + std::to_string(i + 1), "commanded, mm", {}, fit.before, fit.after};
    for (const RailSample& s : own) panel.x.push_back(s.commanded);
    panels.push_back(panel);
  }
  if (!folder.empty())
    write_picture(
        folder, "m5-rails.svg",
        draw_residuals("Rail errors of M5, forth and back",
                       "Measured less commanded, synthesised with the paper's factors, 30 um of backlash and "
                       "10 um of noise; and what one fit leaves.",
                       panels));
}

void straightness(Table& t, const std::string& folder) {
  // Switches out by tenths of a millimetre; a gauge reads height along X and along Y at three tilts.
  MachineDeviation truth;
  truth.offset_mm = {0.25, -0.15, 0.1, -0.3};
  const GeometryModel model({}, {});
  std::mt19937_64 engine(3);
  std::normal_distribution<double> noise(0, 0.001);
  std::vector<GeometryReading> readings;
  int series = 0;
  for (const double a : {0.0, 20.0, -20.0})
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
      for (const std::size_t along : {std::size_t{2}, 1 - axis}) {
        ++series;
        for (int k = -9; k <= 9; ++k) {
          GeometryReading r;
          r.kind = GeometryReading::Kind::kGauge;
          r.commanded = {0, 0, 60, a * kRadPerDeg, 0, 0};
          r.commanded[axis] = 10.0 * k;
          r.direction = {};
          r.direction[along] = 1;
          r.series = series;
          r.sigma_mm = 0.002;
          if (const auto tool = model.tool(truth, r.commanded)) {
            r.value_mm[0] = (*tool)[along] + (along == 2 ? 4e-4 * (*tool)[1] : 0) + noise(engine);
            readings.push_back(r);
          }
        }
      }
  const GeometryFit fit = fit_geometry(GeometryModel({}, readings), {.switch_offsets_only = true});
  t.below("straightness after one fit of the switches", 0.002, fit.after_rms_mm, "mm");
  for (const FittedParameter& p : fit.parameters) {
    char words[160];
    if (p.held)
      std::snprintf(words, sizeof words, "    %s: held, %s", p.name.c_str(), p.why.c_str());
    else if (p.unit == "rad")
      std::snprintf(words, sizeof words, "    %s: %.2f +- %.2f mrad", p.name.c_str(), 1e3 * p.value,
                    1e3 * p.sigma);
    else if (p.name.ends_with("switch offset"))
      std::snprintf(words, sizeof words, "    %s: %+.3f +- %.3f mm", p.name.c_str(), p.value, p.sigma);
    else
      continue;
    t.note(words);
  }
  if (folder.empty()) return;
  ResidualPanel panel{"All traverses", "reading", {}, fit.before_mm, fit.after_mm};
  for (std::size_t k = 0; k < fit.before_mm.size(); ++k) panel.x.push_back(static_cast<double>(k + 1));
  write_picture(folder, "m5-straightness.svg",
                draw_residuals(
                    "Straightness of M5's X and Y motion",
                    "Dial gauge readings (1 um) along X and Y at three tilts; switch offsets and the table's "
                    "tilt in one fit.",
                    {panel}));
}

void whole_loop(Table& t) {
  const MachineDescription nominal = default_m1();
  const MachineDescription truth = with_hidden_errors(nominal, {}, 1);
  MachineDescription machine = nominal;
  const auto rails = rail_samples(*Csv::parse(measure_rails(machine, truth, 3, 0.01, 2)), machine);
  for (JointDescription& joint : machine.joints)
    if (const auto own = rails->find(joint.name); own != rails->end())
      apply(fit_rail(own->second, {.anchor = anchor_of(joint)}), joint.calibration);
  const auto points =
      geometry_readings(*Csv::parse(measure_points(machine, truth, random_poses(machine, 120, 3), 0.01, 3)));
  const GeometryFit fit = fit_geometry(GeometryModel(*believed(machine), *points), {});
  apply(fit.deviation, machine);
  char words[160];
  std::snprintf(
      words, sizeof words,
      "hidden: 0.5 mm geometry, 0.2 %% scale, 0.1 mm backlash, 0.3 mm switches; before: %.0f um rms",
      1000 * accuracy(nominal, truth, 1000, 4).rms_mm);
  t.note(words);
  t.below("tool accuracy over the workspace after calibration", 0.025,
          accuracy(machine, truth, 1000, 4).rms_mm, "mm rms");
}

}  // namespace

int m5(const std::string& folder) {
  Table t("M5, calibration of the 4-DOF mill");
  rails(t, folder);
  straightness(t, folder);
  whole_loop(t);
  return t.wrong();
}

}  // namespace kinebus::papers
