#pragma once
// Canonical commands as text, one line each: what golden tests compare and what people read.

#include <string>

#include "gateway/gcode/canonical.hpp"

namespace kinebus::canonical {

/// "12 feed part x1.5 y0 z0.2 a0 c0 e0.033 f20": lengths mm, angles degrees, speeds mm/s (deg/s for turns
/// alone are given in rad/s as in the command), 9 significant digits, no line end.
std::string to_text(const Line& line);

}  // namespace kinebus::canonical
