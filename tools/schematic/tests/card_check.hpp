#pragma once
// What of the driver card's schematic is not as the firmware's board.hpp has it. One line each; empty: all
// is.

#include <string>
#include <vector>

#include "tools/schematic/tests/circuit.hpp"

namespace kinebus::schematic {

/// Every pin of the firmware's table, and of what the chip itself needs, leads to the right part.
std::vector<std::string> check_pins(const Circuit& circuit);
/// Half-bridges, shunts, comparators and enables of both motors, and their numbers.
std::vector<std::string> check_stages(const Circuit& circuit);
/// What the supplies may be, each part stands; every supply pin has its capacitor.
std::vector<std::string> check_ratings(const Circuit& circuit);

/// Supplies as they should be, in volts.
inline const std::map<std::string, double> kSupplies{{"GND", 0},   {"+3V3", 3.3}, {"+3V3A", 3.3}, {"+5V", 5},
                                                     {"+10V", 10}, {"VM", 24},    {"VBUS", 5}};

/// Notes a line when something is not so.
class Complaints {
 public:
  void expect(bool holds, std::string words) {
    if (!holds) lines_.push_back(std::move(words));
  }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

}  // namespace kinebus::schematic
