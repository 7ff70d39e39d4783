#include "gateway/gcode/words/codes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gateway/gcode/dialects.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

// What Klipper and slicers write as words: it tells or tunes what other machines have, and leaves the job's
// meaning as it is. In lower case, sorted.
constexpr std::array<std::string_view, 25> kHarmlessCommands = {"bed_screws_adjust",
                                                                "bed_tilt_calibrate",
                                                                "bltouch_debug",
                                                                "delta_calibrate",
                                                                "probe",
                                                                "probe_calibrate",
                                                                "quad_gantry_level",
                                                                "query_probe",
                                                                "resume",
                                                                "save_config",
                                                                "screws_tilt_calculate",
                                                                "set_display_group",
                                                                "set_display_text",
                                                                "set_fan_speed",
                                                                "set_filament_sensor",
                                                                "set_idle_timeout",
                                                                "set_led",
                                                                "set_pin",
                                                                "set_print_stats_info",
                                                                "set_retraction",
                                                                "set_stepper_enable",
                                                                "set_tmc_current",
                                                                "skew_profile",
                                                                "timelapse_take_frame",
                                                                "z_tilt_adjust"};
static_assert(std::is_sorted(kHarmlessCommands.begin(), kHarmlessCommands.end()));

struct Command {
  std::string_view name, words, meaning;
};
constexpr std::array<Command, 21> kCommands = {{
    {"bed_mesh_calibrate", "PROFILE= MESH_MIN= MESH_MAX= PROBE_COUNT= ADAPTIVE= ADAPTIVE_MARGIN=",
     "probes the grid of [mesh] of the machine file, or the area given; ADAPTIVE=1: of the objects defined"},
    {"bed_mesh_clear", "", "no bed mesh is in force"},
    {"bed_mesh_map", "", "tells which mesh is in force"},
    {"bed_mesh_output", "", "tells which mesh is in force"},
    {"bed_mesh_profile", "LOAD= | SAVE= | REMOVE=", "a mesh that was kept: in force, kept, forgotten"},
    {"cancel_print", "", "end of the program"},
    {"exclude_object", "NAME= | CURRENT=1 | RESET=1", "the moves of this object are left out from here on"},
    {"exclude_object_define", "NAME= RESET=", "names an object; the rest is passed over"},
    {"exclude_object_end", "NAME=", "the object's moves end"},
    {"exclude_object_start", "NAME=", "the object's moves begin"},
    {"pause", "", "pause"},
    {"respond", "MSG=", "message"},
    {"set_gcode_offset", "X= Y= Z=", "of 0: without effect; others are refused"},
    {"set_heater_temperature", "HEATER= TARGET=", "temperature of extruder, extruder1, heater_bed"},
    {"set_input_shaper", "SHAPER_TYPE= SHAPER_FREQ_X= DAMPING_RATIO_X=",
     "input shaping, also with _X, _Y, _Z; a frequency of 0 turns it off; for the moves that follow"},
    {"set_pressure_advance", "ADVANCE= SMOOTH_TIME=",
     "pressure advance in s, and the path time that it is averaged over; for the moves that follow"},
    {"set_velocity_limit", "ACCEL= VELOCITY=", "acceleration of printing and travel; the rest is noted"},
    {"t?", "", "asks for the filament and pauses"},
    {"tc", "", "without effect on this machine: filament unit"},
    {"turn_off_heaters", "", "all heaters off"},
    {"tx", "", "without effect on this machine: filament unit"},
}};

struct Reason {
  int code;
  const char* text;
};
constexpr std::array<Reason, 7> kGReasons = {{
    {330, phrase("%1 turns with the spindle, which needs an encoder on it")},
    {331, phrase("%1 turns back in the hole with the spindle, which needs an encoder on it and "
                 "spindle.tap_rpm_per_s in the machine file; G84 and G74 are for a floating holder")},
    {380, phrase("%1 needs a decimal: G38.2 to G38.5")},
    {683, phrase("G68.3 is not supported: use G68.2 with I J K")},
    {760, phrase("G76 means threading to some and fine boring to others; both need a spindle that follows an "
                 "angle, which this machine does not have")},
    {870, phrase("G87 needs a spindle that stops at an angle, which this machine does not have")},
    {880, phrase("G88 needs an operator who moves the axes by hand: use G82 or G86")},
}};
constexpr std::array<Reason, 2> kMReasons = {{
    {3, phrase("M3 turns a spindle, which this machine does not have")},
    {4, phrase("M4 turns a spindle, which this machine does not have")},
}};

const CodeEntry* find(std::span<const CodeEntry> entries, int number) {
  const auto at = std::lower_bound(entries.begin(), entries.end(), number,
                                   [](const CodeEntry& entry, int wanted) { return entry.number < wanted; });
  return at != entries.end() && at->number == number ? &*at : nullptr;
}

std::string entry_text(const std::string& name, std::string_view words, std::string_view meaning, bool none) {
  std::string text = name;
  if (!words.empty()) (text += ' ') += words;
  text += ": ";
  if (none) text += "accepted with a note, without effect on this machine: ";
  return text += meaning;
}
std::string text_of_g(const CodeEntry& entry) {
  return entry_text(g_name(entry.number), entry.words, entry.meaning,
                    entry.group == static_cast<std::uint8_t>(GGroup::kHarmless));
}
std::string text_of_m(const CodeEntry& entry) {
  return entry_text(m_name(entry.number), entry.words, entry.meaning,
                    entry.group == static_cast<std::uint8_t>(MGroup::kHarmless));
}

struct Word {
  std::string_view name, text;
};
constexpr std::array<Word, 9> kOWords = {{
    {"sub",
     "oN sub ... oN endsub: a subroutine; #1 to #30 and #<name> are its own, the arguments are #1 ..."},
    {"call", "oN call [1] [2] ...: carries out a subroutine, o<name> call also a macro"},
    {"return", "oN return [value], oN endsub [value]: back to the call; the value is #<_value>"},
    {"if", "oN if [..] ... oN elseif [..] ... oN else ... oN endif"},
    {"while", "oN while [..] ... oN endwhile"},
    {"do", "oN do ... oN while [..]"},
    {"repeat", "oN repeat [times] ... oN endrepeat"},
    {"break", "oN break: leaves the loop oN"},
    {"continue", "oN continue: the next turn of the loop oN"},
}};

}  // namespace

bool takes_text(int m_number) {
  const CodeEntry* const entry = find(m_codes(), m_number);
  return entry != nullptr && entry->text;
}

bool harmless_command(std::string_view name) {
  return std::binary_search(kHarmlessCommands.begin(), kHarmlessCommands.end(), name) || name == "tx" ||
         name == "tc";
}

std::string g_name(int tenths) {
  std::string name("G");
  name += std::to_string(tenths / 10);
  if (tenths % 10 != 0) (name += '.') += std::to_string(tenths % 10);
  return name;
}

std::string m_name(int number) {
  std::string name("M");
  name += std::to_string(number);
  return name;
}

Sentence unknown_g(int tenths) {
  for (const Reason& reason : kGReasons)
    if (reason.code == tenths) return say(reason.text, g_name(tenths));
  return say("%1 is unknown", g_name(tenths));
}

Sentence unknown_m(int number) {
  for (const Reason& reason : kMReasons)
    if (reason.code == number) return say(reason.text);
  return say("%1 is unknown", m_name(number));
}

namespace {

std::string entry_of(std::string_view code) {
  const std::string name = in_lower_case(code);
  if (name.size() > 1 && (name[0] == 'g' || name[0] == 'm') && name[1] >= '0' && name[1] <= '9') {
    const double number = std::strtod(name.c_str() + 1, nullptr);
    const auto tenths = static_cast<int>(std::lround(std::min(number, 1e6) * 10));
    if (name[0] == 'g') {
      if (const CodeEntry* entry = find(g_codes(), tenths)) return text_of_g(*entry);
      for (const Reason& reason : kGReasons)
        if (reason.code == tenths) return unknown_g(tenths).english();
      return {};
    }
    const int m_number = tenths / 10;
    if (const CodeEntry* entry = find(m_codes(), m_number)) return text_of_m(*entry);
    for (const Reason& reason : kMReasons)
      if (reason.code == m_number) return unknown_m(m_number).english();
    return {};
  }
  for (const Command& command : kCommands)
    if (command.name == name) return entry_text(std::string(code), command.words, command.meaning, false);
  if (harmless_command(name)) return entry_text(std::string(code), "", "Klipper's", true);
  for (const Word& word : kOWords)
    if (word.name == name) return std::string(word.text);
  for (const std::string_view predefined : predefined_names())
    if (name == predefined || name == "#<" + std::string(predefined) + ">")
      return "#<" + std::string(predefined) + ">: can only be read; LinuxCNC's";
  return {};
}

}  // namespace

std::string reference_entry(std::string_view code) {
  std::string name = in_lower_case(code);
  // G04 is G4.
  while (name.size() > 2 && name[1] == '0' && name[2] >= '0' && name[2] <= '9') name.erase(1, 1);
  std::string entry = entry_of(name == in_lower_case(code) ? code : std::string_view(name));
  std::string differences = entry.empty() && name != "a" ? dialect_entry(name) : dialect_differences(name);
  if (differences.empty()) return entry;
  differences.pop_back();
  if (name == "a") entry = "A: axis in degrees";
  if (!entry.empty()) entry += '\n';
  return entry + differences;
}

std::string reference() {
  std::string all;
  for (const CodeEntry& entry : g_codes()) all += text_of_g(entry) + "\n";
  for (const CodeEntry& entry : m_codes()) all += text_of_m(entry) + "\n";
  for (const DialectRules& rules : dialects())
    all.append(rules.key).append(": a dialect, [gcode] dialect of the machine file\n");
  for (const Command& command : kCommands)
    all += entry_text(std::string(command.name), command.words, command.meaning, false) + "\n";
  for (const std::string_view name : kHarmlessCommands)
    all += entry_text(std::string(name), "", "Klipper's", true) + "\n";
  for (const Word& word : kOWords) all.append(word.text).append("\n");
  for (const std::string_view name : predefined_names()) all.append("#<").append(name).append(">\n");
  return all;
}

}  // namespace kinebus::gcode
