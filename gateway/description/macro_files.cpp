#include "gateway/description/macro_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <utility>

#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/programs/recording.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kMostFiles = 256, kLongestName = 32;
constexpr std::uintmax_t kMostBytes = 1 << 20;
constexpr std::array<std::string_view, 4> kEndings = {".g", ".gcode", ".nc", ".ngc"};

bool is_name(std::string_view text) {
  return !text.empty() && text.size() <= kLongestName && std::all_of(text.begin(), text.end(), [](char c) {
    const char small = gcode::in_lower_case(c);
    return (small >= 'a' && small <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  });
}

}  // namespace

void add_macro_files(const std::filesystem::path& folder, std::vector<MacroDescription>& macros,
                     MachineFileErrors& errors) {
  namespace fs = std::filesystem;
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) return;
  const auto wrong = [&](const fs::path& file, std::uint32_t line, Sentence found, Sentence expected) {
    errors.push_back({file.string(), line, "", std::move(found), std::move(expected)});
  };
  std::vector<fs::path> files;
  for (auto at = fs::directory_iterator(folder, failed); !failed && at != fs::directory_iterator();
       at.increment(failed)) {
    const std::string ending = gcode::in_lower_case(at->path().extension().string());
    const bool macro = std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
    std::error_code ignored;
    if (!macro || !at->is_regular_file(ignored)) continue;
    if (files.size() == kMostFiles)
      return wrong(folder, 0, say("more than %1 files", static_cast<int>(kMostFiles)),
                   say("macros, a file each"));
    files.push_back(at->path());
  }
  if (failed) return wrong(folder, 0, say("a folder that cannot be read"), say("macros, a file each"));
  std::sort(files.begin(), files.end());
  std::uintmax_t bytes = 0;
  for (const fs::path& file : files) {
    MacroDescription macro;
    macro.name = file.stem().string();
    if (!is_name(macro.name)) {
      wrong(file, 0, Sentence::verbatim(macro.name),
            say("a name of 1 .. %1 letters, digits, -, . and _", static_cast<int>(kLongestName)));
      continue;
    }
    const auto same = std::find_if(macros.begin(), macros.end(), [&](const MacroDescription& other) {
      return gcode::in_lower_case(other.name) == gcode::in_lower_case(macro.name);
    });
    if (same != macros.end()) {
      wrong(file, 0, Sentence::verbatim(macro.name),
            say("another name than %1: upper and lower case are the same", same->name));
      continue;
    }
    const std::uintmax_t size = fs::file_size(file, failed);
    if (failed || bytes + size > kMostBytes)
      return wrong(file, 0, failed ? say("a file that cannot be read") : say("more than 1 MiB of macros"),
                   say("macros, a file each"));
    bytes += size;
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) return wrong(file, 0, say("a file that cannot be read"), say("macros, a file each"));
    macro.gcode = text.str();
    gcode::Recording recording;
    if (const auto lines = recording.add_macro(macro.gcode); !lines)
      wrong(file, lines.error().line, lines.error().message, say("G-code, a line each"));
    else
      macros.push_back(std::move(macro));
  }
}

}  // namespace kinebus
