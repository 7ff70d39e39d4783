#include "tools/schematic/rules.hpp"

#include <fmt/format.h>

#include <array>

namespace kinebus::schematic {
namespace {

struct Kinds {
  int driven = 0;   ///< pins that drive whatever the others do
  int open = 0;     ///< open-collector outputs
  int feeds = 0;    ///< power_out, flags included
  int needs = 0;    ///< power_in
  int passive = 0;  ///< what may come from elsewhere
  std::string names;
};

void check_net(const Netlist& netlist, const Net& net, std::vector<std::string>& found) {
  Kinds kinds;
  for (const auto [part_index, pin_index] : net.pins) {
    const Part& part = netlist.parts[part_index];
    const PartPin& pin = part.pins[pin_index];
    const std::string name = fmt::format("{}.{} ({})", part.reference, pin.number, pin.name);
    if (pin.type == "output" || (pin.type == "power_out" && !part.power))
      ++kinds.driven, kinds.names += " " + name;
    if (pin.type == "open_collector") ++kinds.open;
    if (pin.type == "power_out") ++kinds.feeds;
    if (pin.type == "power_in" && !part.power) ++kinds.needs;
    if (pin.type != "input" && pin.type != "power_in" && pin.type != "no_connect") ++kinds.passive;
    const bool alone = net.pins.size() == 1;
    if (pin.marked_unconnected && !alone)
      found.push_back(fmt::format("{} is marked as not connected and is on {}", name, net.name));
    if (pin.type == "no_connect" && !alone)
      found.push_back(fmt::format("{} has no function and is on {}", name, net.name));
    if (alone && !pin.marked_unconnected && pin.type != "no_connect")
      found.push_back(fmt::format("{} is not connected", name));
  }
  if (kinds.driven > 1)
    found.push_back(fmt::format("outputs against each other on {}:{}", net.name, kinds.names));
  if (kinds.driven > 0 && kinds.open > 0)
    found.push_back(fmt::format("an open-collector output and an output on {}", net.name));
  if (kinds.needs > 0 && kinds.feeds == 0) found.push_back(fmt::format("nothing feeds {}", net.name));
  if (kinds.passive == 0 && kinds.needs == 0 && net.pins.size() > 1) {
    bool supply = false;
    for (const auto [part, pin] : net.pins) supply = supply || netlist.parts[part].power;
    if (!supply) found.push_back(fmt::format("only inputs are on {}", net.name));
  }
}

}  // namespace

std::vector<std::string> check_rules(const Netlist& netlist) {
  std::vector<std::string> found = netlist.complaints;
  for (const Net& net : netlist.nets) check_net(netlist, net, found);
  static const std::array<std::string, 4> kOrder{"Footprint", "Manufacturer", "MPN", "Rating"};
  for (const Part& part : netlist.parts) {
    if (!part.in_bill) continue;
    for (const std::string& property : kOrder)
      if (part.property(property).empty())
        found.push_back(fmt::format("{} has no {}", part.reference, property));
  }
  return found;
}

}  // namespace kinebus::schematic
