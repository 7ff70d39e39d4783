#include "tools/schematic/bill.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace kinebus::schematic {
namespace {

/// R2 before R10.
std::pair<std::string, int> order_of(const std::string& reference) {
  const std::size_t digits = std::min(reference.find_first_of("0123456789"), reference.size());
  return {reference.substr(0, digits), std::atoi(reference.c_str() + digits)};
}

std::string csv_text(std::string_view text) {
  std::string made = "\"";
  for (const char c : text) made += c == '"' ? "\"\"" : std::string(1, c);
  return made + "\"";
}

}  // namespace

std::string bill_of_materials(const Netlist& netlist) {
  std::map<std::string_view, std::vector<const Part*>> orders;
  for (const Part& part : netlist.parts)
    if (part.in_bill) orders[part.property("MPN")].push_back(&part);
  std::vector<std::vector<const Part*>> rows;
  for (auto& [number, parts] : orders) {
    std::sort(parts.begin(), parts.end(),
              [](const Part* a, const Part* b) { return order_of(a->reference) < order_of(b->reference); });
    rows.push_back(parts);
  }
  std::sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return order_of(a.front()->reference) < order_of(b.front()->reference);
  });
  std::string csv = "Quantity,Value,Manufacturer,MPN,Rating,Footprint,References\n";
  for (const auto& parts : rows) {
    std::string references;
    for (const Part* part : parts) references += (references.empty() ? "" : " ") + part->reference;
    const Part& first = *parts.front();
    csv += fmt::format("{},{},{},{},{},{},{}\n", parts.size(), csv_text(first.value),
                       csv_text(first.property("Manufacturer")), csv_text(first.property("MPN")),
                       csv_text(first.property("Rating")), csv_text(first.property("Footprint")),
                       csv_text(references));
  }
  return csv;
}

}  // namespace kinebus::schematic
