#pragma once
// What a schematic of KiCad 6 says is connected with what: all sheets below a root, each as often as it is
// used.

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/schematic/s_expression.hpp"

namespace kinebus::schematic {

struct PartPin {
  std::string number, name;
  std::string type;  ///< KiCad's: input, output, passive, power_in, ...
  std::size_t net = 0;
  bool marked_unconnected = false;
};

struct Part {
  std::string reference, value, symbol;
  std::string sheet;  ///< names of the sheets down to it: "/Motor A/Phase A/"
  bool in_bill = true;
  bool power = false;  ///< a power symbol or flag: no part
  std::map<std::string, std::string> properties;
  std::vector<PartPin> pins;

  /// "" when there is none.
  std::string_view property(const std::string& name) const;
  /// By number, else by name; nullptr: there is none.
  const PartPin* pin(std::string_view number_or_name) const;
};

struct PinOfNet {
  std::size_t part, pin;
};
struct Net {
  std::string name;
  std::vector<PinOfNet> pins;  ///< power symbols' pins, too
};

struct Netlist {
  std::vector<Part> parts;
  std::vector<Net> nets;
  /// What the drawing leaves open: a wire that ends on another without a junction, a label without a wire,
  /// ...
  std::vector<std::string> complaints;

  const Part* part(std::string_view reference) const;
  /// The net of a part's pin; nullptr: no such part or pin.
  const Net* net_of(std::string_view reference, std::string_view pin) const;
};

/// Reads `root` and the sheets that it names, from the same folder.
Result<Netlist, FileError> read_netlist(const std::filesystem::path& root);

}  // namespace kinebus::schematic
