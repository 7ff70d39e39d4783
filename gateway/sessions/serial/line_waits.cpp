// Lines whose "ok" comes when they are carried out: homing, heating, motion to its end, a stop that is
// lifted.

#include <algorithm>

#include "gateway/sessions/serial/marlin_session.hpp"

namespace kinebus {
namespace {

using serial::Line;

/// Half of the window that the machine's own wait uses: hosts see the heater arrive.
constexpr double kHeaterWindow_c = 2;

}  // namespace

/// G28 while positions are not known: everything that leads there.
MarlinSession::Done MarlinSession::home(const Line&) {
  const MachineState state = gateway_.state();
  if (state == MachineState::kOff) {
    if (const auto begun = gateway_.carry_out(command::BringUp{}); !begun) return refuse(begun.error().words);
    wait_ = Wait::kBringUp;
    homing_ = true;
    return Done::kWaiting;
  }
  if (state == MachineState::kUnhomed) {
    if (const auto begun = gateway_.carry_out(command::Home{}); !begun) return refuse(begun.error().words);
    wait_ = Wait::kHoming;
    homing_ = true;
    return Done::kWaiting;
  }
  if (state == MachineState::kMoving || state == MachineState::kHoming || state == MachineState::kBringUp)
    return Done::kWaiting;
  return refuse("cannot home while the machine is " + std::string(to_string(state)));
}

MarlinSession::Done MarlinSession::heat_and_wait(const Line& line, HeaterKind kind) {
  if (const auto taken = gateway_.take_line(line.text, ++count_); !taken) return refuse(taken.error().words);
  const char letter = kind == HeaterKind::kHotend ? 'T' : 'P';
  waits_for_ = {
      kind, static_cast<std::uint8_t>(std::clamp(serial::word(line.text, letter).value_or(0), 0.0, 255.0))};
  waits_cooling_ = serial::word(line.text, 'R').has_value();
  wait_ = Wait::kHeater;
  heats_ = true;
  next_temperature_ = now_ + kHeatReport;
  return Done::kWaiting;
}

/// M303: nothing runs meanwhile, this session's own lines neither.
MarlinSession::Done MarlinSession::measure_and_wait(const Line& line) {
  if (mine_) {
    if (!gateway_.lines_idle()) return Done::kWaiting;
    gateway_.close_lines();
    mine_ = false;
  }
  const bool closes = gateway_.state() == MachineState::kRunning && !file_runs_ && !gateway_.lines_open() &&
                      gateway_.status().job == options_.name;
  if (closes) return Done::kWaiting;
  if (const auto begun = gateway_.text_line(line.text); !begun) return refuse(begun.error().words);
  wait_ = Wait::kTuning;
  heats_ = true;
  next_temperature_ = now_ + kHeatReport;
  return Done::kWaiting;
}

/// The line at the front is under way: is it over?
MarlinSession::Done MarlinSession::wait_over() {
  const MachineState state = gateway_.state();
  const auto over = [this] {
    stop_waiting();
    return Done::kYes;
  };
  const auto failed = [&](std::string_view what) {
    stop_waiting();
    return refuse(std::string(what) + ": the machine is " + std::string(to_string(state)));
  };
  switch (wait_) {
    case Wait::kNone:
      return Done::kYes;
    case Wait::kIdle:
      if (!mine_) return over();
      return gateway_.lines_idle() ? over() : Done::kWaiting;
    case Wait::kHeater: {
      const MachineStatus s = gateway_.status();
      const HeaterStatus heater = s.heater(waits_for_);
      const bool warm = heater.actual_celsius >= heater.target_celsius - kHeaterWindow_c;
      const bool cool = !waits_cooling_ || heater.actual_celsius <= heater.target_celsius + kHeaterWindow_c;
      return (warm && cool) || (heater.target_celsius <= 0 && !waits_cooling_) ? over() : Done::kWaiting;
    }
    case Wait::kTuning: {
      const MachineStatus s = gateway_.status();
      const bool runs = std::any_of(s.heaters.begin(), s.heaters.end(),
                                    [](const NamedHeaterStatus& h) { return h.tuning.runs(); });
      return runs ? Done::kWaiting : over();
    }
    case Wait::kBringUp:
      if (state == MachineState::kBringUp) return Done::kWaiting;
      if (state != MachineState::kUnhomed && state != MachineState::kReady) return failed("bring-up failed");
      if (!homing_) return over();
      stop_waiting();
      return carry_out(lines_.front());
    case Wait::kHoming:
      if (state == MachineState::kHoming) return Done::kWaiting;
      if (state != MachineState::kReady) return failed("homing failed");
      stop_waiting();
      return carry_out(lines_.front());
    case Wait::kClear:
      if (state == MachineState::kStopping) return Done::kWaiting;
      if (state == MachineState::kStopped || state == MachineState::kAlarm) {
        if (const auto again = gateway_.carry_out(command::Clear{}); !again)
          return refuse(again.error().words);
        return Done::kWaiting;
      }
      // What was under way when it was stopped is not gone on with: the host has forgotten it.
      if (state == MachineState::kHeld) {
        static_cast<void>(gateway_.carry_out(command::Cancel{}));
        return Done::kWaiting;
      }
      if (state == MachineState::kCancelling) return Done::kWaiting;
      halted_ = dropped_ = false;
      return over();
  }
  return Done::kYes;
}

}  // namespace kinebus
