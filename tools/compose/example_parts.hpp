#pragma once
// Parts with overhangs to try the composer on, drawn here: no file needed.

#include <string>
#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

/// "t", "y", "hook", "table" (a table with one angled leg more) and "two-piece" (a column that bends).
std::vector<std::string> example_names();
/// Throws std::runtime_error for a name that is not in the list.
TriangleMesh example_part(const std::string& name);

}  // namespace kinebus::compose
