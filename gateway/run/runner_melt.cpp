// Whether what is fed is molten: looked at while path time runs, as far ahead as a stop on the path takes.

#include <algorithm>
#include <chrono>
#include <optional>

#include "gateway/run/runner.hpp"

namespace kinebus {
namespace {

/// From the decision to the ramp's begin on all nodes, and between two looks.
constexpr std::chrono::milliseconds kReaction{100};
constexpr int kLooks = 8;
/// Corners are rounded in filament too: the last move that was hot may end this much before its E.
constexpr double kFedBack_mm = 0.1;

}  // namespace

bool Runner::feeds_cold(BusTime now) {
  if (!active_ || suspended_ || !feed_.streaming()) return false;
  const PathTime tau = std::max(rate_.tau(now), feed_.run_start());
  const auto fed_mm = [this](PathTime at) -> std::optional<double> {
    const auto planned = planned_pose(at);
    return planned ? std::optional(planned->pose[kE] - feed_.extruder_shift_mm()) : std::nullopt;
  };
  const auto here_mm = fed_mm(tau);
  if (!here_mm) return false;
  bool& has_melted = has_melted_[heat_.tool().index];
  if (heat_.melts()) {
    has_melted = true;
    molten_mm_ = std::max(molten_mm_, *here_mm);
    return false;
  }
  if (!has_melted && !heat_.melts_by_node()) return false;
  const std::chrono::duration<double> look = machine_.stop.hold_ramp + kReaction;
  for (int i = 0; i <= kLooks; ++i) {
    const auto ahead = fed_mm(tau + std::chrono::duration_cast<PathTime>(look * i / kLooks));
    if (!ahead) return false;
    if (*ahead > molten_mm_ + kFedBack_mm) return true;
  }
  return false;
}

/// At rest. What the one before was fed is nothing that may return into this one.
void Runner::change_tool(int hotend) {
  heat_.select(hotend);
  molten_mm_ = rest_pose().pose[kE] - feed_.extruder_shift_mm();
}

}  // namespace kinebus
