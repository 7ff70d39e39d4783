// What a line means: which code goes where, and what is answered at once.

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "gateway/gcode/words/codes.hpp"
#include "gateway/sessions/serial/line_control.hpp"
#include "gateway/sessions/serial/marlin_session.hpp"
#include "gateway/status/temperature_text.hpp"

namespace kinebus {
namespace {

using serial::Code;
using serial::Line;
using serial::Urgent;

LocalTime seconds(double value) {
  return LocalTime{static_cast<std::int64_t>(std::clamp(value, 0.0, 3600.0) * 1e9)};
}

/// Lines that need the machine to be open for motion; all others are only modes and settings.
bool moves(std::string_view text) {
  const Code code = serial::code_of(text);
  if (code.letter == 'G') {
    static constexpr std::array kModal{15, 17, 18, 19, 20, 21, 40, 43, 49, 54, 55, 56, 57, 58,
                                       59, 61, 64, 68, 69, 80, 90, 91, 92, 93, 94, 98, 99};
    return std::find(kModal.begin(), kModal.end(), code.number) == kModal.end() ||
           text.find_first_of("XYZACEIJxyzaceij") != std::string_view::npos;
  }
  if (code.letter == 'M') {
    static constexpr std::array kCarriedOut{0, 1, 2, 30, 400};
    return std::find(kCarriedOut.begin(), kCarriedOut.end(), code.number) != kCarriedOut.end();
  }
  return code.letter != 'T' && code.letter != 0 && code.letter != '(' && code.letter != '#';
}

/// What M118 says: E1 and A1 choose how the host takes it, P the port.
std::string told(std::string_view text) {
  bool action = false;
  while (text.size() >= 2 && std::string_view("EAP").find(text[0]) != std::string_view::npos &&
         (text[1] >= '0' && text[1] <= '9') && (text.size() == 2 || text[2] == ' ')) {
    action = text[0] == 'A' ? text[1] == '1' : action;
    text.remove_prefix(std::min(text.size(), std::size_t{3}));
  }
  return (action ? "//" : "echo:") + std::string(text);
}

/// They take effect when they are taken: nothing before them makes them wait.
bool takes_effect_at_once(const Code& code) {
  return code.is('M', 104) || code.is('M', 140) || code.is('M', 141);
}

/// "ok" means that they are carried out, not only taken.
bool waits_for_end(const Code& code) {
  return code.is('G', 28) || code.is('G', 4) || code.is('M', 400) || code.is('M', 109) || code.is('M', 190) ||
         code.is('M', 191) || code.is('M', 0) || code.is('M', 1) || code.is('M', 2) || code.is('M', 30);
}

}  // namespace

bool MarlinSession::machine_stopped() const {
  const MachineState state = gateway_.state();
  return state == MachineState::kStopping || state == MachineState::kStopped || state == MachineState::kAlarm;
}

bool MarlinSession::only_heat_waits() const {
  const auto comes_first = [](const Line& line) {
    const Code code = serial::code_of(line.text);
    const bool heats = code.is('M', 104) || code.is('M', 109) || code.is('M', 140) || code.is('M', 190) ||
                       code.is('M', 141) || code.is('M', 191);
    return moves(line.text) || (heats && serial::urgent(line.text) != Urgent::kHeaterOff);
  };
  return heats_ && wait_ != Wait::kTuning && !lines_.empty() &&
         std::none_of(lines_.begin() + 1, lines_.end(), comes_first);
}

/// The machine is as safe as before: "Error:" would make hosts give up and send M112. A numbered line is one
/// of a print, which is not whole without it: the host is asked to pause and tell why.
MarlinSession::Done MarlinSession::refuse(std::string_view words) {
  ++counters_.refused;
  say("echo:" + std::string(words));
  if (!lines_.empty() && lines_.front().number && !halted_ && !dropped_) {
    say("//action:notification " + std::string(words));
    say("//action:pause");
  }
  return Done::kYes;
}

MarlinSession::Done MarlinSession::carry_out(const Line& line) {
  if (!line.error.empty()) {
    ++counters_.resends;
    say("Error:" + line.error);
    say("Resend: " + std::to_string(line.resend));
    say("ok");
    return Done::kSilent;
  }
  if (line.repeated) return Done::kYes;
  const Code code = serial::code_of(line.text);
  if (!writing_.empty() && !code.is('M', 29)) {
    write_line(line);
    return Done::kYes;
  }
  if (code.letter == 0 || code.letter == ';' || code.letter == '%') return Done::kYes;
  if (halted_ && !code.is('M', 999)) {
    if (!machine_stopped()) {
      halted_ = false;  // others cleared it
    } else {
      if (serial::urgent(line.text) != Urgent::kNone) return Done::kYes;
      return refuse("the machine is stopped: M999 lifts the stop");
    }
  }
  if (serial::changes_machine(code) && !may_command()) return refuse(no_control());
  if (code.letter == 'M' && code.number >= 0) return carry_out_m(line, code.number);
  return to_machine(line);
}

MarlinSession::Done MarlinSession::query(const Line& line) {
  const auto answer = gateway_.text_line(line.text);
  if (!answer) return refuse(answer.error().words);
  if (!answer->empty()) say(*answer);
  return Done::kYes;
}

std::string MarlinSession::temperatures() const {
  return temperature_text(gateway_.status());
}

MarlinSession::Done MarlinSession::carry_out_m(const Line& line, int number) {
  switch (number) {
    case 20:
    case 21:
    case 22:
    case 23:
    case 24:
    case 25:
    case 26:
    case 27:
    case 28:
    case 29:
    case 30:
    case 31:
    case 32:
    case 524:
      return file_code(line, number);
    case 105:
      say("ok " + temperatures());
      return Done::kSilent;
    case 108:
    case 112:
    case 410:
      return Done::kYes;  // seen when they came
    case 110:
      dropped_ = false;
      return Done::kYes;
    case 113:
      if (const auto s = serial::word(line.text, 'S')) options_.keep_alive = seconds(*s);
      return Done::kYes;
    case 114:
    case 119:
    case 503:
    case 906:
      return query(line);
    case 420:
      return serial::word(line.text, 'S') || serial::word(line.text, 'Z') ? to_machine(line) : query(line);
    case 220:
    case 221:
      return serial::word(line.text, 'S') ? to_machine(line) : query(line);
    case 115: {
      if (const Done done = query(line); done != Done::kYes) return done;
      for (const char* capability :
           {"SERIAL_XON_XOFF:0", "EEPROM:0", "VOLUMETRIC:0", "AUTOREPORT_POS:0", "AUTOREPORT_TEMP:1",
            "PROGRESS:0", "PRINT_JOB:0", "AUTOLEVEL:0", "EMERGENCY_PARSER:1", "HOST_ACTION_COMMANDS:1",
            "PROMPT_SUPPORT:0", "SDCARD:1", "AUTOREPORT_SD_STATUS:1", "LONG_FILENAME:1",
            "THERMAL_PROTECTION:1", "BUSY_PROTOCOL:1", "ARCS:1"})
        say(std::string("Cap:") + capability);
      return Done::kYes;
    }
    case 118:
      say(told(serial::argument(line.text)));
      return Done::kYes;
    case 155:
      temperature_period_ = seconds(serial::word(line.text, 'S').value_or(0));
      next_temperature_ = now_ + temperature_period_;
      return Done::kYes;
    case 17:
      if (gateway_.state() != MachineState::kOff) return Done::kYes;
      if (const auto begun = gateway_.carry_out(command::BringUp{}); !begun)
        return refuse(begun.error().words);
      wait_ = Wait::kBringUp;
      return Done::kWaiting;
    case 18:
    case 84:
      say("echo:the motors go on holding: a platform on vertical rails would fall");
      return Done::kYes;
    case 109:
    case 190:
    case 191:
      if (!mine_ && gateway_.state() != MachineState::kReady) {
        return heat_and_wait(line, number == 109   ? HeaterKind::kHotend
                                   : number == 190 ? HeaterKind::kBed
                                                   : HeaterKind::kChamber);
      }
      return to_machine(line);
    case 303:
      return measure_and_wait(line);
    case 999:
      if (!machine_stopped()) {
        halted_ = false;
        return Done::kYes;
      }
      if (const auto cleared = gateway_.carry_out(command::Clear{});
          !cleared && gateway_.state() != MachineState::kStopping)
        return refuse(cleared.error().words);
      wait_ = Wait::kClear;
      return Done::kWaiting;
    default:
      break;
  }
  if (gcode::m_group(number) == gcode::MGroup::kUnknown) {
    say("echo:Unknown command: \"" + line.text + "\"");
    return Done::kYes;
  }
  return to_machine(line);
}

/// G-code: to the gateway, opened for lines when they move.
MarlinSession::Done MarlinSession::to_machine(const Line& line) {
  const Code code = serial::code_of(line.text);
  const bool opens = moves(line.text) || code.is('M', 109) || code.is('M', 190) || code.is('M', 191);
  if (code.is('G', 28)) dropped_ = false;
  if (!mine_ && opens) {
    if (dropped_)
      return refuse("the print was cancelled at the machine: nothing moves until G28 or a new print (M110)");
    const MachineState state = gateway_.state();
    if (code.is('G', 28) && state != MachineState::kReady) return home(line);
    if (state == MachineState::kOff || state == MachineState::kUnhomed)
      return refuse("home the machine first (G28)");
    // A move of this session's earlier lines, or of another client, is still being finished.
    if (state == MachineState::kMoving || (state == MachineState::kRunning && !file_runs_ &&
                                           !gateway_.lines_open() && gateway_.status().job == options_.name))
      return Done::kWaiting;
    if (const auto opened = gateway_.carry_out(command::OpenLines{options_.name}); !opened)
      return refuse(opened.error().words);
    mine_ = true;
  }
  return feed(line);
}

MarlinSession::Done MarlinSession::feed(const Line& line) {
  const Code code = serial::code_of(line.text);
  if (mine_ && gateway_.line_room() == 0 && !takes_effect_at_once(code)) return Done::kWaiting;
  if (!mine_ && gateway_.lines_open()) return refuse("another client's lines move the machine");
  if (const auto taken = gateway_.take_line(line.text, ++count_); !taken) return refuse(taken.error().words);
  if (!mine_ || !waits_for_end(code)) return Done::kYes;
  wait_ = Wait::kIdle;
  heats_ = code.is('M', 109) || code.is('M', 190) || code.is('M', 191);
  if (heats_) next_temperature_ = now_ + kHeatReport;
  return Done::kWaiting;
}

}  // namespace kinebus
