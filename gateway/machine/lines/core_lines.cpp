// Lines as they come, from a print host or a console.

#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {
using Done = Result<void, Refusal>;

/// A host that cancels wants its heaters off now, not when the motion before is done.
bool takes_effect_at_once(const canonical::Line& line) {
  const auto* thermal = std::get_if<canonical::Thermal>(&line.command);
  return thermal != nullptr && !thermal->wait && heater_of(*thermal);
}

}  // namespace

bool Gateway::Core::lines_open() const {
  return state_.is_one_of(MachineState::kRunning, MachineState::kHolding, MachineState::kHeld) &&
         print_.runner().live() && !lines_.closing();
}

Done Gateway::Core::on(command::OpenLines& asked) {
  const auto pose = machine_pose();
  if (!pose) return Error<Refusal>(pose.error());
  const gcode::CommandBuffer& in_force = lines_.open(*pose, heat_.hotends_found());
  give_up_job();
  Runner& runner = print_.runner();
  runner_ = &runner;
  runner.start_live(*pose);
  runner.set_override(override_);
  for (const canonical::Line& command : in_force) runner.add(now_, command);
  print_.rename(std::move(asked.name));
  print_.forget_report();
  hand_.forget_then();
  print_.begin_clock(now_);
  enter(MachineState::kRunning);
  return {};
}

Done Gateway::Core::take_line(std::string_view line, std::uint32_t number) {
  const bool open = lines_open();
  if (!open && print_.runner().active())
    if (auto done = object_line(line)) return *std::move(done);
  std::optional<Sentence> still;
  if (!open) {
    const auto may_open = may(command::kind<command::OpenLines>);
    still = may_open ? say("no lines are open") : may_open.error().words;
  }
  const auto commands = lines_.take(std::move(still), line, number);
  if (!commands) return Error<Refusal>(commands.error());
  for (Sentence& note : lines_.take_notes()) events_.message(now_, std::move(note), number);
  for (const canonical::Line& command : *commands) {
    if (open && !takes_effect_at_once(command))
      print_.runner().add(now_, command);
    else if (auto done = carry_out_at_rest(command); !done)
      return done;
  }
  if (open) print_.runner().plan_live();
  return {};
}

/// What does not move.
Done Gateway::Core::carry_out_at_rest(const canonical::Line& line) {
  if (const auto* thermal = std::get_if<canonical::Thermal>(&line.command)) {
    if (const auto heater = heater_of(*thermal))
      return carry_out(command::SetTemperature{*heater, thermal->value});
    const auto index = static_cast<std::uint8_t>(thermal->index);
    if (thermal->what == canonical::Thermal::What::kOutput)
      return carry_out(command::SetOutput{thermal->value, index});
    // A line for a fan that is not there is taken, with a note.
    if (missing_fan(machine_, *thermal)) return {};
    return carry_out(command::SetFan{thermal->value, index});
  }
  if (const auto* tool = std::get_if<canonical::Tool>(&line.command)) return choose_hotend(tool->hotend);
  if (const auto* spindle = std::get_if<canonical::Spindle>(&line.command))
    return carry_out(command::SetSpindle{spindle->rpm});
  if (const auto* pin = std::get_if<canonical::ProbePin>(&line.command))
    return carry_out(command::MovePin{pin_order(*pin)});
  if (const auto* wait = std::get_if<canonical::AwaitInput>(&line.command)) {
    const Input* const input = heat_.input(wait->index);
    const InputLevel level = input != nullptr ? input->level() : InputLevel::kUnknown;
    lines_.input_read(level == InputLevel::kUnknown ? gcode::kNoInput : level == InputLevel::kOn ? 1 : 0);
  }
  if (const auto* message = std::get_if<canonical::Message>(&line.command))
    events_.message(now_, Sentence::verbatim(message->text), line.line);
  if (const auto* mesh = std::get_if<canonical::Mesh>(&line.command)) return level_at_rest(*mesh, line.line);
  return {};
}

/// For what is fed by hand. A job that is interrupted goes on with its own.
Done Gateway::Core::choose_hotend(int hotend) {
  const bool job = print_.runner().active();
  if (job && !print_.runner().suspended()) return refused(say("a job is under way: it chooses its tools"));
  if (job && !heat_.kept()) {
    heat_.note(journal_);
    heat_.keep();
  }
  heat_.select(hotend);
  return {};
}

/// The machine stands; a job that is interrupted goes on as it was levelled.
Done Gateway::Core::level_at_rest(const canonical::Mesh& command, std::uint32_t line) {
  Done done;
  if (command.what == canonical::Mesh::What::kEnd || command.what == canonical::Mesh::What::kBegin)
    done = refused(say("the bed is measured when the machine is ready: bring up and home it first"));
  else if (BedLevel::moves_poses(command) && (runner_->active() || interrupted()))
    done = refused(say("a job is under way: the bed mesh stays as it is"));
  else if (auto changed = bed_.carry_out(now_, command, {}, line); !changed)
    done = refused(changed.error());
  std::optional<PlannedPose> stand;
  if (const auto pose = machine_pose()) stand = PlannedPose{*pose, Frame::kMachine, line};
  lines_.levelled(stand);
  return done;
}

std::size_t Gateway::Core::line_room() {
  return lines_open() && !lines_.probes() ? print_.runner().live_room(now_, kLineRoom) : 0;
}

bool Gateway::Core::lines_idle() const {
  return lines_open() && print_.runner().live_idle();
}

void Gateway::Core::close_lines() {
  if (!lines_open()) return;
  lines_.close();
  print_.runner().end_live();
}

void Gateway::Core::leave_lines() {
  if (!lines_open()) return;
  close_lines();
  const auto lead = std::chrono::duration<double>(machine_.serial.lead_s);
  lines_.give_up_from(now_ + std::chrono::duration_cast<BusTime>(lead) - machine_.stop.hold_ramp);
}

void Gateway::Core::skip_heating() {
  if (lines_open()) print_.runner().skip_heating();
}

void Gateway::Core::forget_line_modes() {
  if (!lines_open()) lines_.forget_modes();
}

}  // namespace kinebus
