// Length and offsets of tools: G43 to G49, and the table that G10 L1, L10 and L11 change.

#include <algorithm>
#include <array>

#include "gateway/gcode/core/core.hpp"

namespace kinebus::gcode {

bool Core::set_tool_length(Code code) {
  ModalState& m = state_.modal;
  int tools = static_cast<int>(options_.tool_length_mm.size());
  for (const ToolEntry& entry : state_.tools) tools = std::max(tools, entry.tool);
  int h = m.tool <= tools ? m.tool : 0;
  if (code.number != 490 && code.number != 431) {
    if (block_.has('H') && !block_.is_bare('H') && block_['H'] > tools)
      return fail(block_.column_of('H'),
                  say("tool H%1 has no length here: gcode.tool_length_mm of the machine "
                      "file gives it one, or G10 L1 P%1 Z in the job",
                      printed("%.6g", block_['H'])));
    if (!take_integer('H', 0, tools, h)) return false;
  }
  const ToolEntry tool = code.number == 490 || code.number == 431 ? ToolEntry{} : tool_entry(h);
  double tool_length = tool.offset_mm[2];
  if (code.number == 431) {
    if (block_.has(GGroup::kMotion) || !has('Z'))
      return fail(code.column, say("G43.1 needs the tool's length Z, and a line without motion"));
    if (!take('Z', tool_length)) return false;
    tool_length = length(tool_length);
  }
  if (tool_length != 0 && (code.number == 434 || (m.tilted && !m.plane_rotation)))
    return fail(
        code.column,
        say("G43.4 and G68.2 need a tool of length 0: the machine file says where the tool's tip is"));
  m.tool_length_mm = tool_length;
  m.tool_xy_mm = {tool.offset_mm[0], tool.offset_mm[1]};
  m.tool_centre_point = code.number == 434;
  change_frame();
  return true;
}

ToolEntry Core::tool_entry(int tool) const {
  for (const ToolEntry& entry : state_.tools)
    if (entry.tool == tool) return entry;
  ToolEntry entry{tool, {}, 0};
  const auto at = static_cast<std::size_t>(tool - 1);
  if (tool >= 1 && at < options_.tool_length_mm.size()) entry.offset_mm[2] = options_.tool_length_mm[at];
  if (tool >= 1 && at < options_.tool_diameter_mm.size()) entry.diameter_mm = options_.tool_diameter_mm[at];
  if (tool >= 1 && at < options_.tool_orientation.size())
    entry.orientation = static_cast<int>(options_.tool_orientation[at]);
  return entry;
}

/// G10 L1: the tool's offsets; L10: those by which the current point gets these coordinates; L11: the same in
/// G59.3, without G92. In force with the next G43.
bool Core::set_tool_table(Code code, int l) {
  const ModalState& m = state_.modal;
  int tool = 0;
  if (!has('P')) return fail(code.column, say("G10 L%1 needs the tool P", l));
  if (!take_integer('P', 1, 99'999, tool)) return false;
  ToolEntry entry = tool_entry(tool);
  const auto system = static_cast<std::size_t>(l == 11 ? kCoordinateSystems - 1 : m.coordinate_system);
  const Vector3 zero = xyz(m.coordinate_offsets[system]);
  const Vector3 g92 = l == 10 && m.g92_active ? xyz(m.g92_offset) : Vector3{};
  const Matrix3 turn = turn_of(system);
  // Not turned, an axis that is not given stays as it is to the last bit.
  const bool turned = m.coordinate_offsets[system][kSystemTurn] != 0;
  Vector3 point = transposed(turn) * (xyz(m.position) - zero - entry.offset_mm);
  std::array<bool, 3> given{};
  for (std::size_t axis = kAxisX; axis <= kAxisZ; ++axis) {
    double value = 0;
    given[axis] = has(kAxisLetters[axis]);
    if (!given[axis]) continue;
    if (!take(kAxisLetters[axis], value)) return false;
    if (l == 1) entry.offset_mm[axis] = length(value);
    point[axis] = length(value) + g92[axis];
  }
  const Vector3 found = xyz(m.position) - zero - turn * point;
  for (std::size_t axis = kAxisX; l != 1 && axis <= kAxisZ; ++axis)
    if (given[axis] || (turned && axis != kAxisZ)) entry.offset_mm[axis] = found[axis];
  double radius = entry.diameter_mm / 2;
  const bool has_radius = has('R');
  if (!take_if_given('R', radius)) return false;
  if (has_radius) entry.diameter_mm = 2 * length(radius);
  if (has('Q') && !take_integer('Q', 0, 9, entry.orientation)) return false;
  for (const char letter : {'I', 'J'}) pass_over(letter);  // angles of lathe tools
  for (ToolEntry& known : state_.tools) {
    if (known.tool != tool) continue;
    known = entry;
    return true;
  }
  if (state_.tools.size() >= ToolEntry::kMost)
    return fail(code.column, say("too many tools are changed by G10 (1000 at most)"));
  state_.tools.push_back(entry);
  return true;
}

}  // namespace kinebus::gcode
