#include "gateway/gcode/words/parameters.hpp"

#include <algorithm>
#include <iterator>
#include <numbers>

#include "gateway/gcode/words/rotation.hpp"

namespace kinebus::gcode {
namespace {

constexpr int kG92Active = 5210, kG92First = 5211, kSystem = 5220, kSystemFirst = 5221, kSystemStep = 20;
constexpr int kTool = 5400, kToolOffsetFirst = 5401, kPointFirst = 5420, kPointLast = 5428;
constexpr int kSlots = 9;
constexpr int kTurnSlot = 9;  // of a coordinate system: its angle
// Parameters count axes as X Y Z A B C U V W; -1: an axis that the machine does not have.
constexpr std::array<int, kSlots> kSlotAxis = {kAxisX, kAxisY, kAxisZ, kAxisA, -1, kAxisC, -1, -1, -1};

/// An offset among the parameters: coordinate system (-1: G92) and axis.
struct OffsetPlace {
  int system = -1;
  std::size_t axis = 0;
};

std::optional<OffsetPlace> offset_place(int index) {
  int system = -1;
  int slot = index - kG92First;
  if (index >= kSystemFirst) {
    system = (index - kSystemFirst) / kSystemStep;
    slot = (index - kSystemFirst) % kSystemStep;
  }
  if (slot == kTurnSlot && system >= 0 && system < kCoordinateSystems)
    return OffsetPlace{system, kSystemTurn};
  if (slot < 0 || slot >= kSlots || system >= kCoordinateSystems) return std::nullopt;
  const int axis = kSlotAxis[static_cast<std::size_t>(slot)];
  if (axis < 0) return std::nullopt;
  return OffsetPlace{system, static_cast<std::size_t>(axis)};
}

double unit(std::size_t axis) {
  return axis == kAxisA || axis == kAxisC || axis == kSystemTurn ? std::numbers::pi / 180 : 1.0;
}

}  // namespace

ParameterUse parameter_use(int index) {
  if (index >= kToolOffsetFirst && index <= kPointLast) return ParameterUse::kRead;
  if (index < 1 || index >= ParameterState::kCount) return ParameterUse::kNone;
  if (index == kG92Active || index == kSystem || index == kTool) return ParameterUse::kRead;
  return ParameterUse::kReadWrite;
}

double read_parameter(const State& state, int index) {
  const ModalState& m = state.modal;
  if (index == kToolOffsetFirst + 2) return m.tool_length_mm / (m.inches ? 25.4 : 1);
  if (index == kToolOffsetFirst || index == kToolOffsetFirst + 1)
    return m.tool_xy_mm[static_cast<std::size_t>(index - kToolOffsetFirst)] / (m.inches ? 25.4 : 1);
  if (index >= kToolOffsetFirst && index < kPointFirst) return 0;
  if (index >= kPointFirst && index <= kPointLast) {
    const int axis = kSlotAxis[static_cast<std::size_t>(index - kPointFirst)];
    if (axis < 0) return 0;
    const bool turns = axis == kAxisA || axis == kAxisC;
    return m.program[static_cast<std::size_t>(axis)] / unit(static_cast<std::size_t>(axis)) /
           (m.inches && !turns ? 25.4 : 1);
  }
  if (index == kG92Active) return m.g92_active ? 1 : 0;
  if (index == kSystem) return m.coordinate_system + 1;
  if (index == kTool) return m.tool;
  if (const auto place = offset_place(index)) {
    const Pose& offsets =
        place->system < 0 ? m.g92_offset : m.coordinate_offsets[static_cast<std::size_t>(place->system)];
    return offsets[place->axis] / unit(place->axis);
  }
  return state.parameters.numbered[static_cast<std::size_t>(index)];
}

bool is_offset_parameter(int index) {
  return offset_place(index).has_value();
}

void write_parameter(State& state, int index, double value) {
  if (const auto place = offset_place(index)) {
    Pose& offsets = place->system < 0
                        ? state.modal.g92_offset
                        : state.modal.coordinate_offsets[static_cast<std::size_t>(place->system)];
    offsets[place->axis] = value * unit(place->axis);
    return;
  }
  state.parameters.numbered[static_cast<std::size_t>(index)] = value;
}

namespace {

double in_units(const ModalState& m, double value, std::size_t axis) {
  return axis == kAxisA || axis == kAxisC ? value / unit(axis) : value / (m.inches ? 25.4 : 1);
}
template <std::size_t axis>
double program_axis(const ModalState& m) {
  return in_units(m, m.program[axis], axis);
}
template <std::size_t axis>
double machine_axis(const ModalState& m) {
  return in_units(m, in_frame(m.position, m.frame, Frame::kMachine)[axis], axis);
}
double motion_mode(const ModalState& m) {
  switch (m.motion) {
    case Motion::kTraverse:
      return 0;
    case Motion::kFeed:
      return 10;
    case Motion::kArcClockwise:
      return 20;
    case Motion::kArcCounterclockwise:
      return 30;
    default:
      return m.cycle > 0 ? m.cycle : 800;
  }
}

struct Predefined {
  std::string_view name;
  double (*value)(const ModalState&);
};
// LinuxCNC's names, sorted.
constexpr std::array kPredefined = {
    Predefined{"_a", program_axis<kAxisA>},
    Predefined{"_abs_a", machine_axis<kAxisA>},
    Predefined{"_abs_c", machine_axis<kAxisC>},
    Predefined{"_abs_x", machine_axis<kAxisX>},
    Predefined{"_abs_y", machine_axis<kAxisY>},
    Predefined{"_abs_z", machine_axis<kAxisZ>},
    Predefined{"_absolute", [](const ModalState& m) { return m.incremental ? 0.0 : 1.0; }},
    Predefined{"_adaptive_feed", [](const ModalState&) { return 0.0; }},
    Predefined{"_c", program_axis<kAxisC>},
    Predefined{"_ccomp",
               [](const ModalState& m) {
                 return m.cutter == CutterSide::kLeft    ? 410.0
                        : m.cutter == CutterSide::kRight ? 420.0
                                                         : 400.0;
               }},
    Predefined{"_coord_system",
               [](const ModalState& m) {
                 return m.coordinate_system < 6 ? 540.0 + 10 * m.coordinate_system
                                                : 585.0 + m.coordinate_system;
               }},
    Predefined{"_current_tool", [](const ModalState& m) { return static_cast<double>(m.tool); }},
    Predefined{"_e", program_axis<kAxisE>},
    Predefined{"_feed", [](const ModalState& m) { return m.feed_mm_per_s * 60 / (m.inches ? 25.4 : 1); }},
    Predefined{"_feed_override", [](const ModalState&) { return 1.0; }},
    Predefined{"_flood", [](const ModalState&) { return 0.0; }},
    Predefined{"_ijk_absolute_mode", [](const ModalState& m) { return m.absolute_centre ? 1.0 : 0.0; }},
    Predefined{"_imperial", [](const ModalState& m) { return m.inches ? 1.0 : 0.0; }},
    Predefined{"_incremental", [](const ModalState& m) { return m.incremental ? 1.0 : 0.0; }},
    Predefined{"_inverse_time", [](const ModalState& m) { return m.inverse_time ? 1.0 : 0.0; }},
    Predefined{"_lathe_diameter_mode", [](const ModalState&) { return 0.0; }},
    Predefined{"_lathe_radius_mode", [](const ModalState&) { return 0.0; }},
    Predefined{"_metric", [](const ModalState& m) { return m.inches ? 0.0 : 1.0; }},
    Predefined{"_mist", [](const ModalState&) { return 0.0; }},
    Predefined{"_motion_mode", motion_mode},
    Predefined{"_plane", [](const ModalState& m) { return 170.0 + 10 * static_cast<int>(m.plane); }},
    Predefined{"_retract_old_z", [](const ModalState& m) { return m.retract_to_r ? 0.0 : 1.0; }},
    Predefined{"_retract_r_plane", [](const ModalState& m) { return m.retract_to_r ? 1.0 : 0.0; }},
    Predefined{"_rpm", [](const ModalState& m) { return m.spindle_rpm; }},
    Predefined{"_selected_tool", [](const ModalState& m) { return static_cast<double>(m.tool); }},
    Predefined{"_speed_override", [](const ModalState&) { return 1.0; }},
    Predefined{"_spindle_css_mode", [](const ModalState& m) { return m.surface_speed ? 1.0 : 0.0; }},
    Predefined{"_spindle_cw", [](const ModalState& m) { return m.spindle_turns > 0 ? 1.0 : 0.0; }},
    Predefined{"_spindle_on", [](const ModalState& m) { return m.spindle_turns != 0 ? 1.0 : 0.0; }},
    Predefined{"_spindle_rpm_mode", [](const ModalState& m) { return m.surface_speed ? 0.0 : 1.0; }},
    Predefined{"_task", [](const ModalState&) { return 1.0; }},
    Predefined{"_tool_offset",
               [](const ModalState& m) { return m.tool_length_mm != 0 || m.tool_centre_point ? 1.0 : 0.0; }},
    Predefined{"_units_per_minute", [](const ModalState& m) { return m.inverse_time ? 0.0 : 1.0; }},
    Predefined{"_units_per_rev", [](const ModalState&) { return 0.0; }},
    Predefined{"_x", program_axis<kAxisX>},
    Predefined{"_y", program_axis<kAxisY>},
    Predefined{"_z", program_axis<kAxisZ>},
};

const Predefined* find_predefined(std::string_view name) {
  const auto at =
      std::lower_bound(kPredefined.begin(), kPredefined.end(), name,
                       [](const Predefined& entry, std::string_view wanted) { return entry.name < wanted; });
  return at != kPredefined.end() && at->name == name ? &*at : nullptr;
}

/// Where `name` is, or would stand.
template <typename Values>
auto place_of(Values& values, std::string_view name) {
  return std::lower_bound(values.begin(), values.end(), name,
                          [](const auto& entry, std::string_view wanted) { return entry.first < wanted; });
}

}  // namespace

bool is_predefined(std::string_view name) {
  return find_predefined(name) != nullptr;
}

std::vector<std::string_view> predefined_names() {
  std::vector<std::string_view> names;
  names.reserve(std::size(kPredefined));
  for (const Predefined& entry : kPredefined) names.push_back(entry.name);
  return names;
}

std::optional<double> read_named(const State& state, std::string_view name) {
  const bool global = name.front() == '_';
  if (global)
    if (const Predefined* entry = find_predefined(name)) return entry->value(state.modal);
  const NamedValues& values = global ? state.parameters.named : state.parameters.locals;
  const auto at = place_of(values, name);
  if (at == values.end() || at->first != name) {
    // Before the first call.
    if (name == "_value" || name == "_value_returned") return 0;
    return std::nullopt;
  }
  return at->second;
}

bool write_named(ParameterState& parameters, std::string_view name, double value) {
  NamedValues& values = name.front() == '_' ? parameters.named : parameters.locals;
  const auto at = place_of(values, name);
  if (at != values.end() && at->first == name) {
    at->second = value;
    return true;
  }
  if (parameters.named.size() + parameters.locals.size() >= ParameterState::kMaxNamed) return false;
  values.emplace(at, name, value);
  return true;
}

}  // namespace kinebus::gcode
