#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "node_firmware/motor/supervision.hpp"
#include "tools/schematic/tests/card_check.hpp"

namespace kinebus::schematic {
namespace {

/// What a part has to bear for good above what may be there, as a factor.
constexpr double kMargin = 1.2;
constexpr double kMostSupplyV = 30;  // the highest at which the firmware goes on

bool stands_on(const Part& part, std::string_view symbol) {
  return part.symbol == "kinebus:" + std::string(symbol);
}

/// The highest voltage of a net that the supplies' names tell, transients included.
double most_volts(const std::string& net, double clamp_v) {
  if (net == "VM") return clamp_v;
  if (net == "+10V") return 10;
  if (net == "+5V" || net == "VBUS" || net.find("+5V_OUT") != std::string::npos) return 5.25;
  return 3.4;
}

double clamp_volts(const Circuit& circuit, Complaints& found) {
  const auto suppressors = circuit.on(circuit.rail("VM"), "TVS", "K");
  found.expect(suppressors.size() == 1, "the supply has no suppressor");
  if (suppressors.empty()) return 1e9;
  const double standoff = quantity(suppressors[0].part->property("Standoff"));
  found.expect(
      standoff >= static_cast<double>(motor::Surroundings::Limits{}.over_v) && standoff >= kMostSupplyV,
      "the suppressor conducts at a supply at which the firmware still goes on");
  return quantity(suppressors[0].part->property("Clamp"));
}

void check_voltages(const Circuit& circuit, double clamp_v, Complaints& found) {
  const Netlist& netlist = circuit.netlist();
  for (const Part& part : netlist.parts) {
    const double rated = quantity(part.property("Voltage"));
    if (stands_on(part, "C") || stands_on(part, "C_POL")) {
      double most = 0;
      bool boot = false;
      for (const PartPin& pin : part.pins) {
        most = std::max(most, most_volts(circuit.name(pin.net), clamp_v));
        boot = boot || !circuit.on(pin.net, "LM5106", "HB").empty() ||
               !circuit.on(pin.net, "LMR16006", "CB").empty();
      }
      if (boot) most = std::max(most, 10.5);
      found.expect(rated >= kMargin * most, fmt::format("{}: {} V for {} V", part.reference, rated, most));
    }
    const bool in_bridge = stands_on(part, "NMOS_DUAL") || stands_on(part, "INA240") ||
                           stands_on(part, "LM5106") || stands_on(part, "LMR16006") ||
                           stands_on(part, "SCHOTTKY") || stands_on(part, "DIODE");
    const double seen = stands_on(part, "LM5106") || stands_on(part, "DIODE") ? clamp_v + 10 : clamp_v;
    const double stands = stands_on(part, "LMR16006") ? quantity(part.property("Supply")) : rated;
    if (in_bridge)
      found.expect(stands >= kMargin * seen, fmt::format("{}: {} V for {} V", part.reference, stands, seen));
    // Supplies of circuits.
    const double supply = quantity(part.property("Supply"));
    for (const PartPin& pin : part.pins)
      if (pin.type == "power_in" && supply > 0 && circuit.name(pin.net) != "GND")
        found.expect(most_volts(circuit.name(pin.net), clamp_v) <= supply,
                     fmt::format("{}: {} is too much for its supply", part.reference, circuit.name(pin.net)));
  }
}

/// As many capacitors from a supply to ground as there are pins that it feeds, on the same sheet.
void check_decoupling(const Circuit& circuit, Complaints& found) {
  const Netlist& netlist = circuit.netlist();
  std::map<std::pair<std::string, std::string>, int> pins, capacitors;
  for (const Part& part : netlist.parts) {
    if (part.power) continue;
    if (part.pins.size() == 2 && (stands_on(part, "C") || stands_on(part, "C_POL"))) {
      const std::string a = circuit.name(part.pins[0].net), b = circuit.name(part.pins[1].net);
      if (quantity(part.value) >= 90e-9 && (a == "GND" || b == "GND"))
        ++capacitors[{part.sheet, a == "GND" ? b : a}];
    }
    for (const PartPin& pin : part.pins)
      if (pin.type == "power_in" && circuit.name(pin.net) != "GND")
        ++pins[{part.sheet, circuit.name(pin.net)}];
  }
  for (const auto& [where, count] : pins)
    found.expect(capacitors[where] >= count,
                 fmt::format("{}: {} supply pins on {} and {} capacitors", where.first, count, where.second,
                             capacitors[where]));
}

/// Feedback dividers of the converters.
void check_converters(const Circuit& circuit, Complaints& found) {
  const auto volts = circuit.volts(kSupplies);
  for (const Part& part : circuit.netlist().parts) {
    if (!stands_on(part, "LMR16006")) continue;
    const double seen = volts[circuit.net(part, "FB")], wanted = quantity(part.property("Reference_V"));
    found.expect(std::fabs(seen / wanted - 1) < 0.02,
                 fmt::format("{}: {:.3f} V at its feedback", part.reference, seen));
  }
}

/// The shunts at 5 A a phase, and the bulk capacitor of each motor.
void check_power(const Circuit& circuit, Complaints& found) {
  int bulk = 0;
  for (const Part& part : circuit.netlist().parts) {
    if (stands_on(part, "R") && quantity(part.value) == 0.01)
      found.expect(quantity(part.property("Power")) >= 2 * 5 * 5 * 0.01,
                   part.reference + ": too small for 5 A");
    if (stands_on(part, "C_POL") && quantity(part.value) >= 470e-6 && circuit.name(part.pins[0].net) == "VM")
      ++bulk;
  }
  found.expect(bulk >= 2, "no 470 uF for each motor");
  found.expect(circuit.across(circuit.rail("VM"), "FUSE") != Circuit::kNone, "the supply has no fuse");
}

}  // namespace

std::vector<std::string> check_ratings(const Circuit& circuit) {
  Complaints found;
  const double clamp_v = clamp_volts(circuit, found);
  check_voltages(circuit, clamp_v, found);
  check_decoupling(circuit, found);
  check_converters(circuit, found);
  check_power(circuit, found);
  return found.take();
}

}  // namespace kinebus::schematic
