#pragma once
// One sheet of a schematic as it is drawn: places in micrometres.

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/schematic/s_expression.hpp"

namespace kinebus::schematic {

struct Place {
  std::int64_t x = 0, y = 0;
  friend bool operator==(const Place&, const Place&) = default;
  friend bool operator<(const Place& a, const Place& b) { return std::pair(a.x, a.y) < std::pair(b.x, b.y); }
};

struct DrawnPin {
  std::string number, name, type;
  Place place;
};
struct DrawnSymbol {
  std::string uuid, symbol, reference, value;
  int unit = 1;
  bool in_bill = true, power = false;
  int units = 1;  ///< that the whole part has
  std::map<std::string, std::string> properties;
  std::vector<DrawnPin> pins;
};
struct Label {
  std::string text;
  Place place;
};
struct ChildSheet {
  std::string uuid, name, file;
  std::vector<Label> pins;
};
struct Sheet {
  std::string file;
  std::vector<DrawnSymbol> symbols;
  std::vector<std::array<Place, 2>> wires;
  std::vector<Place> junctions, unconnected;
  std::vector<Label> labels, global_labels, hierarchical_labels;
  std::vector<ChildSheet> children;
  /// Root only: path of a symbol through the sheets' ids, and its reference there.
  std::map<std::string, std::string> references;
};

Result<Sheet, FileError> read_sheet(const std::filesystem::path& file);

}  // namespace kinebus::schematic
