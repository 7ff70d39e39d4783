// kinebus-calibrate: from measurements to the machine file's calibration.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "gateway/description/machine_file.hpp"
#include "tools/calibrate/fit/geometry_fit.hpp"
#include "tools/calibrate/hidden.hpp"
#include "tools/calibrate/machine_edit.hpp"
#include "tools/calibrate/readings.hpp"
#include "tools/calibrate/residual_plot.hpp"

namespace kinebus {
namespace {

struct Arguments {
  std::string machine, data, plot, truth, out;
  double pitch_mm = 0, step_mm = 5, noise_um = 10;
  int table_points = 0, count = 20, poses = 120;
  std::uint64_t seed = 1;
  bool write = false, offsets_only = false, scale = false, no_lean = false;
  HiddenErrors hidden;
};

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error("cannot read " + path);
  return text.str();
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out << text;
  if (!out.flush()) throw std::runtime_error("cannot write " + path);
  std::printf("wrote %s\n", path.c_str());
}

MachineDescription read_machine(const std::string& path) {
  auto machine = load_machine(path);
  if (!machine) throw std::runtime_error(to_string(machine.error()));
  return std::move(*machine);
}

Csv read_csv(const std::string& path) {
  auto csv = Csv::parse(read_text(path));
  if (!csv) throw std::runtime_error(to_string(csv.error(), path));
  return std::move(*csv);
}

/// The machine file with the new calibration: in its place with --write, else only checked.
void finish(const Arguments& a, const MachineDescription& machine) {
  const auto text = with_calibration(read_text(a.machine), machine);
  if (!text) throw std::runtime_error("the new calibration does not fit the machine file: " + text.error());
  if (!a.write) {
    std::printf("\nnothing written: --write puts this into %s and keeps the old file\n", a.machine.c_str());
    return;
  }
  const auto kept = replace_machine_file(a.machine, *text);
  std::printf("\nwrote %s; the old file is %s\n", a.machine.c_str(), kept.c_str());
}

int rails(const Arguments& a) {
  MachineDescription machine = read_machine(a.machine);
  const auto samples = rail_samples(read_csv(a.data), machine);
  if (!samples) throw std::runtime_error(to_string(samples.error(), a.data));
  std::vector<ResidualPanel> panels;
  std::printf("%-8s %8s %12s %10s %10s %12s %12s %9s\n", "joint", "readings", "scale", "+-", "backlash",
              "periodic", "before rms", "after rms");
  for (JointDescription& joint : machine.joints) {
    const auto own = samples->find(joint.name);
    if (own == samples->end()) continue;
    const RailFit fit = fit_rail(
        own->second, {.anchor = anchor_of(joint), .pitch = a.pitch_mm, .table_points = a.table_points});
    const JointCalibration& c = fit.calibration;
    std::printf("%-8s %8zu %+12.6f %10.1e %7.1f um %9.1f um %9.1f um %6.2f um\n", joint.name.c_str(),
                own->second.size(), c.scale, fit.scale_sigma, 1000 * c.backlash,
                1000 * std::hypot(c.periodic_sine, c.periodic_cosine), 1000 * fit.before_rms,
                1000 * fit.after_rms);
    if (!fit.has_both_directions)
      std::printf("         measured in one direction only: says nothing about backlash\n");
    if (fit.outliers > 0) std::printf("         %zu readings lie far off and count little\n", fit.outliers);
    ResidualPanel panel{joint.name + ": measured minus commanded", "travel, mm", {}, fit.before, fit.after};
    for (const RailSample& s : own->second) panel.x.push_back(s.commanded);
    panels.push_back(std::move(panel));
    apply(fit, joint.calibration);
  }
  if (!a.plot.empty())
    write_text(a.plot, draw_residuals(
                           "Rail travel of " + machine.name,
                           "Measured minus commanded, forth and back. Right: what is left after calibration.",
                           panels));
  finish(a, machine);
  return 0;
}

int geometry(const Arguments& a) {
  MachineDescription machine = read_machine(a.machine);
  const auto start = believed(machine);
  if (!start) throw std::runtime_error("geometry calibration is for four-leg machines (m1, m5)");
  const auto readings = geometry_readings(read_csv(a.data));
  if (!readings) throw std::runtime_error(to_string(readings.error(), a.data));
  const GeometryModel model(*start, *readings);
  const GeometryFit fit =
      fit_geometry(model, {.switch_offsets_only = a.offsets_only, .rail_lean = !a.no_lean, .scale = a.scale});
  if (!fit.solved) throw std::runtime_error(fit.problem);
  std::printf("%zu readings, %d steps: residuals %.1f um rms before, %.2f um after\n", readings->size(),
              fit.steps, 1000 * fit.before_rms_mm, 1000 * fit.after_rms_mm);
  if (fit.outliers > 0) std::printf("%zu readings lie far off and count little\n", fit.outliers);
  std::printf("\n%-22s %12s %12s\n", "parameter", "found", "+-");
  for (const FittedParameter& p : fit.parameters)
    if (!p.held) std::printf("%-22s %+12.5f %12.5f %s\n", p.name.c_str(), p.value, p.sigma, p.unit.c_str());
  bool title = false;
  for (const FittedParameter& p : fit.parameters) {
    if (!p.held) continue;
    if (!title) std::printf("\nnot determined by these readings, held as they were:\n");
    title = true;
    std::printf("%-22s %s\n", p.name.c_str(), p.why.c_str());
  }
  if (!a.plot.empty()) {
    ResidualPanel panel{"All readings", "reading", {}, fit.before_mm, fit.after_mm};
    for (std::size_t k = 0; k < fit.before_mm.size(); ++k) panel.x.push_back(static_cast<double>(k + 1));
    std::vector<ResidualPanel> panels{panel};
    // The error over the tilt shows best what geometry does.
    ResidualPanel tilt{"By tilt", "A, deg", {}, fit.before_mm, fit.after_mm};
    for (const GeometryReading& r : *readings) {
      const int count = r.kind == GeometryReading::Kind::kPoint
                            ? static_cast<int>(std::count(r.has.begin(), r.has.end(), true))
                            : 1;
      for (int k = 0; k < count; ++k) tilt.x.push_back(r.commanded[kA] / kRadPerDeg);
    }
    panels.push_back(tilt);
    write_text(a.plot, draw_residuals("Geometry of " + machine.name,
                                      "Measured minus predicted, before and after the fit.", panels));
  }
  apply(fit.deviation, machine);
  finish(a, machine);
  return 0;
}

int suggest(const Arguments& a) {
  const MachineDescription machine = read_machine(a.machine);
  const auto start = believed(machine);
  if (!start) throw std::runtime_error("for four-leg machines (m1, m5)");
  std::vector<GeometryReading> present;
  if (!a.data.empty()) {
    const auto readings = geometry_readings(read_csv(a.data));
    if (!readings) throw std::runtime_error(to_string(readings.error(), a.data));
    present = *readings;
  }
  const auto poses =
      suggest_poses(*start, present, random_poses(machine, 400, a.seed), static_cast<std::size_t>(a.count),
                    a.noise_um * 1e-3, {.rail_lean = !a.no_lean, .scale = a.scale});
  std::string out = "x_mm,y_mm,z_mm,a_deg,measured_x_mm,measured_y_mm,measured_z_mm\n";
  char text[128];
  for (const Pose& p : poses) {
    std::snprintf(text, sizeof text, "%.4f,%.4f,%.4f,%.4f,,,\n", p[kX], p[kY], p[kZ], p[kA] / kRadPerDeg);
    out += text;
  }
  if (a.out.empty())
    std::printf("%s", out.c_str());
  else
    write_text(a.out, out);
  return 0;
}

int spoil(const Arguments& a) {
  const MachineDescription machine = read_machine(a.machine);
  if (!believed(machine)) throw std::runtime_error("for four-leg machines (m1, m5)");
  write_text(a.out, write_machine(with_hidden_errors(machine, a.hidden, a.seed)));
  return 0;
}

int measure(const Arguments& a) {
  const MachineDescription machine = read_machine(a.machine), truth = read_machine(a.truth);
  if (!believed(machine)) throw std::runtime_error("for four-leg machines (m1, m5)");
  if (a.data == "rails")
    write_text(a.out, measure_rails(machine, truth, a.step_mm, a.noise_um * 1e-3, a.seed));
  else
    write_text(a.out, measure_points(machine, truth, random_poses(machine, a.poses, a.seed),
                                     a.noise_um * 1e-3, a.seed));
  return 0;
}

int verify(const Arguments& a) {
  const MachineDescription machine = read_machine(a.machine), truth = read_machine(a.truth);
  if (!believed(machine)) throw std::runtime_error("for four-leg machines (m1, m5)");
  const Accuracy result = accuracy(machine, truth, 2000, a.seed + 1000);
  std::printf("tool against command at %d poses of the workspace: %.1f um rms, %.1f um worst\n", result.poses,
              1000 * result.rms_mm, 1000 * result.worst_mm);
  return 0;
}

void run(int argc, char** argv, int& code) {
  Arguments a;
  CLI::App app("Finds what a machine's measurements say about it, and writes it into its machine file");
  app.require_subcommand(1);
  app.set_version_flag("--version", KINEBUS_VERSION);
  const auto with_machine = [&](CLI::App* c) {
    c->add_option("--machine", a.machine, "Machine file")->required()->check(CLI::ExistingFile);
  };
  const auto with_fit = [&](CLI::App* c) {
    with_machine(c);
    c->add_option("--plot", a.plot, "Residuals before and after (SVG)");
    c->add_flag("--write", a.write, "Write the calibration into the machine file (the old one is kept)");
  };
  auto* rail = app.add_subcommand("rails", "Rail travel: scale, backlash, periodic error, table");
  rail->add_option("data", a.data, "CSV: joint, commanded_mm, measured_mm, direction")
      ->required()
      ->check(CLI::ExistingFile);
  with_fit(rail);
  rail->add_option("--pitch", a.pitch_mm,
                   "mm: look for an error that repeats with it (screw or pulley turn)");
  rail->add_option("--table", a.table_points, "Places of a compensation table per joint (default none)")
      ->check(CLI::Range(0, 200));
  rail->callback([&] { code = rails(a); });
  auto* geo = app.add_subcommand("geometry", "Switch offsets and the whole geometry from tool measurements");
  geo->add_option("data", a.data, "CSV: x_mm, y_mm, z_mm, a_deg and measured_*_mm, or gauge_mm, or bar_mm")
      ->required()
      ->check(CLI::ExistingFile);
  with_fit(geo);
  geo->add_flag("--offsets-only", a.offsets_only,
                "Straightness: fit the switches (and the table's tilt) alone");
  geo->add_flag("--scale", a.scale, "Fit the rails' scale too");
  geo->add_flag("--no-lean", a.no_lean, "Rails stand as described");
  geo->callback([&] { code = geometry(a); });
  auto* next = app.add_subcommand("suggest", "The poses whose measurement would tell most");
  with_machine(next);
  next->add_option("--have", a.data, "CSV of the readings that are there")->check(CLI::ExistingFile);
  next->add_option("--count", a.count, "How many (default 20)")->check(CLI::Range(1, 200));
  next->add_option("--noise-um", a.noise_um, "Of the measuring device (default 10)");
  next->add_option("--out", a.out, "CSV to fill in; without it to standard output");
  next->add_flag("--no-lean", a.no_lean, "Rails stand as described");
  next->callback([&] { code = suggest(a); });
  auto* bad = app.add_subcommand("spoil", "A machine file with hidden errors, as the truth for a trial");
  with_machine(bad);
  bad->add_option("--out", a.out, "Machine file of the true machine")->required();
  bad->add_option("--seed", a.seed, "Default 1");
  bad->add_option("--geometry-mm", a.hidden.geometry_mm, "Default 0.5");
  bad->add_option("--scale", a.hidden.scale, "Default 0.002");
  bad->add_option("--backlash-mm", a.hidden.backlash_mm, "Default 0.1");
  bad->add_option("--switch-mm", a.hidden.switch_mm, "Default 0.3");
  bad->add_option("--periodic-mm", a.hidden.periodic_mm, "Default 0");
  bad->callback([&] { code = spoil(a); });
  auto* take = app.add_subcommand("measure", "What measuring devices would read at a true machine");
  take->add_option("what", a.data, "rails or points")->required()->check(CLI::IsMember({"rails", "points"}));
  with_machine(take);
  take->add_option("--truth", a.truth, "Machine file of the true machine")
      ->required()
      ->check(CLI::ExistingFile);
  take->add_option("--out", a.out, "CSV")->required();
  take->add_option("--noise-um", a.noise_um, "Default 10");
  take->add_option("--step", a.step_mm, "mm between readings of a rail (default 5)")
      ->check(CLI::Range(0.05, 100.0));
  take->add_option("--poses", a.poses, "Points (default 120)")->check(CLI::Range(1, 5000));
  take->add_option("--seed", a.seed, "Default 1");
  take->callback([&] { code = measure(a); });
  auto* check = app.add_subcommand("verify", "Tool accuracy of a true machine under a machine file");
  with_machine(check);
  check->add_option("--truth", a.truth, "Machine file of the true machine")
      ->required()
      ->check(CLI::ExistingFile);
  check->add_option("--seed", a.seed, "Default 1");
  check->callback([&] { code = verify(a); });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    code = app.exit(e) == 0 ? 0 : 2;
  }
}

}  // namespace
}  // namespace kinebus

int main(int argc, char** argv) {
  try {
    int code = 0;
    kinebus::run(argc, argv, code);
    return code;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "kinebus-calibrate: %s\n", e.what());
    return 1;
  }
}
