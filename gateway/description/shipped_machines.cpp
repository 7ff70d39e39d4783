#include "gateway/description/shipped_machines.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {

Result<MachineDescription, std::string> machine_of(const std::string& file_or_name) {
  std::error_code code;
  if (std::filesystem::exists(file_or_name, code)) {
    auto machine = load_machine(file_or_name);
    if (!machine) return Error<std::string>(to_string(machine.error()));
    return std::move(*machine);
  }
  std::string wanted = file_or_name, names;
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const ShippedMachine& shipped : shipped_machines()) {
    names += (names.empty() ? "" : ", ") + std::string(shipped.name);
    if (wanted != shipped.name) continue;
    auto machine = parse_machine(shipped.text, std::string(shipped.name) + ".toml");
    if (!machine) return Error<std::string>(to_string(machine.error()));
    return std::move(*machine);
  }
  return Error<std::string>("unknown machine \"" + std::string(cut_text(file_or_name, 200)) +
                            "\"; expected a machine file, or one of " + names);
}

}  // namespace kinebus
