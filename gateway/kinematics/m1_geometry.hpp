#pragma once
// What is asked of M1's numbers before a machine is made of them.

#include <optional>
#include <string>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/kinematics/kinematics.hpp"

namespace kinebus::m1_geometry {

/// Rules that do not need a pose; the reason when one is broken.
std::optional<Sentence> wrong_numbers(const M1Geometry& geometry);

/// Looks over the workspace for one pose that can be controlled; the reason when there is none.
std::optional<Sentence> wrong_everywhere(const Kinematics& m1, const M1Geometry& geometry);

}  // namespace kinebus::m1_geometry
