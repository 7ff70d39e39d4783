#pragma once
// Values of a TOML file: read as numbers in a range, and said in messages.

#include <array>
#include <string>

#include "gateway/description/schema_words.hpp"
#include "gateway/sentence.hpp"
#include "gateway/toml.hpp"

namespace kinebus {

/// What stands there, cut to one readable line.
Sentence shown(const toml::node& node);

std::string interval_text(machine_schema::Range range);

/// A number in `range`, times `unit`. False, and `value` as it was: it is none.
bool take_number(const toml::node& node, machine_schema::Range range, double unit, double& value);

template <std::size_t N>
bool take_numbers(const toml::node& node, machine_schema::Range range, double unit,
                  std::array<double, N>& values) {
  const auto* array = node.as_array();
  if (array == nullptr || array->size() != N) return false;
  std::array<double, N> read{};
  for (std::size_t k = 0; k < N; ++k)
    if (!take_number((*array)[k], range, unit, read[k])) return false;
  values = read;
  return true;
}

}  // namespace kinebus
