#pragma once

#include <array>
#include <string>

#include "tools/heat_study/flow_step.hpp"

namespace kinebus::heat_study {

inline constexpr std::array kControls{Control::kPid, Control::kModel, Control::kModelAhead};

/// Block and power over time, as SVG: a curve each of kControls.
std::string draw_flow_step(const Scene& scene, const std::array<Run, kControls.size()>& runs);

}  // namespace kinebus::heat_study
