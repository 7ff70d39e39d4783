#pragma once
// What a search for a machine says: every rule, where it binds, and the machine.

#include <string>

#include "tools/workspace/optimise.hpp"

namespace kinebus::workspace {

/// A line each: the rule's worst value, its limit, the pose and the two bodies; "binds" where less than 3 %
/// is left, "BROKEN" where nothing is.
std::string rules_text(const Judgement& judged, const bodies::CollisionModel& model);
/// What is broken, as one sentence; empty when nothing is.
std::string broken_text(const Judgement& judged, const bodies::CollisionModel& model);
std::string legs_text(const M1Geometry& geometry);

}  // namespace kinebus::workspace
