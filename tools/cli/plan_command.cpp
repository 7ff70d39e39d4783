#include "tools/cli/plan_command.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <memory>
#include <stdexcept>

#include "gateway/jobs/job_plan.hpp"
#include "gateway/jobs/store/file_source.hpp"
#include "protocol/host/step_line.hpp"
#include "tools/cli/home_plan.hpp"
#include "tools/cli/job_watch.hpp"
#include "tools/cli/offline.hpp"

namespace kinebus {
namespace {

using nlohmann::json;

struct PlanArguments {
  std::string job, machine, json_path;
  bool home = false, json = false;
  HomePlanArguments homing;
};

double cpu_seconds(const rusage& usage) {
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

json to_json(const PlanReport& report, const ProblemList& problems) {
  json list = json::array();
  for (const Problem& p : problems.all())
    list.push_back({{"severity", p.severity == Problem::Severity::kError ? "error" : "warning"},
                    {"line", p.line},
                    {"column", p.column},
                    {"words", p.words}});
  return {{"lines", report.lines},
          {"moves", report.moves},
          {"job_time_s", report.job_time_s},
          {"motion_s", report.motion_s},
          {"segments", report.segments},
          {"frames", report.frames},
          {"bus_load_mean", report.bus_load_mean},
          {"bus_load_peak_1s", report.bus_load_peak_1s},
          {"lowest_rate", report.lowest_rate},
          {"cpu_s", report.cpu_s},
          {"peak_rss_mb", report.peak_rss_mb},
          {"errors", problems.errors()},
          {"warnings", problems.warnings()},
          {"problems", list}};
}

void print_problems(const std::string& job, const ProblemList& problems) {
  for (const Problem& p : problems.all())
    fmt::print("{}:{}{}: {}: {}\n", job, p.line, p.column != 0 ? fmt::format(":{}", p.column) : "",
               p.severity == Problem::Severity::kError ? "error" : "warning", p.words);
  if (problems.truncated()) fmt::print("... and more problems of the same job\n");
}

void print_report(const PlanReport& r, const ProblemList& problems) {
  fmt::print("lines             {}\n", r.lines);
  fmt::print("job_time_s        {:.1f}  ({})\n", r.job_time_s, time_words(r.job_time_s));
  fmt::print("segments          {}\n", r.segments);
  fmt::print("frames            {}\n", r.frames);
  fmt::print("bus_load_mean     {:.4f}\n", r.bus_load_mean);
  fmt::print("bus_load_peak_1s  {:.4f}\n", r.bus_load_peak_1s);
  if (r.lowest_rate < 1)
    fmt::print("lowest_rate       {:.3f}  (slowed to keep within the bus budget)\n", r.lowest_rate);
  fmt::print("cpu_s             {:.3f}\n", r.cpu_s);
  fmt::print("peak_rss_mb       {:.1f}\n", r.peak_rss_mb);
  fmt::print("problems          {} errors, {} warnings\n", problems.errors(), problems.warnings());
}

int plan(const PlanArguments& arguments) {
  const MachineDescription machine = read_machine(arguments.machine);
  const auto kinematics = make_kinematics(machine);
  if (!kinematics) throw std::runtime_error(kinematics.error().what);
  auto source = FileSource::open(arguments.job);
  if (!source) throw std::runtime_error(source.error());

  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  JobPlan job(machine, **kinematics, **source);
  StepLine steps;
  std::uint64_t read = 0;
  while (!job.step(10'000)) steps.show(fmt::format("{} lines planned", read += 10'000));
  steps.clear();
  ::getrusage(RUSAGE_SELF, &after);
  PlanReport report = job.report();
  report.cpu_s = cpu_seconds(after) - cpu_seconds(before);
  report.peak_rss_mb = static_cast<double>(after.ru_maxrss) / 1024.0;

  const std::string text = to_json(report, job.problems()).dump(2) + "\n";
  if (arguments.json) {
    fmt::print("{}", text);
  } else {
    print_problems(arguments.job, job.problems());
    print_report(report, job.problems());
  }
  if (!arguments.json_path.empty()) write_text(arguments.json_path, text);
  return job.problems().errors() == 0 ? 0 : 1;
}

}  // namespace

void add_plan_command(CLI::App& app, const bool& json, int& exit_code) {
  auto* command =
      app.add_subcommand("plan",
                         "Check a job and estimate time, frames and bus load, or show how the machine "
                         "homes; nothing moves");
  auto arguments = std::make_shared<PlanArguments>();
  command->add_option("job", arguments->job, "G-code file")->check(CLI::ExistingFile);
  command->add_option("--machine", arguments->machine,
                      "Machine file, or the name of a shipped one; without it the default machine M1");
  command->add_option("--json", arguments->json_path, "Also write the report here");
  auto* home =
      command->add_flag("--home", arguments->home,
                        "Order and directions of homing, and what comes near on the way from random poses");
  command->add_option("--starts", arguments->homing.starts, "With --home: from so many poses")
      ->check(CLI::Range(1, 1'000'000))
      ->needs(home);
  command->add_option("--seed", arguments->homing.seed, "With --home: the poses are drawn from it")
      ->needs(home);
  auto* radius = command
                     ->add_option("--part-radius", arguments->homing.part_radius_mm,
                                  "With --home: the greatest part on the table, mm")
                     ->check(CLI::Range(0.1, 10000.0))
                     ->needs(home);
  auto* height = command->add_option("--part-height", arguments->homing.part_height_mm, "Its height, mm")
                     ->check(CLI::Range(0.1, 10000.0))
                     ->needs(radius);
  radius->needs(height);
  command->callback([=, &json, &exit_code] {
    arguments->json = json;
    if (arguments->home == !arguments->job.empty())
      throw CLI::ValidationError("plan", "name a job, or --home");
    if (!arguments->home) {
      exit_code = plan(*arguments);
      return;
    }
    arguments->homing.json_path = arguments->json_path;
    exit_code = plan_homing(read_machine(arguments->machine), arguments->homing);
  });
}

}  // namespace kinebus
