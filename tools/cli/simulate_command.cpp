#include "tools/cli/simulate_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

#include "gateway/jobs/store/file_source.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/host/step_line.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/offline.hpp"
#include "tools/simulation/simulate.hpp"

namespace kinebus {
namespace {

struct Arguments {
  std::string job, machine, plant, json_path, plot_path, ringing_path, candump_path;
  std::uint64_t seed = 1;
  double limit_s = 0;
  int reorder = 1;
  bool json = false;
  std::string physics = "rigid";
  double frequency_error_percent = 10, damping_error_percent = 30;
};

std::unique_ptr<FileSource> open_job(const std::string& path) {
  auto source = FileSource::open(path);
  if (!source) throw std::runtime_error(source.error());
  return std::move(*source);
}

int run(const Arguments& arguments) {
  const MachineDescription machine = read_machine(arguments.machine);
  const MachineDescription plant = read_machine(arguments.plant);
  const auto checkers_text = open_job(arguments.job);
  PlotData plot;
  SimulateOptions options;
  options.simulation.seed = arguments.seed;
  if (!arguments.plant.empty()) options.simulation.plant = &plant;
  options.limit_s = arguments.limit_s;
  options.reorder = arguments.reorder;
  if (!arguments.plot_path.empty()) options.plot = &plot;
  RingingTraces ringing;
  if (!arguments.ringing_path.empty()) {
    if (arguments.physics != "flexible") throw CLI::ValidationError("--ringing needs --physics flexible");
    options.ringing = &ringing;
  }
  StepLine steps;
  options.on_progress = [&steps](double progress, double job_s) {
    steps.show(fmt::format("{:5.1f} %  {} simulated", 100 * progress, time_words(job_s)));
  };
  std::ofstream candump;
  if (!arguments.candump_path.empty()) {
    candump.open(arguments.candump_path);
    options.on_frame = [&candump](BusTime when, const CanFrame& frame) {
      const auto time = std::chrono::duration_cast<std::chrono::microseconds>(when);
      candump << to_candump({time, "can0", frame}).view() << "\n";
    };
  }
  const SimulationReport report =
      arguments.physics == "flexible"
          ? simulate_flexible(
                machine, [&] { return open_job(arguments.job); },
                {arguments.frequency_error_percent / 100, arguments.damping_error_percent / 100}, options)
          : simulate(machine, open_job(arguments.job), *checkers_text, options);
  steps.clear();
  fmt::print("{}", arguments.json ? to_json_text(report) : to_table(report));
  if (!arguments.json_path.empty()) write_text(arguments.json_path, to_json_text(report));
  if (!arguments.plot_path.empty())
    write_text(
        arguments.plot_path,
        draw_plot(plot, machine,
                  std::filesystem::path(arguments.job).filename().string() + " on " + machine.name,
                  fmt::format(
                      "{} lines in {}   tool error <= {:.2f} um   path error <= {:.2f} um   bus load {:.1f} %"
                      "   seed {}",
                      report.lines, time_words(report.job_time_s), report.max_tracking_error_um,
                      report.max_path_error_um, 100 * report.bus_load_mean, report.seed)));
  if (!arguments.ringing_path.empty())
    write_text(arguments.ringing_path,
               draw_ringing(ringing.unshaped, ringing.shaped,
                            "Vibration of " + std::filesystem::path(arguments.job).filename().string() +
                                " on " + machine.name));
  return report.finished || (arguments.limit_s > 0 && !report.trouble) ? 0 : 1;
}

}  // namespace

void add_simulate_command(CLI::App& app, const bool& json, int& exit_code) {
  auto* command =
      app.add_subcommand("simulate", "Run a job on the whole simulated machine and measure it from outside");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("job", arguments->job, "G-code file")->required()->check(CLI::ExistingFile);
  command->add_option("--machine", arguments->machine,
                      "Machine file, or the name of a shipped one; without it the default machine M1");
  command
      ->add_option("--plant", arguments->plant,
                   "Machine file of the machine as it really is (kinebus-calibrate spoil)")
      ->check(CLI::ExistingFile);
  command->add_option("--json", arguments->json_path, "Also write the report here");
  command->add_option("--plot", arguments->plot_path,
                      "Draw tool path, carriages, speed, error and bus load (SVG)");
  command->add_option(
      "--ringing", arguments->ringing_path,
      "With --physics flexible: draw the corner where the tool swings most, without shaping and "
      "with it (SVG)");
  command->add_option("--candump", arguments->candump_path, "Write all frames here, as candump -l does");
  command->add_option("--seed", arguments->seed, "Of clocks, latencies and start positions (default 1)");
  command->add_option("--limit-seconds", arguments->limit_s, "Measure only so much of the job, machine time");
  command
      ->add_option("--reorder", arguments->reorder,
                   "The adapter gives up to so many frames in a row in any order, either way, as gs_usb does "
                   "before Linux 6.6 (default 1: none)")
      ->check(CLI::Range(1, 4));
  command
      ->add_option("--physics", arguments->physics,
                   "flexible: the tool swings on its frame, other than [vibration] says, and the job runs "
                   "again without shaping (default rigid)")
      ->check(CLI::IsMember({"rigid", "flexible"}));
  command
      ->add_option("--frequency-error", arguments->frequency_error_percent,
                   "Of the true frequencies, each direction up or down by the seed, % (default 10)")
      ->check(CLI::Range(0.0, 60.0));
  command
      ->add_option("--damping-error", arguments->damping_error_percent,
                   "Of the true damping, the same way, % (default 30)")
      ->check(CLI::Range(0.0, 90.0));
  command->callback([=, &json, &exit_code] {
    arguments->json = json;
    exit_code = run(*arguments);
  });
}

}  // namespace kinebus
