#pragma once
// What the interpreter's tests share.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "gateway/gcode/canonical_text.hpp"
#include "gateway/gcode/interpreter.hpp"

namespace kinebus::gcode {

/// Lines carried out one after the other, numbered from 1.
class Session {
 public:
  explicit Session(Options options = {}) : interpreter(std::move(options)) {}

  /// "" or the error as "line:column: message".
  std::string run(std::string_view line) {
    const auto result = interpreter.execute(line, ++number, commands);
    return result ? "" : to_string(result.error());
  }
  /// Carries out all lines of `text`, which must be right.
  void must(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      const std::string_view line = text.substr(0, end);
      EXPECT_EQ(run(line), "") << line;
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
  }
  template <typename T>
  std::vector<T> all() const {
    std::vector<T> found;
    for (const canonical::Line& line : commands)
      if (const T* command = std::get_if<T>(&line.command)) found.push_back(*command);
    return found;
  }
  std::vector<std::string> texts(std::size_t first = 0) const {
    std::vector<std::string> lines;
    for (std::size_t i = first; i < commands.size(); ++i) lines.push_back(canonical::to_text(commands[i]));
    return lines;
  }

  Interpreter interpreter;
  CommandBuffer commands;
  std::uint32_t number = 0;
};

inline void expect_near(const Pose& actual, const Pose& expected, double tolerance = 1e-9) {
  for (std::size_t axis = 0; axis < actual.size(); ++axis)
    EXPECT_NEAR(actual[axis], expected[axis], tolerance) << axis;
}

}  // namespace kinebus::gcode
