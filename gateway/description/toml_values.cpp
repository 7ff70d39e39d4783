#include "gateway/description/toml_values.hpp"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

Sentence shown(const toml::node& node) {
  if (node.is_table()) return say("a table");
  if (const auto* array = node.as_array()) return say("an array of %1", array->size());
  std::ostringstream out;
  node.visit([&](const auto& n) {
    using T = std::decay_t<decltype(n)>;
    if constexpr (!std::is_same_v<T, toml::table> && !std::is_same_v<T, toml::array>) out << n;
  });
  std::string text = std::move(out).str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  constexpr std::size_t kLongest = 80;
  if (text.size() > kLongest) text = std::string(cut_text(text, kLongest)) + "...";
  return Sentence::verbatim(std::move(text));
}

std::string interval_text(machine_schema::Range range) {
  return short_number(range.min) + " .. " + short_number(range.max);
}

bool take_number(const toml::node& node, machine_schema::Range range, double unit, double& value) {
  double v = 0;
  if (const auto* f = node.as_floating_point())
    v = f->get();
  else if (const auto* i = node.as_integer())
    v = static_cast<double>(i->get());
  else
    return false;
  if (!(v >= range.min && v <= range.max)) return false;
  value = v * unit;
  return true;
}

}  // namespace kinebus
