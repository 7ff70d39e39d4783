#pragma once
// What FunctionFS is told about the job link's interface, as bytes for ep0.

#include <cstdint>
#include <vector>

namespace kinebus {

/// Interface and endpoints for full, high and super speed, and the Microsoft OS descriptors that bind WinUSB.
std::vector<std::uint8_t> function_descriptors();
std::vector<std::uint8_t> function_strings();

}  // namespace kinebus
