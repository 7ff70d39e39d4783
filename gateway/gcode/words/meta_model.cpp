// RepRapFirmware's object model, as far as a text that is read ahead of the machine can know it: what the
// text itself has set, and where it has the tool. All else would be true when it is read and false when the
// tool comes there, and is refused.

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "gateway/gcode/words/meta_expression.hpp"
#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gcode {
namespace {

constexpr std::array kModelAxes{kAxisX, kAxisY, kAxisZ, kAxisA, kAxisC};
constexpr std::array<std::string_view, 5> kModelLetters{"X", "Y", "Z", "A", "C"};

double shown_axis(const Pose& pose, std::size_t axis) {
  return pose[axis] * (axis == kAxisA || axis == kAxisC ? 180 / std::numbers::pi : 1);
}

/// "move.axes[1].homed" to "move.axes[].homed" and 1; two indices at most.
struct Path {
  std::string name;
  std::array<int, 2> index{};
};
Path split(std::string_view path) {
  Path split;
  std::size_t found = 0;
  for (std::size_t at = 0; at < path.size(); ++at) {
    split.name += path[at];
    if (path[at] != '[') continue;
    int number = 0;
    for (++at; at < path.size() && path[at] != ']'; ++at) number = number * 10 + (path[at] - '0');
    if (found < split.index.size()) split.index[found++] = number;
    split.name += ']';
  }
  return split;
}

/// Heater 0 is the bed, those behind it the hot ends.
double heater_target(const ModalState& m, int heater) {
  return heater == 0 ? m.bed_celsius : m.hotend_celsius[static_cast<std::size_t>(heater) - 1];
}

struct Entry {
  std::string_view name;
  int (*count)(const ModalState&);  ///< of the last list in its name
  MetaValue (*value)(const ModalState&, const std::array<int, 2>&);
};

int axes(const ModalState&) {
  return static_cast<int>(kModelAxes.size());
}
int one(const ModalState&) {
  return 1;
}
int heaters(const ModalState& m) {
  return 1 + std::clamp(m.hotends, 0, static_cast<int>(m.hotend_celsius.size()));
}
int tools(const ModalState& m) {
  return m.tools;
}

using Index = std::array<int, 2>;
std::size_t axis_of(const Index& at) {
  return kModelAxes[static_cast<std::size_t>(at[0])];
}

constexpr std::array kModel{
    Entry{"move.axes[].homed", axes, [](const ModalState&, const Index&) -> MetaValue { return true; }},
    Entry{"move.axes[].letter", axes,
          [](const ModalState&, const Index& at) -> MetaValue {
            return std::string(kModelLetters[static_cast<std::size_t>(at[0])]);
          }},
    Entry{"move.axes[].machinePosition", axes,
          [](const ModalState& m, const Index& at) -> MetaValue {
            return shown_axis(in_frame(m.position, m.frame, Frame::kMachine), axis_of(at));
          }},
    Entry{
        "move.axes[].userPosition", axes,
        [](const ModalState& m, const Index& at) -> MetaValue { return shown_axis(m.program, axis_of(at)); }},
    Entry{"move.extruders[].position", one,
          [](const ModalState& m, const Index&) -> MetaValue { return m.position[kAxisE]; }},
    Entry{"move.extruders[].factor", one,
          [](const ModalState& m, const Index&) -> MetaValue { return m.flow_ratio; }},
    Entry{"move.speedFactor", nullptr,
          [](const ModalState& m, const Index&) -> MetaValue { return m.feed_ratio; }},
    Entry{"move.workplaceNumber", nullptr,
          [](const ModalState& m, const Index&) -> MetaValue {
            return static_cast<double>(m.coordinate_system);
          }},
    Entry{"heat.bedHeaters[]", one, [](const ModalState&, const Index&) -> MetaValue { return 0.0; }},
    Entry{"heat.heaters[].active", heaters,
          [](const ModalState& m, const Index& at) -> MetaValue { return heater_target(m, at[0]); }},
    Entry{"heat.heaters[].state", heaters,
          [](const ModalState& m, const Index& at) -> MetaValue {
            return std::string(heater_target(m, at[0]) > 0 ? "active" : "off");
          }},
    Entry{"tools[].number", tools,
          [](const ModalState&, const Index& at) -> MetaValue { return static_cast<double>(at[0]); }},
    Entry{"tools[].state", tools,
          [](const ModalState& m, const Index& at) -> MetaValue {
            return std::string(at[0] == m.tool ? "active" : "standby");
          }},
    Entry{"tools[].heaters[]", one,
          [](const ModalState& m, const Index& at) -> MetaValue {
            return static_cast<double>(1 + std::min(at[0], m.hotends - 1));
          }},
    Entry{"tools[].active[]", one,
          [](const ModalState& m, const Index& at) -> MetaValue {
            return heater_target(m, 1 + std::min({at[0], m.hotends - 1, heaters(m) - 2}));
          }},
    Entry{"spindles[].active", one,
          [](const ModalState& m, const Index&) -> MetaValue { return m.spindle_turns * m.spindle_rpm; }},
    Entry{"state.currentTool", nullptr,
          [](const ModalState& m, const Index&) -> MetaValue { return static_cast<double>(m.tool); }},
    Entry{"state.status", nullptr,
          [](const ModalState&, const Index&) -> MetaValue { return std::string("processing"); }},
};

std::optional<Sentence> out_of(const ModalState& m, const Entry& entry, const Path& path) {
  if (entry.count == nullptr) return std::nullopt;
  const bool two = entry.name.find('[') != entry.name.rfind('[');
  const int count = entry.count(m);
  if (two && path.index[0] >= tools(m))
    return say("the index %1 is too large: there are %2", path.index[0], tools(m));
  const int index = path.index[two ? 1 : 0];
  if (index >= count) return say("the index %1 is too large: there are %2", index, count);
  return std::nullopt;
}

}  // namespace

bool read_model(const State& state, std::string_view path, MetaValue& value, Sentence& why) {
  const Path wanted = split(path);
  for (const Entry& entry : kModel) {
    if (entry.name != wanted.name) continue;
    if (auto wrong = out_of(state.modal, entry, wanted)) {
      why = std::move(*wrong);
      return false;
    }
    value = entry.value(state.modal, wanted.index);
    return true;
  }
  std::string known;
  for (const Entry& entry : kModel) known += (known.empty() ? "" : ", ") + std::string(entry.name);
  why = say("%1 cannot be known when the text is read; what can: %2", std::string(path), known);
  return false;
}

int model_count(const State& state, std::string_view path) {
  const std::string wanted = split(path).name + "[]";
  for (const Entry& entry : kModel)
    if (entry.count != nullptr && entry.name.starts_with(wanted) &&
        (entry.name.size() == wanted.size() || entry.name[wanted.size()] == '.'))
      return entry.count(state.modal);
  return wanted == "tools[]" ? tools(state.modal) : -1;
}

}  // namespace kinebus::gcode
