#include "gateway/description/machine_file.hpp"

#include <fstream>
#include <sstream>
#include <utility>

#include "gateway/description/macro_files.hpp"

namespace kinebus {

Result<MachineDescription, MachineFileErrors> load_machine(const std::filesystem::path& path) {
  const auto unreadable = [&](Sentence found, Sentence expected) {
    return Error<MachineFileErrors>({{path.string(), 0, "", std::move(found), std::move(expected)}});
  };
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    return unreadable(say("no file there"), say("a readable TOML file"));
  constexpr std::uintmax_t kLargest = 1 << 20;
  if (std::filesystem::file_size(path, ignored) > kLargest)
    return unreadable(say("more than 1 MiB"), say("a machine file, which is a few KiB long"));
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) return unreadable(say("a file that cannot be read"), say("a readable TOML file"));
  auto machine = parse_machine(text.view(), path.string());
  if (!machine) return machine;
  MachineFileErrors errors;
  add_macro_files(path.parent_path() / "macros", machine->macros, errors);
  if (!errors.empty()) return Error<MachineFileErrors>(std::move(errors));
  return machine;
}

std::string to_string(const MachineFileError& error) {
  std::string text = error.file;
  if (error.line > 0) text += ":" + std::to_string(error.line);
  text += ": ";
  if (!error.key.empty()) text += error.key + ": ";
  return text + (error.found.empty() ? "missing" : "found " + error.found) + "; expected " + error.expected;
}

std::string to_string(const std::vector<MachineFileError>& errors) {
  std::string text;
  for (const MachineFileError& e : errors) text += to_string(e) + "\n";
  return text;
}

}  // namespace kinebus
