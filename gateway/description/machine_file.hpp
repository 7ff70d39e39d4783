#pragma once
// The machine file: TOML in, MachineDescription out, and back. All that is wrong is reported, not only the
// first.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/sentence.hpp"

namespace kinebus {

/// One thing wrong in a machine file.
struct MachineFileError {
  std::string file;
  std::uint32_t line = 0;  ///< 1-based; 0: the file as a whole (it cannot be read)
  std::string key;         ///< dotted: "joint.tower1.speed_mm_per_s"
  Sentence found;          ///< what is there; empty: nothing
  Sentence expected;       ///< type and range, or the rule
};
/// "m1.toml:12: joint.tower1.speed_mm_per_s: found -3; expected a number in 0.001 .. 100000"
std::string to_string(const MachineFileError& error);
std::string to_string(const std::vector<MachineFileError>& errors);  ///< a line each

using MachineFileErrors = std::vector<MachineFileError>;

/// With the macros of the folder `macros` beside it.
Result<MachineDescription, MachineFileErrors> load_machine(const std::filesystem::path& path);
/// `name`: what stands for the file in messages.
Result<MachineDescription, MachineFileErrors> parse_machine(std::string_view text, std::string_view name);

/// The whole effective description as TOML: parse_machine(write_machine(d)) == d for every d that
/// parse_machine gives.
std::string write_machine(const MachineDescription& description);

}  // namespace kinebus
