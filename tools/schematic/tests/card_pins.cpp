#include <fmt/format.h>

#include <cmath>
#include <set>

#include "node_firmware/port/stm32f405/board.hpp"
#include "tools/schematic/tests/card_check.hpp"

namespace kinebus::schematic {
namespace {

constexpr std::string_view kChip = "STM32F405RG";

/// A pin of the chip, the part it leads to, and the resistor on the way (0: none).
struct Row {
  std::string_view chip, symbol, value, pin;
  double ohm;
};
// Motors, dividers and the crystal have checks of their own.
constexpr Row kRows[] = {
    {"PB8", "SN65HVD233", "", "R", 0},
    {"PB9", "SN65HVD233", "", "D", 0},
    {"PB6", "CONN_4", "CONSOLE", "2", 100},
    {"PB7", "CONN_4", "CONSOLE", "3", 100},
    {"PB3", "CONN_8", "ENCODER A", "4", 47},
    {"PB4", "CONN_8", "ENCODER A", "5", 47},
    {"PB5", "CONN_8", "ENCODER A", "6", 47},
    {"PA15", "CONN_8", "ENCODER A", "7", 47},
    {"PC10", "CONN_8", "ENCODER B", "4", 47},
    {"PC11", "CONN_8", "ENCODER B", "5", 47},
    {"PC12", "CONN_8", "ENCODER B", "6", 47},
    {"PD2", "CONN_8", "ENCODER B", "7", 47},
    {"PB0", "CONN_3", "SWITCH 1", "2", 1000},
    {"PB1", "CONN_3", "SWITCH 2", "2", 1000},
    {"PC3", "CONN_3", "SWITCH 3", "2", 1000},
    {"PC4", "CONN_3", "SWITCH 4", "2", 1000},
    {"PC5", "CONN_3", "SWITCH 5", "2", 1000},
    {"PB10", "CONN_3", "SWITCH 6", "2", 1000},
    {"PB11", "CONN_3", "E-STOP", "2", 1000},
    {"PB14", "TS3USB221", "", "2D-", 22},
    {"PB15", "TS3USB221", "", "2D+", 22},
    {"PC13", "LED", "STATUS", "K", 0},
    {"PC14", "74LVC1G02", "", "B", 0},
    // Not in the firmware's table: what the chip's own boot loader and a debugger use.
    {"PA11", "TS3USB221", "", "1D-", 0},
    {"PA12", "TS3USB221", "", "1D+", 0},
    {"PA13", "SWD_10", "", "SWDIO", 0},
    {"PA14", "SWD_10", "", "SWCLK", 0},
    {"NRST", "SWD_10", "", "NRESET", 0},
    {"BOOT0", "74LVC1G02", "", "A", 0},
};
/// Pins that other functions look at.
const std::set<std::string> kElsewhere{"PA8", "PA9", "PA10", "PA11", "PB12", "PA4", "PC6",
                                       "PC7", "PC8", "PC9",  "PA6",  "PA5",  "PA0", "PA1",
                                       "PA2", "PA3", "PC0",  "PC1",  "PC2",  "PB13"};

std::string pin_name(board::Port port, int number) {
  return fmt::format("P{}{}", static_cast<char>('A' + static_cast<int>(port)), number);
}

void check_row(const Circuit& circuit, const Row& row, Complaints& found) {
  const std::size_t net = circuit.net(kChip, row.chip);
  bool reached = false;
  const auto look = [&](std::size_t at) {
    for (const End& end : circuit.on(at, row.symbol, row.pin))
      reached = reached || row.value.empty() || end.part->value == row.value;
  };
  if (row.ohm == 0) look(net);
  for (const End& end : circuit.on(net, "R"))
    if (row.ohm != 0 && quantity(end.part->value) == row.ohm)
      look(end.part->pins[end.pin == &end.part->pins[0] ? 1 : 0].net);
  found.expect(reached, fmt::format("{} ({}) does not lead to {} {} pin {} by {} ohm", row.chip,
                                    circuit.name(net), row.symbol, row.value, row.pin, row.ohm));
}

void check_switches(const Circuit& circuit, Complaints& found) {
  const auto volts = circuit.volts(kSupplies);
  for (std::size_t i = 0; i < board::kSwitchPins.size(); ++i) {
    const std::string chip = pin_name(board::kSwitchPins[i].port, board::kSwitchPins[i].line);
    const std::size_t net = circuit.net(kChip, chip);
    const std::size_t outside = circuit.across(net, "R", 1000);
    found.expect(circuit.across(outside, "R", 4700) == circuit.rail("+3V3"),
                 chip + ": input is not pulled up by 4.7 kOhm");
    found.expect(circuit.across(net, "C", 10e-9) == circuit.rail("GND"), chip + ": no 10 nF to ground");
    const auto clamp = circuit.on(net, "BAT54S", "COM");
    found.expect(clamp.size() == 1 && circuit.net(*clamp[0].part, "K") == circuit.rail("+3V3") &&
                     circuit.net(*clamp[0].part, "A") == circuit.rail("GND"),
                 chip + ": input is not clamped to 3.3 V and ground");
    // Against the pin's own pull-down of 30 kOhm at least: above 0.7 of the supply.
    found.expect(net != Circuit::kNone && volts[net] * 30 / (30 + 5.7) > 0.7 * 3.3,
                 chip + ": no high level at rest");
  }
}

void check_scales(const Circuit& circuit, Complaints& found) {
  for (std::size_t i = 0; i < board::kScalePins.size(); ++i) {
    const board::ScalePins& scale = board::kScalePins[i];
    const std::string name = i == 0 ? "SCALE A" : "SCALE B";
    const std::string first = pin_name(scale.port, scale.first), second = pin_name(scale.port, scale.second);
    check_row(circuit, {first, "CONN_4", name, "3", 1000}, found);
    check_row(circuit, {second, "CONN_4", name, "4", 1000}, found);
    for (const std::string& chip : {first, second})
      found.expect(!circuit.on(circuit.net(kChip, chip), "BAT54S", "COM").empty(),
                   chip + ": a scale of 5 V is not clamped");
  }
}

void check_usb(const Circuit& circuit, Complaints& found) {
  const auto volts = circuit.volts(kSupplies);
  const std::size_t sense = circuit.net(kChip, pin_name(board::kUsbVbus.port, board::kUsbVbus.number));
  found.expect(sense != Circuit::kNone && volts[sense] > 2.4 && volts[sense] < 3.6,
               "PB13 does not see VBUS as a high level of at most 3.6 V");
  const std::size_t run = circuit.net("TS3USB221", "S");
  const auto gates = circuit.on(run, "74LVC1G02", "Y");
  found.expect(gates.size() == 1 && circuit.net(*gates[0].part, "A") == circuit.net(kChip, "BOOT0") &&
                   circuit.net(*gates[0].part, "B") == circuit.net(kChip, "PC14"),
               "the USB switch is not led by BOOT0 or PC14");
  found.expect(circuit.net("TS3USB221", "OE") == circuit.rail("GND"), "the USB switch is not enabled");
  found.expect(circuit.net("TS3USB221", "D+") == circuit.net("USB_C", "A6") &&
                   circuit.net("TS3USB221", "D-") == circuit.net("USB_C", "A7") &&
                   circuit.net("USB_C", "A6") == circuit.net("USB_C", "B6") &&
                   circuit.net("USB_C", "A7") == circuit.net("USB_C", "B7"),
               "the USB switch is not at the connector");
  for (const std::string_view cc : {"A5", "B5"})
    found.expect(circuit.across(circuit.net("USB_C", cc), "R", 5100) == circuit.rail("GND"),
                 fmt::format("USB connector {} has no 5.1 kOhm to ground", cc));
}

void check_bus(const Circuit& circuit, Complaints& found) {
  const std::size_t high = circuit.net("SN65HVD233", "CANH"), low = circuit.net("SN65HVD233", "CANL");
  found.expect(circuit.on(high, "CONN_3", "1").size() == 2 && circuit.on(low, "CONN_3", "2").size() == 2,
               "CAN is not on two connectors");
  found.expect(circuit.across(circuit.across(high, "JUMPER"), "R", 120) == low,
               "no 120 Ohm by jumper across the bus");
  for (const std::string_view pin : {"LBK", "RS"})
    found.expect(circuit.net("SN65HVD233", pin) == circuit.rail("GND"),
                 fmt::format("CAN transceiver: {} not low", pin));
}

void check_chip(const Circuit& circuit, Complaints& found) {
  const auto ground = circuit.rail("GND");
  const auto volts = circuit.volts(kSupplies);
  const auto level = [&](std::string_view pin) {
    const std::size_t net = circuit.net(kChip, pin);
    return net == Circuit::kNone ? -1 : volts[net];
  };
  for (const std::string_view pin : {"BOOT0", "PB2", "PC14", "PA4", "PA5"})
    found.expect(level(pin) == 0, fmt::format("{} is not pulled low", pin));
  for (const std::string_view pin : {"PB4", "PC11", "PA15", "PD2", "PB9"})
    found.expect(level(pin) > 3.2, fmt::format("{} is not pulled up", pin));
  for (const std::string_view pin : {"VCAP_1", "VCAP_2"})
    found.expect(circuit.across(circuit.net(kChip, pin), "C", 2.2e-6) == ground,
                 fmt::format("{} has no 2.2 uF", pin));
  const auto crystal = circuit.on(circuit.net(kChip, "PH0"), "CRYSTAL", "1");
  found.expect(crystal.size() == 1 && circuit.net(*crystal[0].part, "3") == circuit.net(kChip, "PH1") &&
                   quantity(crystal[0].part->value) == board::kCrystalHz,
               "no crystal of 8 MHz on PH0 and PH1");
  if (crystal.empty()) return;
  // Both capacitors in series, and some 4 pF of pins and tracks.
  for (const std::string_view pin : {"PH0", "PH1"}) {
    const auto load = circuit.on(circuit.net(kChip, pin), "C");
    found.expect(load.size() == 1 && std::fabs(quantity(load[0].part->value) / 2 + 4e-12 -
                                               quantity(crystal[0].part->property("Load"))) < 1e-12,
                 fmt::format("{}: not the crystal's load", pin));
  }
  const std::size_t led = circuit.net(kChip, pin_name(board::kStatusLed.port, board::kStatusLed.number));
  const auto lamp = circuit.on(led, "LED", "K");
  found.expect(
      lamp.size() == 1 && circuit.across(circuit.net(*lamp[0].part, "A"), "R", 1000) == circuit.rail("+3V3"),
      "the status LED is not between PC13 and 3.3 V");
  const std::size_t supply = circuit.net(kChip, "PC0");
  found.expect(supply != Circuit::kNone && std::fabs(24 / volts[supply] / board::kSupplyDivider - 1) < 1e-3,
               "PC0 does not see the supply by the firmware's divider");
}

}  // namespace

std::vector<std::string> check_pins(const Circuit& circuit) {
  Complaints found;
  std::set<std::string> known(kElsewhere);
  for (const Row& row : kRows) check_row(circuit, row, found), known.insert(std::string(row.chip));
  for (const board::Pin& pin : board::kPins)
    found.expect(known.count(pin_name(pin.port, pin.number)) > 0,
                 fmt::format("{} ({}) is in board.hpp, and nobody looks where it leads",
                             pin_name(pin.port, pin.number), pin.signal));
  check_switches(circuit, found);
  check_scales(circuit, found);
  check_usb(circuit, found);
  check_bus(circuit, found);
  check_chip(circuit, found);
  return found.take();
}

}  // namespace kinebus::schematic
