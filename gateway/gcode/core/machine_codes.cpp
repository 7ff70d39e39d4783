// M codes, except heat and spindle, what M0, M1, M2, M30 stop and M82, M83 set. Those of printers' settings:
// printer_settings.cpp.

#include <array>
#include <string>
#include <utility>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"

namespace kinebus::gcode {
namespace {

using StoredWhat = canonical::StoredJob::What;
struct JobCode {
  int number;
  StoredWhat what;
  bool needs_name;
};
constexpr std::array<JobCode, 12> kJobCodes = {{{20, StoredWhat::kList, false},
                                                {21, StoredWhat::kInit, false},
                                                {22, StoredWhat::kRelease, false},
                                                {23, StoredWhat::kSelect, true},
                                                {24, StoredWhat::kStart, false},
                                                {25, StoredWhat::kPause, false},
                                                {26, StoredWhat::kSetPosition, false},
                                                {27, StoredWhat::kStatus, false},
                                                {28, StoredWhat::kBeginWrite, true},
                                                {29, StoredWhat::kEndWrite, false},
                                                {31, StoredWhat::kStatus, false},
                                                {32, StoredWhat::kRun, true}}};

}  // namespace

bool Core::run_machine_code(Code code) {
  using canonical::Query;
  using canonical::Settings;
  switch (code.number) {
    case 3:
    case 4:
    case 5:
      return spindle(code);
    case 9:
    case 6:
    case 82:
    case 83:
      return true;  // no coolant; the rest is done in run_modes()
    case 61: {
      int tool = 0;
      if (!has('Q')) return fail(code.column, say("M61 needs the tool Q"));
      if (!take_integer('Q', 0, 99999, tool)) return false;
      const int before = hotend_in_use();
      state_.modal.tool = state_.modal.tool_in_spindle = tool;
      tell_hotend(before);
      return true;
    }
    case 62:
    case 63:
    case 64:
    case 65: {
      canonical::Thermal output;
      output.what = canonical::Thermal::What::kOutput;
      output.value = code.number % 2 == 0 ? 1 : 0;
      if (!has('P')) return fail(code.column, say("%1 needs the output P", m_name(code.number)));
      if (!take_integer('P', 0, 7, output.index)) return false;
      emit(output);
      return true;
    }
    case 66:
      return await_input(code);
    case 67:
    case 68: {
      canonical::Thermal output;
      output.what = canonical::Thermal::What::kOutput;
      if (!has('E') || !has('Q'))
        return fail(code.column, say("%1 needs the output E and its value Q", m_name(code.number)));
      if (!take_integer('E', 0, 7, output.index) || !take('Q', output.value)) return false;
      if (output.value < 0 || output.value > 1)
        return fail(block_.column_of('Q'), say("an output's value Q is 0 to 1"));
      emit(output);
      return true;
    }
    case 70:
    case 71:
    case 72:
      return saved_modes(code);
    case 73:
      if (options_.spindle && (block_.text.empty() || block_.text.front() == '(')) return saved_modes(code);
      break;  // of printers: progress
    case 98:
    case 99:
      return program_call(code);
    case 486:
      return object_code(code);
    case 374:
    case 375:
    case 420:
    case 421:
    case 561:
      return mesh_code(code);
    case 116:
      return wait_for_temperatures();
    case 568:
      return tool_temperature('P');
    case 200: {
      double diameter = 0;
      if (!take_if_given('D', diameter)) return false;
      if (diameter > 0)
        return fail(code.column,
                    say("volumetric extrusion (M200 D) is not supported: use lengths of filament"));
      pass_over('S');
      pass_over('T');
      note(200, say("%1 has no effect on this machine", m_name(200)));
      return true;
    }
    case 17:
    case 18:
    case 84:
      return motors(code);
    case 104:
    case 109:
    case 140:
    case 190:
    case 141:
    case 191:
      return thermal(code);
    case 42:
    case 106:
    case 107:
    case 126:
    case 127:
      return fan(code);
    case 105:
      pass_over('T');
      emit(Query{Query::What::kTemperature});
      return true;
    case 110:
      pass_over('N');
      return true;  // line numbers are checked where lines are received
    case 112:
      emit(canonical::EmergencyStop{});
      return true;
    case 114:
      emit(Query{Query::What::kPosition});
      return true;
    case 115:
      if (block_.text_of_m == 115) note(115, say("%1 has no effect on this machine", "M115 U"));
      emit(Query{Query::What::kFirmware});
      return true;
    case 119:
      emit(Query{Query::What::kSwitches});
      return true;
    case 117:
    case 118:
      emit(canonical::Message{std::string(block_.text)});
      return true;
    case 92:
    case 143:
    case 206:
    case 301:
    case 302:
    case 304:
    case 305:
    case 306:
    case 307:
    case 308:
    case 665:
    case 666:
    case 906:
    case 907:
      return firmware_setting(code);
    case 303:
      return fail(code.column,
                  say("M303 measures a heater, which no job does: write it on the console or send "
                      "it from a print host while nothing runs"));
    case 201:
      return rules_->m201_is_printing ? axis_acceleration(code) : axis_limits(code);
    case 202:
      return axis_acceleration(code);
    case 203:
      return axis_limits(code);
    case 204:
      return acceleration_limits();
    case 205:
      return jerk();
    case 207:
    case 208:
      return retract_settings(code);
    case 220:
    case 221:
      return override_ratio(code);
    case 572:
    case 900:
      return pressure_advance(code);
    case 593:
      return input_shaping();
    case 280:
    case 401:
    case 402:
      return probe_pin(code);
    case 400:
      emit(canonical::WaitIdle{});
      return true;
    case 500:
      emit(Settings{Settings::What::kStore});
      return true;
    case 501:
      emit(Settings{Settings::What::kLoad});
      return true;
    case 502:
      emit(Settings{Settings::What::kReset});
      return true;
    case 503:
      pass_over('S');
      emit(Settings{Settings::What::kReport});
      return true;
    default:
      break;
  }
  if (m_group(code.number) == MGroup::kJobs) return stored_job(code);
  note(code.number, say("%1 has no effect on this machine", m_name(code.number)));
  return true;
}

bool Core::program_call(Code code) {
  call_ = {};
  call_.column = code.column;
  if (code.number == 99) {
    call_.what = ProgramCall::What::kReturn;
    return !has('P') || fail(block_.column_of('P'), say("M99 P is not supported: M99 goes back to the call"));
  }
  if (block_.text_of_m == 98) return macro_file_call();
  call_.what = ProgramCall::What::kProgram;
  if (!has('P')) return fail(code.column, say("M98 needs the program P"));
  return take_integer('P', 0, 99'999'999, call_.number) && take_integer('L', 0, 9999, call_.times);
}

bool Core::motors(Code code) {
  if (code.number != 17 && has('S')) {
    // M84 S120 sets an idle time in printer firmware and switches nothing off at once.
    pass_over('S');
    note(code.number, say("the idle time of M%1 S has no effect on this machine", code.number));
    return true;
  }
  unsigned axes = 0;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    if (!has(kAxisLetters[axis])) continue;
    pass_over(kAxisLetters[axis]);
    axes |= 1U << axis;
  }
  if (code.number == 17)
    emit(canonical::MotorsOn{});
  else
    emit(canonical::MotorsOff{static_cast<std::uint8_t>(axes)});
  return true;
}

/// A BLTouch. M280 tells it an angle of its servo: those that it knows, others would move it nowhere.
bool Core::probe_pin(Code code) {
  using What = canonical::ProbePin::What;
  if (!options_.probe_pin) {
    for (char letter = 'A'; letter <= 'Z'; ++letter) pass_over(letter);
    note(code.number, say("%1 has no effect on this machine", m_name(code.number)));
    return true;
  }
  if (code.number != 280) {
    emit(canonical::ProbePin{code.number == 401 ? What::kOut : What::kIn});
    return true;
  }
  constexpr int kTouchMode = 60;  // which a pin that is out is in
  constexpr std::array<std::pair<int, What>, 4> kAngles{
      {{10, What::kOut}, {90, What::kIn}, {120, What::kSelfTest}, {160, What::kReset}}};
  int servo = 0, angle = -1;
  if (!take_integer('P', 0, 255, servo) || !take_integer('S', 0, 10'000, angle)) return false;
  if (servo != 0) note(280, say("%1 has no effect on this machine", "M280 P" + std::to_string(servo)));
  if (servo != 0 || angle == kTouchMode) return true;
  for (const auto& [known, what] : kAngles)
    if (known == angle) {
      emit(canonical::ProbePin{what});
      return true;
    }
  return fail(code.column,
              say("M280 moves the probe's pin: S10 out, S90 in, S120 self test, S160 ends an alarm"));
}

bool Core::stored_job(Code code) {
  for (const JobCode& entry : kJobCodes) {
    if (entry.number != code.number) continue;
    canonical::StoredJob command{entry.what, {}, 0};
    if (entry.needs_name) {
      command.name = block_.text;
      if (command.name.empty())
        return fail(code.column, say("%1 needs the name of a stored job", m_name(code.number)));
    }
    if (entry.what == StoredWhat::kSetPosition) {
      int position = 0;
      if (!has('S')) return fail(code.column, say("M26 needs a byte position S"));
      if (!take_integer('S', 0, 1'000'000'000, position)) return false;
      command.position = static_cast<std::uint64_t>(position);
    }
    if (code.number == 27) pass_over('S');
    emit(std::move(command));
    return true;
  }
  return fail(code.column, unknown_m(code.number));
}

}  // namespace kinebus::gcode
