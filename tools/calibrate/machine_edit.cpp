#include "tools/calibrate/machine_edit.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "gateway/description/machine_file.hpp"

namespace kinebus {
namespace {

/// The table that a line opens: "joint.C.calibration"; empty: none.
std::string opened_table(const std::string& line) {
  const std::size_t from = line.find_first_not_of(" \t");
  if (from == std::string::npos || line[from] != '[' || line.compare(from, 2, "[[") == 0) return "";
  const std::size_t to = line.find(']', from);
  if (to == std::string::npos) return "";
  std::string name;
  for (const char c : line.substr(from + 1, to - from - 1))
    if (c != ' ' && c != '\t' && c != '"') name += c;
  return name;
}

bool of_calibration(std::string_view table) {
  return table == "calibration" || table.starts_with("calibration.") ||
         (table.starts_with("joint.") && table.ends_with(".calibration"));
}

/// Calls `take` with each line and whether it stands in a table that belongs.
void each_line(const std::string& text, const std::function<bool(std::string_view)>& belongs, auto&& take) {
  std::istringstream in(text);
  std::string line;
  bool inside = false;
  while (std::getline(in, line)) {
    if (const std::string table = opened_table(line); !table.empty()) inside = belongs(table);
    take(line, inside);
  }
}

}  // namespace

Result<std::string, std::string> with_tables(const std::string& text, const MachineDescription& machine,
                                             const std::function<bool(std::string_view table)>& belongs,
                                             std::string_view note) {
  const std::string comment = "# " + std::string(note) + "\n";
  std::string kept, added;
  each_line(text, belongs, [&](const std::string& line, bool inside) {
    if (!inside) kept += line + "\n";
  });
  // The note of what stood there before.
  if (const std::size_t old = kept.rfind(comment); old != std::string::npos) kept.erase(old, comment.size());
  while (kept.ends_with("\n\n")) kept.pop_back();
  each_line(write_machine(machine), belongs, [&](const std::string& line, bool inside) {
    if (inside) added += line + "\n";
  });
  std::string out = kept + "\n" + comment + added;
  const auto read = parse_machine(out, "new machine file");
  if (!read) return Error<std::string>(to_string(read.error()));
  if (write_machine(*read) != write_machine(machine))
    return Error<std::string>("the file has tables in a form that cannot be replaced line by line");
  return out;
}

Result<std::string, std::string> with_calibration(const std::string& text,
                                                  const MachineDescription& machine) {
  return with_tables(text, machine, of_calibration, "Calibration, found by measurement (kinebus-calibrate).");
}

std::filesystem::path replace_machine_file(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::path kept;
  for (int n = 1; kept.empty() || std::filesystem::exists(kept); ++n)
    kept = file.string() + ".before-" + std::to_string(n);
  std::filesystem::copy_file(file, kept);
  const std::filesystem::path fresh = file.string() + ".new";
  {
    std::ofstream out(fresh, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + fresh.string());
  }
  std::filesystem::rename(fresh, file);
  return kept;
}

}  // namespace kinebus
