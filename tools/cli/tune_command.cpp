#include "tools/cli/tune_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "tools/calibrate/machine_edit.hpp"
#include "tools/cli/client.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/offline.hpp"
#include "tools/tune/melt_fit.hpp"
#include "tools/tune/tune_pressure.hpp"
#include "tools/tune/tune_vibration.hpp"

namespace kinebus {
namespace {

constexpr std::string_view kAxisNames = "xyz";
constexpr std::string_view kNodeSpectrum = "rate_hz ";
constexpr double kWatchHz = 10;
constexpr std::chrono::milliseconds kReadingAgain{200};

struct Common {
  std::string machine, job, plot_path, json_path;
  std::uint64_t seed = 1;
  bool simulate = false, write = false;
};

struct VibrationArguments : Common {
  std::string axes = "xyz";
  std::vector<std::string> readings;
  std::string record;
  TuneVibration how;
  double single_hz = 0, deviation_um = 0, override_from_percent = 0;
};

struct PressureArguments : Common {
  std::string widths;
  PressurePattern pattern;
};

std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw std::runtime_error(path + ": cannot be read");
  return text.str();
}

template <typename T>
T or_throw(Result<T, std::string> result) {
  if (!result) throw std::runtime_error(result.error());
  return std::move(*result);
}

void add_common(CLI::App& command, Common& a) {
  command.add_option("--machine", a.machine, "Machine file; without it the default machine M1")
      ->check(CLI::ExistingFile);
  command.add_flag("--simulate", a.simulate, "Measure a simulated machine that nobody has described");
  command.add_option("--seed", a.seed, "Of that machine (default 1)");
  command.add_option("--plot", a.plot_path, "Draw it (SVG)");
  command.add_option("--json", a.json_path, "Also write what was found here");
  command.add_flag("--write", a.write, "Write it into the machine file (the old one is kept)");
}

/// The machine file with its new tables.
void finish(const Common& a, const MachineDescription& machine,
            const std::function<bool(std::string_view)>& belongs, std::string_view note) {
  if (!a.write) return;
  if (a.machine.empty()) throw std::runtime_error("--write needs a --machine file to write into");
  const auto kept =
      replace_machine_file(a.machine, or_throw(with_tables(read_file(a.machine), machine, belongs, note)));
  fmt::print("wrote {}; the old file is {}\n", a.machine, kept.string());
}

void tell(const Common& a, const nlohmann::json& found, const std::string& table, bool as_json) {
  fmt::print("{}", as_json ? found.dump(2) + "\n" : table);
  if (!a.json_path.empty()) write_text(a.json_path, found.dump(2) + "\n");
}

void only_one_of(const Common& a, bool measured, const char* measured_option) {
  if (a.simulate + measured + !a.job.empty() != 1)
    throw CLI::ValidationError(fmt::format("one of --job, {} and --simulate is needed", measured_option));
}

/// Shakes the machine while the accelerometer of its heat node listens; what it tells is kept as PATH.txt.
NodeSpectrum record_on_the_machine(const MachineOptions& options, const MachineDescription& machine,
                                   const Excitation& excitation, const std::string& path) {
  write_text(path + ".gcode", excitation_job(machine, excitation));
  Client client(options.reach, kWatchHz, true);
  take_control(client, options);
  const auto console = [&client](const char* line) {
    joblink::ClientMessage request;
    request.mutable_console()->set_line(line);
    return client.ask(std::move(request)).console().text();
  };
  console("M956 S1");
  if (run_job(client, path + ".gcode", false) != 0) throw std::runtime_error("the machine was not shaken");
  take_control(client, options);  // which a job that runs by itself has given away
  console("M956 S0");
  std::string told = console("M956");
  for (; told.starts_with("reading"); told = console("M956")) std::this_thread::sleep_for(kReadingAgain);
  write_text(path + ".txt", told + "\n");
  fmt::print("wrote {}.txt\n", path);
  auto spectrum = read_node_spectrum(told);
  if (!spectrum) throw std::runtime_error(path + ".txt:" + spectrum.error());
  return std::move(*spectrum);
}

int vibration(VibrationArguments a, const MachineOptions& options) {
  const bool as_json = options.json;
  only_one_of(a, !a.readings.empty() || !a.record.empty(), "--readings, --record");
  if (!a.readings.empty() && !a.record.empty())
    throw CLI::ValidationError("--readings and --record are two ways to the same: give one");
  const MachineDescription machine = read_machine(a.machine);
  a.how.deviation_mm = 1e-3 * a.deviation_um;
  a.how.slowest_rate = 0.01 * a.override_from_percent;
  if (!a.job.empty()) {
    for (const char name : a.axes) {
      Excitation e = a.how.excitation;
      e.axis = kAxisNames.find(name);
      if (a.single_hz > 0) e.from_hz = e.to_hz = a.single_hz;
      const std::string path = fmt::format("{}-{}.gcode", a.job, name);
      write_text(path, excitation_job(machine, e));
      fmt::print("wrote {}\n", path);
    }
    return 0;
  }
  const auto truth = FlexibleFrame::hidden(a.seed);
  std::array<std::optional<VibrationRecording>, 3> readings;
  for (const std::string& given : a.readings) {
    const std::size_t axis =
        given.size() > 2 && given[1] == '=' ? kAxisNames.find(given[0]) : std::string::npos;
    if (axis == std::string::npos) throw CLI::ValidationError("--readings wants x=FILE, y=FILE or z=FILE");
    const std::string text = read_file(given.substr(2));
    if (text.starts_with(kNodeSpectrum)) {
      auto read = read_node_spectrum(text);
      if (!read) throw std::runtime_error(given.substr(2) + ":" + read.error());
      readings[axis] = std::move(*read);
      continue;
    }
    auto read = read_acceleration(text);
    if (!read) throw std::runtime_error(given.substr(2) + ":" + read.error());
    readings[axis] = std::move(*read);
  }
  if (!a.record.empty())
    for (const char name : a.axes) {
      Excitation e = a.how.excitation;
      e.axis = kAxisNames.find(name);
      readings[e.axis] = record_on_the_machine(options, machine, e, fmt::format("{}-{}", a.record, name));
    }
  if (a.simulate)
    for (const char name : a.axes) {
      Excitation e = a.how.excitation;
      e.axis = kAxisNames.find(name);
      readings[e.axis] = or_throw(shake_simulated(machine, e, truth, a.seed));
    }
  const VibrationTuning tuning = or_throw(tune_vibration(machine, a.how, readings));
  nlohmann::json found = to_json(tuning);
  std::string table = to_table(tuning);
  if (a.simulate)
    for (const char name : a.axes) {
      const std::size_t i = kAxisNames.find(name);
      const AxisTuning& axis = tuning.axes[i];
      const FlexibleFrame::Mode& mode = truth[i][0];
      std::vector<FittedMode> true_modes;
      for (const FlexibleFrame::Mode& m : truth[i])
        true_modes.push_back({m.frequency_hz, m.damping_ratio, m.share});
      table += fmt::format("truth {}: {:.2f} Hz, damping ratio {:.3f}", name, mode.frequency_hz,
                           mode.damping_ratio);
      nlohmann::json& out = found["truth"][std::string(1, static_cast<char>(name - 'a' + 'A'))];
      out = {{"frequency_hz", mode.frequency_hz}, {"damping_ratio", mode.damping_ratio}};
      if (axis.fit) {
        const ShaperRating& best = axis.ratings[axis.best];
        const double left =
            vibration_left(make_shaper(best.kind,
                                       frequency_for_rates(best.kind, best.frequency_hz, best.damping_ratio,
                                                           tuning.machine.vibration.slowest_rate),
                                       best.damping_ratio),
                           true_modes, 1);
        table += fmt::format("; the shaper leaves {:.1f} %", 100 * left);
        out["vibration_left"] = left;
      }
      table += "\n";
    }
  tell(a, found, table, as_json);
  if (!a.plot_path.empty()) write_text(a.plot_path, draw_tuning(tuning));
  finish(
      a, tuning.machine,
      [](std::string_view name) { return name == "vibration" || name.starts_with("vibration."); },
      "Vibration, found by measurement (kinebus tune vibration).");
  for (const AxisTuning& axis : tuning.axes)
    if (axis.fit) return 0;
  return 1;
}

int pressure(const PressureArguments& a, bool as_json) {
  only_one_of(a, !a.widths.empty(), "--widths");
  if (const auto good = check(a.pattern); !good) throw CLI::ValidationError(good.error());
  if (!a.plot_path.empty()) write_text(a.plot_path, draw_pattern(a.pattern));
  if (!a.job.empty()) {
    write_text(a.job, pattern_job(a.pattern));
    fmt::print("wrote {}\n", a.job);
    return 0;
  }
  const MachineDescription machine = read_machine(a.machine);
  const Nozzle::Truth truth = Nozzle::hidden(a.seed);
  const std::vector<LineWidths> widths = a.simulate
                                             ? or_throw(print_simulated(machine, a.pattern, truth, a.seed))
                                             : or_throw(read_widths(read_file(a.widths)));
  const PressureChoice choice = or_throw(choose_advance(widths));
  nlohmann::json lines = nlohmann::json::array();
  std::string table = a.simulate ? write_widths(widths) : "";
  bool near = false;
  for (const LineWidths& w : widths) {
    lines.push_back({{"advance_s", w.advance_s}, {"faster_mm", w.faster_mm}, {"slower_mm", w.slower_mm}});
    if (!w.near()) continue;
    near = true;
    lines.back()["faster_near_mm"] = w.faster_near_mm;
    lines.back()["slower_near_mm"] = w.slower_near_mm;
  }
  nlohmann::json found = {{"advance_s", choice.advance_s}, {"sigma_s", choice.sigma_s}, {"lines", lines}};
  table += fmt::format("advance_s {:.4f} +- {:.4f}\n", choice.advance_s, choice.sigma_s);
  MachineDescription better = machine;
  better.pressure_advance.advance_s = std::round(1e4 * choice.advance_s) / 1e4;
  if (near) {
    const MeltChoice melt = or_throw(choose_melt(machine, a.pattern, widths, choice.advance_s));
    better.pressure_advance.advance_s = std::round(1e4 * melt.advance_s) / 1e4;
    better.pressure_advance.melt_s = melt.melt_s > 0 ? std::round(1e4 * melt.melt_s) / 1e4 : 0;
    better.pressure_advance.smooth_s = shortest_window_s(better, a.pattern);
    found["advance_s"] = melt.advance_s;
    found["melt_ms"] = 1e3 * melt.melt_s;
    found["melt_sigma_ms"] = 1e3 * melt.sigma_s;
    found["smooth_ms"] = 1e3 * better.pressure_advance.smooth_s;
    table += fmt::format("with the melt: advance_s {:.4f}\nmelt_ms {:.1f} +- {:.1f}\nsmooth_ms {:.0f}\n",
                         melt.advance_s, 1e3 * melt.melt_s, 1e3 * melt.sigma_s,
                         1e3 * better.pressure_advance.smooth_s);
  }
  if (a.simulate) {
    const double per_mm = a.pattern.filament_per_mm();
    const double secant_s =
        Nozzle::secant_s(truth, a.pattern.slow_mm_per_s * per_mm, a.pattern.fast_mm_per_s * per_mm);
    found["truth"] = {{"advance_s", secant_s}, {"melt_ms", 1e3 * truth.melt_s}};
    table += fmt::format("truth {:.4f} s, {:.1f} ms\n", secant_s, 1e3 * truth.melt_s);
  }
  tell(a, found, table, as_json);
  finish(
      a, better, [](std::string_view name) { return name == "pressure_advance"; },
      "Pressure advance, found by measurement (kinebus tune pressure).");
  return 0;
}

}  // namespace

void add_tune_commands(CLI::App& tune, const std::shared_ptr<MachineOptions>& options, int& exit_code) {
  auto v = std::make_shared<VibrationArguments>();
  auto* shake = tune.add_subcommand(
      "vibration",
      "How the tool swings on its frame, and the shaper for it: write the jobs that shake it (--job), run "
      "them "
      "while an accelerometer on the tool records, then give the recordings (--readings)");
  add_common(*shake, *v);
  shake->add_option("--job", v->job, "Write NAME-x.gcode, NAME-y.gcode, NAME-z.gcode");
  shake->add_option("--readings", v->readings, "x=FILE y=FILE z=FILE: lines of time_s,x,y,z with mm/s^2")
      ->take_all();
  shake->add_option(
      "--record", v->record,
      "Shake the machine and record by its heat node's accelerometer ([accelerometer] of the machine "
      "file); writes NAME-x.gcode and NAME-x.txt, which --readings takes, too");
  shake->add_option("--axes", v->axes, "Which to shake (default xyz)")->check([](const std::string& axes) {
    return !axes.empty() && axes.find_first_not_of(kAxisNames) == std::string::npos ? std::string()
                                                                                    : "axes are x, y and z";
  });
  Excitation& e = v->how.excitation;
  shake->add_option("--from", e.from_hz, "Hz (default 10)")->check(CLI::Range(5.0, 200.0));
  shake->add_option("--to", e.to_hz, "Hz (default 120)")->check(CLI::Range(20.0, 200.0));
  shake->add_option("--rate", e.hz_per_s, "Hz a second (default 2)")->check(CLI::Range(0.2, 20.0));
  shake
      ->add_option("--accel-per-hz", e.accel_per_hz,
                   "mm/s^2 for each Hz, as far as limits allow (default 60)")
      ->check(CLI::Range(5.0, 200.0));
  shake->add_option("--single", v->single_hz, "With --job: this frequency alone, Hz, for 5 s")
      ->check(CLI::Range(1.0, 200.0));
  shake
      ->add_option("--deviation-um", v->deviation_um,
                   "Shaping may round corners by so much (default: the machine file's)")
      ->check(CLI::Range(1.0, 10000.0));
  shake->add_option("--override-from", v->override_from_percent, "Shapers for all overrides from here on, %")
      ->check(CLI::Range(30.0, 100.0));
  shake->callback([=, &exit_code] { exit_code = vibration(*v, *options); });

  auto p = std::make_shared<PressureArguments>();
  auto* lines = tune.add_subcommand(
      "pressure",
      "Pressure advance: write a job of lines (--job) and a picture of how to read them (--plot), then give "
      "their widths (--widths)");
  add_common(*lines, *p);
  PressurePattern& pattern = p->pattern;
  lines->add_option("--job", p->job, "Write the G-code here");
  lines
      ->add_option("--widths", p->widths,
                   "CSV: advance_s, faster_mm, slower_mm; with faster_near_mm, slower_near_mm the melt, too")
      ->check(CLI::ExistingFile);
  lines->add_option("--from", pattern.from_s, "The first line's advance, s (default 0)");
  lines->add_option("--to", pattern.to_s, "The last line's, s (default 0.1)");
  lines->add_option("--lines", pattern.lines, "How many (default 11)");
  lines->add_option("--slow", pattern.slow_mm_per_s, "mm/s (default 20)");
  lines->add_option("--fast", pattern.fast_mm_per_s, "mm/s (default 100)");
  lines->add_option("--width", pattern.width_mm, "Of a line, mm (default 0.45)");
  lines->add_option("--height", pattern.height_mm, "Of the layer, mm (default 0.2)");
  lines->add_option("--filament", pattern.filament_mm, "Its diameter, mm (default 1.75)");
  lines->add_option("--x", pattern.x_mm, "The pattern's middle, mm (default 0)");
  lines->add_option("--y", pattern.y_mm, "The same (default 0)");
  lines->add_option("--hotend", pattern.hotend_celsius, "C; left out: as it is");
  lines->add_option("--bed", pattern.bed_celsius, "C; left out: as it is");
  lines->callback([=, &exit_code] { exit_code = pressure(*p, options->json); });
}

}  // namespace kinebus
