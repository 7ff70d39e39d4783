#include "gateway/gcode/parameters.hpp"

#include <algorithm>
#include <numbers>

namespace kinebus::gcode {
namespace {

constexpr int kG92Active = 5210, kG92First = 5211, kSystem = 5220, kSystemFirst = 5221, kSystemStep = 20;
constexpr int kTool = 5400, kPointFirst = 5420, kPointLast = 5425;
constexpr int kSlots = 9;
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
  if (slot < 0 || slot >= kSlots || system >= kCoordinateSystems) return std::nullopt;
  const int axis = kSlotAxis[static_cast<std::size_t>(slot)];
  if (axis < 0) return std::nullopt;
  return OffsetPlace{system, static_cast<std::size_t>(axis)};
}

double unit(std::size_t axis) {
  return axis == kAxisA || axis == kAxisC ? std::numbers::pi / 180 : 1.0;
}

}  // namespace

ParameterUse parameter_use(int index) {
  if (index >= kPointFirst && index <= kPointLast) return ParameterUse::kRead;
  if (index < 1 || index >= ParameterState::kCount) return ParameterUse::kNone;
  if (index == kG92Active || index == kSystem || index == kTool) return ParameterUse::kRead;
  return ParameterUse::kReadWrite;
}

double read_parameter(const State& state, int index) {
  const ModalState& m = state.modal;
  if (index >= kPointFirst) {
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

std::optional<double> read_named(const ParameterState& parameters, std::string_view name) {
  const auto at =
      std::lower_bound(parameters.named.begin(), parameters.named.end(), name,
                       [](const auto& entry, std::string_view wanted) { return entry.first < wanted; });
  if (at == parameters.named.end() || at->first != name) return std::nullopt;
  return at->second;
}

bool write_named(ParameterState& parameters, std::string_view name, double value) {
  const auto at =
      std::lower_bound(parameters.named.begin(), parameters.named.end(), name,
                       [](const auto& entry, std::string_view wanted) { return entry.first < wanted; });
  if (at != parameters.named.end() && at->first == name) {
    at->second = value;
    return true;
  }
  if (parameters.named.size() >= ParameterState::kMaxNamed) return false;
  parameters.named.emplace(at, name, value);
  return true;
}

}  // namespace kinebus::gcode
