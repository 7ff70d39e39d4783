#pragma once
// The words in which the schema of a machine file is written.

#include <cstdint>
#include <string_view>

namespace kinebus::machine_schema {

enum class Need : std::uint8_t { kRequired, kOptional };
struct Range {
  double min = 0, max = 0;
};
struct Choice {
  std::string_view word;
  int value;
};

}  // namespace kinebus::machine_schema
