#pragma once
// The machine that golden files run on.

#include <string_view>

#include "gateway/gcode/interpreter.hpp"

namespace kinebus::gcode {

/// Home 200 mm above the table, one spare tool of 12.5 mm, 6 mm wide. A file changes it with "options: word
/// word" anywhere in its text: block_delete, dwell_seconds, traverse_uses_feed, default_feed, two_tools,
/// five_tools, spindle, encoder (on the spindle), taps (it turns
/// back in them), probe, dialect=NAME, macros (prime LENGTH=, square with an
/// argument by number, wipe, wrong), linuxcnc, printer (macros that profiles of printers call).
inline Options golden_options(std::string_view text) {
  Options options;
  options.home = {0, 0, 200, 0, 0, 0};
  options.tool_length_mm = {12.5};
  options.tool_diameter_mm = {6};
  options.most_recorded_steps = 10'000;
  options.dwell_p_unit = DwellUnit::kMilliseconds;
  const std::size_t at = text.find("options:");
  if (at == std::string_view::npos) return options;
  const std::string_view line = text.substr(at, text.find('\n', at) - at);
  const auto says = [line](std::string_view word) { return line.find(word) != std::string_view::npos; };
  options.block_delete = says("block_delete");
  options.traverse_uses_feed = says("traverse_uses_feed");
  for (const DialectRules& rules : dialects()) {
    if (!says("dialect=" + std::string(rules.key))) continue;
    options.dialect = rules.dialect;
    options.dwell_p_unit = DwellUnit::kByDialect;
  }
  if (says("dwell_seconds")) options.dwell_p_unit = DwellUnit::kSeconds;
  if (says("default_feed")) options.default_feed_mm_per_s = 25;
  if (says("probe")) options.probe = ProbeFitted::kFitted;
  options.probe_pin = says("probe_pin");
  options.spindle = says("spindle");
  options.spindle_encoder = says("encoder");
  if (says("taps")) options.tap_rpm_per_s = 3000;
  if (options.spindle) options.tools = 100'000;
  if (says("macros"))
    options.macros = {{"prime",
                       "; as a machine file has it\n"
                       "o1 if [exists[#<length>]]\n"
                       "  G1 E[#<length>] F300\n"
                       "o1 else\n"
                       "  (MSG, no length)\n"
                       "o1 endif\n"},
                      {"square", "G1 X#1 F600\nY#1\nX0\nY0\n"},
                      {"g1009", "G1 E#<p> F300\n"},
                      {"m701", "G1 E[#<z> * 10] F300\n"},
                      {"wipe",
                       "; as RepRapFirmware has it\n"
                       "var times = exists(param.S) ? param.S : 1\n"
                       "while iterations < var.times\n"
                       "  G1 X{10 + iterations} F600\n"
                       "  if iterations == 3\n"
                       "    M99\n"
                       "G1 X0\n"},
                      {"wrong", "if true\n  G1 X{var.none}\n"}};
  if (says("linuxcnc")) {  // as tests/linuxcnc_corpus has its peer: T7 is 0.7 mm long and 0.35 mm wide
    options.dialect = Dialect::kLinuxCnc;
    options.spindle = options.spindle_encoder = true;
    options.tap_rpm_per_s = 3000;
    options.tools = 100'000;
    options.probe = ProbeFitted::kFitted;
    options.probe_mm_per_s = 1e6;
    options.home = {};
    options.dwell_p_unit = DwellUnit::kByDialect;
    options.most_recorded_steps = 1'000'000;
    options.tool_length_mm.clear();
    options.tool_diameter_mm.clear();
    for (int tool = 1; tool < 100; ++tool) {
      options.tool_length_mm.push_back(tool / 10.0);
      options.tool_diameter_mm.push_back(tool / 20.0);
    }
  }
  if (says("printer")) {  // what printers' own firmware has under these names
    options.macros = {{"start_print",
                       "M140 S#<bed_temp>\nM104 S#<extruder_temp>\nG28\nM190 S#<bed_temp>\n"
                       "M109 S#<extruder_temp>\n"},
                      {"end_print", "M104 S0\nM140 S0\nM107\n"},
                      {"g1009", "G1 E10 F300\n"}};
  }
  if (says("two_tools")) options.tools = options.hotends = 2;
  if (says("five_tools")) options.tools = options.hotends = 5;
  return options;
}

}  // namespace kinebus::gcode
