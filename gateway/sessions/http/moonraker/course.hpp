#pragma once
// What clients that come later want to have heard: how temperatures went, and what was said on consoles.
// Bounded, in memory, from the daemon's start.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus::http {

/// The last 20 minutes, a value a second.
class TemperatureCourse {
 public:
  static constexpr std::size_t kValues = 1200;
  struct Value {
    double celsius = 0;
    std::optional<double> target_celsius{}, power{};  ///< nothing: no heater, or not told
  };
  using Courses = std::map<std::string, std::deque<Value>, std::less<>>;  ///< the oldest first

  void add(const std::string& sensor, Value value);
  /// A copy, for whoever makes text of it beside the loop.
  Courses all() const { return courses_; }

 private:
  Courses courses_;
};

/// Lines that clients sent, and what they were answered.
class ConsoleCourse {
 public:
  static constexpr std::size_t kLines = 1000, kBytes = 256U << 10;
  struct Line {
    std::uint64_t id = 0;  ///< ascending
    bool is_command = false;
    double unix_s = 0;
    std::string text{};
  };

  void add(bool is_command, double unix_s, std::string_view text);
  std::uint64_t newest() const { return newest_; }
  const std::deque<Line>& lines() const { return lines_; }

 private:
  std::deque<Line> lines_;
  std::size_t bytes_ = 0;
  std::uint64_t newest_ = 0;
};

}  // namespace kinebus::http
