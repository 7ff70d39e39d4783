// Lines as they come: from a print host or a console, each checked before it is taken.

#include <algorithm>
#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {

bool Gateway::Core::lines_open() const {
  const bool runs =
      state_ == MachineState::kRunning || state_ == MachineState::kHolding || state_ == MachineState::kHeld;
  return runs && print_.live() && !lines_closing_;
}

Result<void, Refusal> Gateway::Core::open_lines(std::string name) {
  if (auto ok = check(MachineCommand::kRun); !ok) return ok;
  const auto pose = machine_pose();
  if (!pose) return Error<Refusal>(pose.error());
  live_commands_.clear();
  const double target = thermal_.heater(Heater::kHotend).target_celsius;
  live_lines_.begin(*pose, target > 0 ? std::optional(target) : std::nullopt, live_commands_);
  give_up_job();
  runner_ = &print_;
  print_.start_live(*pose);
  print_.set_override(override_);
  for (const canonical::Line& command : live_commands_) print_.add(now_, command);
  job_name_ = std::move(name);
  job_report_ = {};
  job_started_ = now_;
  job_follows_ = lines_closing_ = false;
  enter(MachineState::kRunning);
  return {};
}

Result<void, Refusal> Gateway::Core::take_line(std::string_view line, std::uint32_t number) {
  const bool open = lines_open();
  if (!open) live_lines_.end();
  live_commands_.clear();
  const gcode::WorkOffsets offsets = live_lines_.work_offsets();
  if (const auto taken = live_lines_.take(line, number, live_commands_); !taken)
    return Error<Refusal>(Refusal{taken.error().words});
  if (live_lines_.work_offsets() != offsets)
    journal_.push(journal::Offsets{identity(machine_), live_lines_.work_offsets()});
  for (Sentence& note : live_lines_.take_notes()) events_.message(now_, std::move(note), number);
  for (const canonical::Line& command : live_commands_) {
    if (open) {
      print_.add(now_, command);
    } else if (const auto* thermal = std::get_if<canonical::Thermal>(&command.command)) {
      if (auto ok = check(MachineCommand::kThermal); !ok) return ok;
      if (thermal->what == canonical::Thermal::What::kFan)
        thermal_.set_fan(thermal->value);
      else
        thermal_.set_target(
            thermal->what == canonical::Thermal::What::kHotend ? Heater::kHotend : Heater::kBed,
            thermal->value);
    } else if (const auto* spindle = std::get_if<canonical::Spindle>(&command.command)) {
      if (auto ok = check(MachineCommand::kThermal); !ok) return ok;
      thermal_.set_spindle(spindle->rpm);
    } else if (const auto* message = std::get_if<canonical::Message>(&command.command)) {
      events_.message(now_, Sentence::verbatim(message->text), number);
    }
  }
  return {};
}

std::size_t Gateway::Core::line_room() const {
  return lines_open() ? kLineRoom - std::min(kLineRoom, print_.live_waiting()) : 0;
}

bool Gateway::Core::lines_idle() const {
  return lines_open() && print_.live_idle();
}

void Gateway::Core::close_lines() {
  if (!lines_open()) return;
  lines_closing_ = true;
  print_.end_live();
}

void Gateway::Core::forget_line_modes() {
  if (!lines_open()) live_lines_.forget();
}

}  // namespace kinebus
