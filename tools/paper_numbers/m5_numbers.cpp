// M5: rail correction factors, and straightness by the switches.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <stdexcept>

#include "tools/calibrate/fit/geometry_fit.hpp"
#include "tools/calibrate/fit/rail_fit.hpp"
#include "tools/calibrate/fit/robust.hpp"
#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/readings.hpp"
#include "tools/calibrate/rehearsal.hpp"
#include "tools/calibrate/residual_plot.hpp"
#include "tools/paper_numbers/numbers.hpp"
#include "tools/simulation/job_generator.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus::papers {
namespace {

/// The paper's corrections to apply, as its controller takes them: what is commanded is multiplied by 1 +
/// correction.
constexpr double kCorrections[] = {-0.00025, -0.0003, 0.0014, 0.0001};

/// The error that such a correction takes out: `scale` of the machine file is measured travel over commanded
/// travel, less 1.
double scale_of(double correction) {
  return 1 / (1 + correction) - 1;
}

std::string micrometres(double mm) {
  char words[32];
  std::snprintf(words, sizeof words, "%.0f um", 1000 * mm);
  return words;
}

void rails(Table& t, const std::string& folder) {
  MachineDescription machine = shipped("m5"), truth = machine;
  for (std::size_t i = 0; i < 4; ++i) {
    truth.joints[i].calibration.scale = scale_of(kCorrections[i]);
    truth.joints[i].calibration.backlash = 0.03;
  }
  t.note(
      "the paper's numbers are corrections to apply; the file's `scale` is the error that they take out, of "
      "the "
      "other sign:");
  for (std::size_t i = 0; i < 4; ++i)
    t.note(printed("    rail %zu: the paper prints %+.5f, so scale = %+.7f", i + 1, kCorrections[i],
                   scale_of(kCorrections[i])));
  const auto samples = rail_samples(*Csv::parse(measure_rails(machine, truth, 10, 0.01, 5)), machine);
  std::vector<ResidualPanel> panels;
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& own = samples->at(machine.joints[i].name);
    const RailFit fit = fit_rail(own, {.anchor = anchor_of(machine.joints[i])});
    worst = std::max(worst, std::abs(fit.calibration.scale - truth.joints[i].calibration.scale));
    ResidualPanel panel{"Rail " + std::to_string(i + 1), "commanded, mm", {}, fit.before, fit.after};
    for (const RailSample& s : own) panel.x.push_back(s.commanded);
    panels.push_back(panel);
  }
  t.ours("rails spoiled so, 10 um of noise: the fit is off by", worst, 2e-5, "");
  if (!folder.empty())
    write_picture(folder, "m5-rails.svg",
                  draw_residuals(
                      "Rail errors of M5, forth and back",
                      "Measured minus commanded, synthesised with the paper's factors, 30 µm of backlash and "
                      "10 µm of noise; and what one fit leaves.",
                      panels));
}

void straightness(Table& t, const std::string& folder) {
  // Switches out by tenths of a millimetre; a gauge reads height along X and along Y at three tilts.
  MachineDeviation truth;
  truth.offset_mm = {0.25, -0.15, 0.1, -0.3};
  const MachineDescription machine = shipped("m5");
  BelievedMachine believed{std::get<M5Geometry>(machine.kinematics)};
  for (std::size_t i = 0; i < 4; ++i) believed.switch_mm[i] = machine.joints[i].homing->switch_position;
  const GeometryModel model(believed, {});
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
  const GeometryFit fit = fit_geometry(GeometryModel(believed, readings), {.switch_offsets_only = true});
  t.note(
      "straightness: the paper shifted its switches by trial and error, and prints no number of before and "
      "after");
  t.ours("made-up switch errors: left after one fit of the switches", fit.after_rms_mm, 0.002, "mm");
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
  std::vector<ResidualPanel> panels;
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
    for (const std::size_t along : {std::size_t{2}, 1 - axis}) {
      const std::string name = axis == 0 ? "X" : "Y";
      ResidualPanel panel{
          (along == 2 ? "Height along " : "Sideways along ") + name, name + ", mm", {}, {}, {}};
      for (std::size_t k = 0; k < readings.size(); ++k) {
        if ((readings[k].series - 1) / 2 % 2 != static_cast<int>(axis) || readings[k].direction[along] == 0)
          continue;
        panel.x.push_back(readings[k].commanded[axis]);
        panel.before_mm.push_back(fit.before_mm[k]);
        panel.after_mm.push_back(fit.after_mm[k]);
      }
      panels.push_back(std::move(panel));
    }
  write_picture(folder, "m5-straightness.svg",
                draw_residuals(
                    "Straightness of M5's X and Y motion",
                    "Dial gauge readings (1 µm) along X and Y at three tilts; switch offsets and the table's "
                    "tilt in one fit.",
                    panels));
}

/// Where the true tool is while a job is printed on the whole simulated machine.
SimulationReport printed(const std::string& job, const MachineDescription& machine,
                         const MachineDescription& truth) {
  SimulateOptions options;
  options.simulation.plant = &truth;
  options.limit_s = 60;
  StringSource same(job);
  return simulate(machine, std::make_unique<StringSource>(job), same, options);
}

void whole_loop(Table& t) {
  const MachineDescription nominal = shipped("m1");
  const MachineDescription truth = with_hidden_errors(nominal, {}, 1);
  const auto machine = calibrated(nominal, truth, {});
  if (!machine) throw std::runtime_error(machine.error());
  t.note(
      "the whole loop on M1, nothing of it in the paper: hidden 0.5 mm geometry, 0.2 % scale, 0.1 mm "
      "backlash, 0.3 mm switches; 10 um of noise");
  const Accuracy before = accuracy(nominal, truth, 1000, 4), after = accuracy(*machine, truth, 1000, 4);
  t.note("tool accuracy over the workspace before: " + micrometres(before.rms_mm) + " rms, " +
         micrometres(before.worst_mm) + " worst");
  t.ours("    after", 1000 * after.rms_mm, 25, "um rms");
  std::string job;
  for (const JobKind& kind : job_kinds())
    if (kind.name == "print") kind.write([&](std::string_view part) { job += part; }, 2000);
  const SimulationReport raw = printed(job, nominal, truth), good = printed(job, *machine, truth);
  t.note("tool while a gear is printed in the simulation before: " +
         micrometres(1e-3 * raw.rms_tracking_error_um) + " rms, " +
         micrometres(1e-3 * raw.max_tracking_error_um) + " worst");
  t.ours("    after", good.rms_tracking_error_um, 25, "um rms");
  t.note("    worst " + micrometres(1e-3 * good.max_tracking_error_um) +
         ", while a motor crosses its backlash at a quick reversal");
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
