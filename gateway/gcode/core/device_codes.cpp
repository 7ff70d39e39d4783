// M codes of heaters, fans and outputs.
#include <algorithm>
#include <cmath>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {
namespace {

constexpr int kNoteForP = 99997;

}  // namespace

void Core::remember(const canonical::Thermal& thermal) {
  using What = canonical::Thermal::What;
  ModalState& m = state_.modal;
  if (thermal.what == What::kHotend)
    m.hotend_celsius[static_cast<std::size_t>(std::clamp(thermal.index, 0, 7))] = thermal.value;
  if (thermal.what == What::kBed && thermal.index == 0) m.bed_celsius = thermal.value;
  if (thermal.what == What::kChamber && thermal.index == 0) m.chamber_celsius = thermal.value;
}

double Core::target_of(const canonical::Thermal& thermal) const {
  using What = canonical::Thermal::What;
  const ModalState& m = state_.modal;
  if (thermal.what == What::kHotend)
    return m.hotend_celsius[static_cast<std::size_t>(std::clamp(thermal.index, 0, 7))];
  if (thermal.index != 0) return 0;
  return thermal.what == What::kBed ? m.bed_celsius : m.chamber_celsius;
}

/// G10 P S, M568 P S.
bool Core::tool_temperature(char tool_letter) {
  canonical::Thermal command;
  command.what = canonical::Thermal::What::kHotend;
  command.index = hotend_in_use();
  if (!take_integer(tool_letter, 0, options_.hotends - 1, command.index)) return false;
  const bool given = has('S');
  if (given && !take('S', command.value)) return false;
  if (command.value < 0)
    return fail(block_.column_of('S'), say("a target temperature cannot be below 0 deg C"));
  for (const char letter : {'R', 'A', 'F', 'X', 'Y', 'Z'}) pass_over(letter);  // standby, offsets of the tool
  if (!given) return true;
  remember(command);
  emit(command);
  return true;
}

/// M116: those that were set before and are not off.
bool Core::wait_for_temperatures() {
  using What = canonical::Thermal::What;
  const ModalState& m = state_.modal;
  for (const char letter : {'P', 'H', 'C', 'S'}) pass_over(letter);
  const auto wait = [this](What what, double celsius, int index) {
    if (!(celsius > 0)) return;
    canonical::Thermal command;
    command.what = what;
    command.value = celsius;
    command.index = index;
    command.wait = true;
    emit(command);
  };
  wait(What::kBed, m.bed_celsius, 0);
  wait(What::kChamber, m.chamber_celsius, 0);
  for (int i = 0; i < std::min(options_.hotends, 8); ++i)
    wait(What::kHotend, m.hotend_celsius[static_cast<std::size_t>(i)], i);
  return true;
}

bool Core::thermal(Code code) {
  using What = canonical::Thermal::What;
  canonical::Thermal command;
  const std::string name = m_name(code.number);
  const bool chamber = code.number == 141 || code.number == 191;
  command.what = code.number < 140 ? What::kHotend : chamber ? What::kChamber : What::kBed;
  command.wait = code.number == 109 || code.number >= 190;
  for (const char letter : {'C', 'W'}) pass_over(letter);  // window and time of the wait
  const bool both = command.wait && has('R');
  const bool by_p = !has('S') && !both && has('P') && value_by_p(code);
  if (has('S') && both) return fail(block_.column_of('R'), say("%1 takes S or R, not both", name));
  const bool given = has('S') || both || by_p;
  const char letter = by_p ? 'P' : both ? 'R' : 'S';
  if (given && !take(letter, command.value)) return false;
  if (command.value < 0)
    return fail(block_.column_of(letter), say("a target temperature cannot be below 0 deg C"));
  command.wait_cooling = both;
  if (given && command.what == What::kHotend && has('T') && !block_.is_bare('T') &&
      block_['T'] >= options_.hotends && command.value == 0) {
    // A hot end that is not there is off.
    pass_over('T');
    note(code.number, say("%1 has no effect on this machine", name + " T"));
    return true;
  }
  if (command.what == What::kHotend) {
    command.index = hotend_in_use();
    if (!take_integer('T', 0, options_.hotends - 1, command.index)) return false;
  } else if (!by_p && !take_integer('P', 0, 7, command.index)) {
    return false;
  }
  // Alone M109 waits for what was set before.
  if (!given && command.wait) command.value = target_of(command);
  if (!given && !(command.value > 0))
    return fail(code.column, command.wait ? say("%1 needs a temperature S or R", name)
                                          : say("%1 needs a temperature S", name));
  remember(command);
  emit(command);
  return true;
}

/// In a slicer's text whose A is extrusion a P without S tells that it is written for Machinekit or Mach3.
bool Core::value_by_p(Code code) {
  if (state_.modal.dialect == Dialect::kGeneral && state_.modal.a_extrudes && code.number != 42) {
    set_dialect(Dialect::kMachinekit);
    note(kNoteForP, say("P of %1 is read as its value, as slicers write it for Mach3 and Machinekit",
                        m_name(code.number)));
  }
  return rules_->p_is_value;
}

bool Core::fan(Code code) {
  canonical::Thermal command;
  using What = canonical::Thermal::What;
  command.what = code.number == 42 ? What::kOutput : What::kFan;
  if (code.number == 42 && (!has('P') || !has('S')))
    return fail(code.column, say("M42 needs the output P and its value S"));
  const bool by_p = code.number == 106 && !has('S') && has('P') && rules_->p_is_value;
  if (!by_p && !take_integer('P', 0, 7, command.index)) return false;
  const bool off = code.number == 107 || code.number == 127;
  if (code.number == 126 || off) pass_over('T');
  if (!off) {
    double speed = 255;
    if (!take_if_given(by_p ? 'P' : 'S', speed)) return false;
    if (rules_->share_of_one && speed <= 1) speed *= 255;
    if (speed < 0 || speed > 255)
      return fail(block_.column_of(by_p ? 'P' : 'S'), code.number == 42
                                                          ? say("an output's value S is 0 to 255")
                                                          : say("the fan's speed S is 0 to 255"));
    command.value = speed / 255;
  }
  emit(command);
  return true;
}

}  // namespace kinebus::gcode
