#pragma once
// A scale of colours that grows lighter all the way: readable in grey, and for eyes that do not tell red from
// green.

#include <array>
#include <string>

#include "tools/drawing/document.hpp"

namespace kinebus::drawing {

/// Red, green, blue, 0..255, of 0 (dark violet) to 1 (yellow); what is beyond is cut off.
std::array<int, 3> scale_colour(double fraction);

std::string scale_rgb(double fraction);

/// The scale as a bar: standing (dark below) if it is higher than wide, else lying (dark at the left).
void colour_bar(Document& document, const Box& box);

}  // namespace kinebus::drawing
