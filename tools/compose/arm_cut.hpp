#pragma once
// Arms that hang are taken off across themselves.

#include <vector>

#include "tools/compose/decompose.hpp"

namespace kinebus::compose {

/// Takes the stretches of one arm that hangs off the solid, the tip's first. Empty: there is none that comes
/// off.
std::vector<Solid> take_arm_off(Solid& solid, const DecomposeOptions& options);

}  // namespace kinebus::compose
