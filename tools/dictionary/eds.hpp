#pragma once
// The node's object table as an electronic data sheet (CiA 306).

#include <string>

namespace kinebus {

/// The whole file; the same text for the same table (dates are fixed). Line ends are CR LF, as CiA 306 wants.
std::string eds_text();

}  // namespace kinebus
