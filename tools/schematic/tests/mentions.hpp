#pragma once
// Whether one of several lines says something.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace kinebus::schematic {

inline testing::AssertionResult mentions(const std::vector<std::string>& lines, std::string_view words) {
  std::string all;
  for (const std::string& line : lines) {
    if (line.find(words) != std::string::npos) return testing::AssertionSuccess() << line;
    all += "\n  " + line;
  }
  return testing::AssertionFailure() << "no line says \"" << words << "\":" << all;
}

}  // namespace kinebus::schematic
