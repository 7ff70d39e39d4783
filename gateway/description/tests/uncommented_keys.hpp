#pragma once
// Keys of a machine file that nothing is said of, wherever they stand.

#include <set>
#include <sstream>
#include <string>

namespace kinebus {

/// "joint homing fast_mm_per_s\n" for each: tables that differ by name or number alone are one.
inline std::string uncommented_keys(const std::string& text) {
  std::set<std::string> said, all;
  std::istringstream in(text);
  std::string table, line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '[') {
      std::istringstream parts(line.substr(1, line.find(']') - 1));
      std::string part;
      table.clear();
      for (int depth = 0; std::getline(parts, part, '.'); ++depth) {
        while (!part.empty() && part.back() >= '0' && part.back() <= '9') part.pop_back();
        const bool name =
            table == "bodies fixed " || (depth == 1 && table != "kinematics " && table != "bodies ");
        if (!name) table += part + " ";
      }
      continue;
    }
    const std::string key = table + line.substr(0, line.find(" = "));
    all.insert(key);
    // No value of a written file has this in it.
    if (const std::size_t at = line.find(" # "); at != std::string::npos && line.size() > at + 5)
      said.insert(key);
  }
  std::string left;
  for (const std::string& key : all)
    if (!said.contains(key)) left += key + "\n";
  return left;
}

}  // namespace kinebus
