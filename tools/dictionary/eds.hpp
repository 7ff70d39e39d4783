#pragma once
// A board's object table as an electronic data sheet (CiA 306).

#include <string>

#include "protocol/canopen/boards/all.hpp"

namespace kinebus {

/// The whole file; the same text for the same table (dates are fixed). Line ends are CR LF, as CiA 306 wants.
std::string eds_text(const BoardDescription& board);

}  // namespace kinebus
