#include "gateway/jobs/preflight.hpp"

#include <utility>

namespace kinebus {

void count_command(const canonical::Command& command, JobReport& report) {
  if (const auto* dwell = std::get_if<canonical::Dwell>(&command)) report.dwell_s += dwell->seconds;
  if (std::holds_alternative<canonical::Pause>(command)) ++report.pauses;
  if (const auto* thermal = std::get_if<canonical::Thermal>(&command))
    report.heat_waits += thermal->wait ? 1 : 0;
}

void tell_notes(JobPipeline& pipeline, JobCheck& check) {
  for (gcode::Note& note : pipeline.take_notes())
    check.problem({Problem::Severity::kWarning, note.line, 0, std::move(note.text)});
}

std::string shown_name(const gcode::PrintObject& object) {
  return object.name.empty() ? std::to_string(object.number) : object.name;
}

Preflight::Preflight(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
                     const Pose& start)
    : Preflight(machine, kinematics, source, start, JobCheck::Options{}) {}

Preflight::Preflight(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
                     const Pose& start, JobCheck::Options options, const gcode::WorkOffsets& offsets)
    : pipeline_(machine, kinematics), check_(machine, kinematics, options) {
  pipeline_.start_job(source, start, offsets);
}

bool Preflight::step(int lines) {
  using Step = JobPipeline::Step;
  for (;;) {
    switch (pipeline_.next(lines)) {
      case Step::kPhase:
        report_.motion_s += pipeline_.phase().duration_s;
        check_.phase(pipeline_.phase());
        break;
      case Step::kEvent:
      case Step::kBarrier:
        check_.command(pipeline_.command());
        count_command(pipeline_.command().command, report_);
        break;
      case Step::kRunEnd:
        ++report_.runs;
        break;
      case Step::kMelt:
        break;
      case Step::kProbed:
        pipeline_.probed(pipeline_.assumed_probe());
        break;
      case Step::kProblem:
        tell_notes(pipeline_, check_);
        check_.problem(pipeline_.problem());
        break;
      case Step::kMore:
      case Step::kStarved:
        tell_notes(pipeline_, check_);
        return false;
      case Step::kEnd:
        tell_notes(pipeline_, check_);
        report_.lines = pipeline_.lines();
        report_.moves = pipeline_.planner().counters().moves;
        for (const gcode::PrintObject& object : pipeline_.objects())
          report_.objects.push_back(shown_name(object));
        return true;
    }
  }
}

}  // namespace kinebus
