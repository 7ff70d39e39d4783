#pragma once
// What commands without a daemon share: reading the machine file, and writing results.

#include <nlohmann/json.hpp>
#include <string>

#include "gateway/description/machine_file.hpp"

namespace kinebus {

/// The machine of `path`, or the shipped one of this name; the default M1 for an empty path. Throws
/// std::runtime_error with all that is wrong.
MachineDescription read_machine(const std::string& path);

/// Throws std::runtime_error when the file cannot be written.
void write_text(const std::string& path, const std::string& text);

}  // namespace kinebus
