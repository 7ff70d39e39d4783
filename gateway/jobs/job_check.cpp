#include "gateway/jobs/job_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/jobs/print_trace.hpp"

namespace kinebus {
namespace {

std::string celsius(double value) {
  return printed("%.6g C", value);
}

double tip_speed(const PosePoint& point) {
  return std::hypot(point.x1[kX], point.x1[kY], point.x1[kZ]);
}
double turning_speed(const PosePoint& point) {
  return std::max(std::abs(point.x1[kA]), std::abs(point.x1[kC]));
}
// Corners are rounded in filament too: the last move that was hot may end this much before its E.
constexpr double kFedBack_mm = 0.1;
// Layers end anywhere in a cell of what is printed.
constexpr double kCell_mm = 1;

}  // namespace

JobCheck::JobCheck(const MachineDescription& machine, const Kinematics& kinematics)
    : JobCheck(machine, kinematics, Options{}) {}
JobCheck::JobCheck(const MachineDescription& machine, const Kinematics& kinematics, Options options)
    : machine_(machine),
      printed_(machine.bodies && machine.bodies->printed_part ? std::make_unique<bodies::PrintedPart>()
                                                              : nullptr),
      way_(machine, kinematics, printed_.get()),
      options_(options),
      tool_(options.tool % kMostOfAKind) {
  for (std::size_t i = 0; i < hotends_.size(); ++i) hotends_[i].celsius = options.hotend_celsius[i];
}

void JobCheck::add(Problem::Severity severity, std::uint32_t line, Sentence words) {
  problems_.add({severity, line, 0, std::move(words)});
}

void JobCheck::phase(const Phase& phase) {
  const PosePoint end = phase.piece.evaluate(phase.s(phase.duration_s));
  check_way(phase, end);
  if (!printed_) return;
  trace_print(phase, end, *printed_);
  const double spared_mm = machine_.homing.spared_part_mm;
  if (spared_mm == 0 || tall_reported_ || printed_->empty() || printed_->top_mm() <= spared_mm + kCell_mm)
    return;
  tall_reported_ = true;
  add(Problem::Severity::kWarning, phase.line,
      say("the part becomes higher than the %1 mm that homing spares: it must be off the table before the "
          "machine homes with its positions unknown",
          printed("%.6g", spared_mm)));
}

void JobCheck::check_way(const Phase& phase, const PosePoint& end) {
  const double from = phase.s0;
  const double to = phase.s(phase.duration_s);
  const double length = std::abs(to - from);
  // What one unit of s moves: s is close to arc length, or the dominant axis' own unit. Where it is time, the
  // acceleration hardly changes: the speed is greatest at an end.
  double mm = tip_speed(end), rad = turning_speed(end);
  if (phase.timed) {
    const PosePoint start = phase.piece.evaluate(from);
    mm = std::max(mm, tip_speed(start));
    rad = std::max(rad, turning_speed(start));
  }
  if (end.x1[kE] > 1e-9 && !hotends_[tool_].cold_reported) check_extrusion(phase.line, end.x[kE]);
  since_mm_ += length * mm;
  since_rad_ += length * rad;
  if (since_mm_ < options_.pose_distance_mm && since_rad_ < options_.pose_distance_rad && !phase.last) return;
  const double checks = std::max({1.0, std::ceil(length * mm / options_.pose_distance_mm),
                                  std::ceil(length * rad / options_.pose_distance_rad)});
  const auto count = static_cast<std::int64_t>(checks);
  for (std::int64_t i = 1; i <= count; ++i)
    check_pose(phase, from + (to - from) * static_cast<double>(i - 1) / checks,
               from + (to - from) * static_cast<double>(i) / checks);
  since_mm_ = since_rad_ = 0;
}

void JobCheck::check_pose(const Phase& phase, double before, double s) {
  auto broken =
      way_.broken(phase.piece.frame, before, s, [&phase](double at) { return phase.piece.evaluate(at).x; });
  const bool bad = broken.has_value();
  if (bad && !bad_pose_) {
    add(Problem::Severity::kError, phase.line, std::move(*broken));
    outside_ = Outside{way_.outside(), phase.line, problems_.errors() + problems_.warnings()};
  } else if (bad && goes_farther_out(phase.line)) {
    outside_.worst = way_.outside();
    problems_.reword_last(std::move(*broken));
  }
  bad_pose_ = bad;
}

/// The line that has left the workspace is there by more than was said, and nothing was said since.
bool JobCheck::goes_farther_out(std::uint32_t line) const {
  const std::optional<PoseError>&now = way_.outside(), &worst = outside_.worst;
  return now && worst && now->kind == worst->kind && now->joint == worst->joint &&
         now->amount > worst->amount && outside_.line == line &&
         outside_.said == problems_.errors() + problems_.warnings();
}

void JobCheck::check_extrusion(std::uint32_t line, double e_mm) {
  const HeaterId id{HeaterKind::kHotend, tool_};
  const HeaterDescription* const known = machine_.heater(id);
  if (known == nullptr) return;
  Hotend& hotend = hotends_[tool_];
  by_found_heat_ = by_found_heat_ || !hotend.told;
  // Asked for each phase of a print: words are made when they are needed.
  const auto least = [&] { return celsius(machine_.thermal.min_extrude_c); };
  if (!hotend.celsius) {
    hotend.cold_reported = true;
    add(Problem::Severity::kWarning, line,
        known->place.on_node()
            ? say("filament is fed before the job has set a %1 temperature (M104): it runs only while the %1 "
                  "is set to at least %2",
                  heater_words(id), least())
            : say("filament is fed before the job has set a %1 temperature (M104)", heater_words(id)));
  } else if (*hotend.celsius >= machine_.thermal.min_extrude_c) {
    hot_e_mm_ = std::max(hot_e_mm_, e_mm);
  } else if (e_mm > hot_e_mm_ + kFedBack_mm) {
    // Up to where it was fed hot, filament goes back into what it came out of: ends of jobs press it.
    hotend.cold_reported = true;
    add(Problem::Severity::kError, line,
        say("filament is fed with the %1 at %2; at least %3 is needed", heater_words(id),
            celsius(*hotend.celsius), least()));
  }
}

void JobCheck::command(const canonical::Line& line) {
  if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command))
    check_thermal(*thermal, line.line);
  if (const auto* tool = std::get_if<canonical::Tool>(&line.command)) {
    tool_ = static_cast<std::uint8_t>(tool->hotend % kMostOfAKind);
    hot_e_mm_ = -1e300;
  }
  if (const auto* spindle = std::get_if<canonical::Spindle>(&line.command))
    if (auto wrong = wrong_spindle_speed(machine_.spindle, spindle->rpm))
      add(Problem::Severity::kError, line.line, std::move(*wrong));
  if (std::holds_alternative<canonical::Probe>(line.command) && !std::exchange(probes_, true))
    add(Problem::Severity::kWarning, line.line,
        say("the job probes here: what follows is checked as if the probe touched at the table, or at the "
            "end of "
            "its move, and again with what is measured, just before it moves"));
  if (const auto* wait = std::get_if<canonical::AwaitInput>(&line.command)) {
    if (auto missing = missing_input(machine_, *wait))
      add(Problem::Severity::kError, line.line, std::move(*missing));
    else if (!std::exchange(awaits_, true))
      add(Problem::Severity::kWarning, line.line,
          say("the job reads an input here: what follows is checked as if what it waits for came (M66 "
              "without L: "
              "as if the input were off), and again with what is read, just before it moves"));
  }
  if (const auto* mesh = std::get_if<canonical::Mesh>(&line.command);
      mesh != nullptr && mesh->what == canonical::Mesh::What::kOn && !std::exchange(levels_, true))
    add(Problem::Severity::kWarning, line.line,
        say("a bed mesh is put in force here: what follows is checked with the one in force now, and again "
            "just before it moves"));
  if (std::holds_alternative<canonical::EmergencyStop>(line.command))
    add(Problem::Severity::kWarning, line.line, say("M112 stops the machine here"));
  if (std::holds_alternative<canonical::Settings>(line.command))
    add(Problem::Severity::kWarning, line.line,
        say("settings are kept in the machine file: M500 to M503 do nothing in a job"));
}

void JobCheck::check_thermal(const canonical::Thermal& thermal, std::uint32_t line) {
  if (auto wrong = wrong_device_command(machine_, thermal))
    add(Problem::Severity::kError, line, std::move(*wrong));
  if (auto missing = missing_fan(machine_, thermal); missing && !std::exchange(fan_reported_, true))
    add(Problem::Severity::kWarning, line, std::move(*missing));
  const auto id = heater_of(thermal);
  if (!id || id->kind != HeaterKind::kHotend) return;
  Hotend& hotend = hotends_[id->index % hotends_.size()];
  hotend.celsius = thermal.value;
  hotend.told = true;
}

}  // namespace kinebus
