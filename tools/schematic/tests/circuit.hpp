#pragma once
// A netlist as its tests ask it: what hangs on a pin, what is behind a resistor, which voltage resistors
// make.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/schematic/netlist.hpp"

namespace kinebus::schematic {

struct End {
  const Part* part = nullptr;
  const PartPin* pin = nullptr;
};

/// "4.7k", "10m", "470u", "8MHz", "7.5 V": without its unit.
double quantity(std::string_view text);

class Circuit {
 public:
  explicit Circuit(const Netlist& netlist) : netlist_(netlist) {}

  const Netlist& netlist() const { return netlist_; }
  /// Net of a pin of the only part with this symbol, or kNone.
  std::size_t net(std::string_view symbol, std::string_view pin) const;
  std::size_t net(const Part& part, std::string_view pin) const;
  /// A supply: "GND", "+3V3".
  std::size_t rail(std::string_view name) const;
  std::string name(std::size_t net) const { return net == kNone ? "nothing" : netlist_.nets[net].name; }
  /// All pins of parts with this symbol on a net; with an empty `pin`: any.
  std::vector<End> on(std::size_t net, std::string_view symbol, std::string_view pin = {}) const;
  /// The net at the other end of the first two-pin part with this symbol (and value) on a net, or kNone.
  std::size_t across(std::size_t net, std::string_view symbol, double value = 0) const;
  /// Volts of each net that resistors and thermistors (at 25 C) alone make of these supplies; -1: none.
  std::vector<double> volts(const std::map<std::string, double>& supplies) const;

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

 private:
  const Netlist& netlist_;
};

}  // namespace kinebus::schematic
