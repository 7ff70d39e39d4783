#include "tools/schematic/tests/circuit.hpp"

#include <cmath>
#include <cstdlib>

namespace kinebus::schematic {
namespace {

bool is(const Part& part, std::string_view symbol) {
  return part.symbol == "kinebus:" + std::string(symbol);
}

}  // namespace

double quantity(std::string_view text) {
  char* end = nullptr;
  const std::string copy(text);
  const double number = std::strtod(copy.c_str(), &end);
  if (*end == ' ') ++end;
  switch (*end) {
    case 'p':
      return number * 1e-12;
    case 'n':
      return number * 1e-9;
    case 'u':
      return number * 1e-6;
    case 'm':
      return number * 1e-3;
    case 'k':
      return number * 1e3;
    case 'M':
      return number * 1e6;
    default:
      return number;
  }
}

std::size_t Circuit::net(std::string_view symbol, std::string_view pin) const {
  for (const Part& part : netlist_.parts)
    if (is(part, symbol)) return net(part, pin);
  return kNone;
}

std::size_t Circuit::net(const Part& part, std::string_view pin) const {
  const PartPin* found = part.pin(pin);
  return found ? found->net : kNone;
}

std::size_t Circuit::rail(std::string_view name) const {
  for (std::size_t i = 0; i < netlist_.nets.size(); ++i)
    if (netlist_.nets[i].name == name) return i;
  return kNone;
}

std::vector<End> Circuit::on(std::size_t net, std::string_view symbol, std::string_view pin) const {
  std::vector<End> ends;
  if (net == kNone) return ends;
  for (const auto [part_index, pin_index] : netlist_.nets[net].pins) {
    const Part& part = netlist_.parts[part_index];
    const PartPin& end = part.pins[pin_index];
    if (is(part, symbol) && (pin.empty() || end.name == pin || end.number == pin))
      ends.push_back({&part, &end});
  }
  return ends;
}

std::size_t Circuit::across(std::size_t net, std::string_view symbol, double value) const {
  for (const End& end : on(net, symbol)) {
    if (end.part->pins.size() != 2) continue;
    if (value != 0 && std::fabs(quantity(end.part->value) / value - 1) > 1e-6) continue;
    const std::size_t other = end.part->pins[end.pin == &end.part->pins[0] ? 1 : 0].net;
    if (other != net) return other;
  }
  return kNone;
}

std::vector<double> Circuit::volts(const std::map<std::string, double>& supplies) const {
  struct Link {
    std::size_t to;
    double siemens;
  };
  std::vector<std::vector<Link>> links(netlist_.nets.size());
  for (const Part& part : netlist_.parts) {
    if (!is(part, "R") && !is(part, "THERMISTOR")) continue;
    const double siemens = 1 / quantity(part.value);
    links[part.pins[0].net].push_back({part.pins[1].net, siemens});
    links[part.pins[1].net].push_back({part.pins[0].net, siemens});
  }
  std::vector<double> volts(netlist_.nets.size(), -1);
  std::vector<bool> fixed(netlist_.nets.size(), false);
  for (std::size_t i = 0; i < volts.size(); ++i)
    if (const auto found = supplies.find(netlist_.nets[i].name); found != supplies.end())
      volts[i] = found->second, fixed[i] = true;
  // Every turn brings each net to the mean of its known neighbours; the longest chain has four.
  for (int turn = 0; turn < 2000; ++turn)
    for (std::size_t i = 0; i < volts.size(); ++i) {
      if (fixed[i]) continue;
      double current = 0, siemens = 0;
      for (const Link& link : links[i])
        if (volts[link.to] >= 0) current += volts[link.to] * link.siemens, siemens += link.siemens;
      if (siemens > 0) volts[i] = current / siemens;
    }
  return volts;
}

}  // namespace kinebus::schematic
