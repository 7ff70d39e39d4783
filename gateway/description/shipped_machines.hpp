#pragma once
// The machine files that come with the program, by name: "m4" is gateway/description/machines/m4.toml.

#include <span>
#include <string>
#include <string_view>

#include "gateway/description/machine_file.hpp"

namespace kinebus {

struct ShippedMachine {
  std::string_view name, text;
};
/// In the order of their names.
std::span<const ShippedMachine> shipped_machines();
/// Comments for keys that none of them says anything of, as with_comments() takes them.
std::string_view key_remarks();

/// A machine file, or the name of a shipped machine in either case. The error: words with the file's place
/// and rule, or the names there are.
Result<MachineDescription, std::string> machine_of(const std::string& file_or_name);

}  // namespace kinebus
