#include "tools/tune/acceleration_readings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

namespace kinebus {
namespace {

constexpr std::size_t kLeastReadings = 1000;
constexpr double kLeastRate_hz = 400, kLongestGap_s = 0.1;

std::optional<std::array<double, 4>> four_numbers(std::string_view line) {
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[i]);
    if (error != std::errc() || !std::isfinite(numbers[i])) return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    while (!line.empty() && (line.front() == ' ' || line.front() == '\r')) line.remove_prefix(1);
    if (i + 1 == numbers.size()) return line.empty() ? std::optional(numbers) : std::nullopt;
    if (line.empty() || line.front() != ',') return std::nullopt;
    line.remove_prefix(1);
  }
  return std::nullopt;
}

}  // namespace

Result<AccelerationReadings, std::string> read_acceleration(std::string_view text) {
  AccelerationReadings readings;
  double first_s = 0, last_s = 0;
  for (int line_number = 1; !text.empty(); ++line_number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line == "\r" || line.front() == '#') continue;
    const auto numbers = four_numbers(line);
    if (!numbers)
      return Error<std::string>(
          fmt::format("{}: expected four numbers, time_s,x,y,z with mm/s^2", line_number));
    const double time_s = (*numbers)[0];
    if (readings.mm_per_s2.empty()) {
      first_s = time_s;
    } else if (!(time_s > last_s) || time_s > last_s + kLongestGap_s) {
      return Error<std::string>(
          fmt::format("{}: the time goes from {:.6f} s to {:.6f} s; expected readings at even times",
                      line_number, last_s, time_s));
    }
    last_s = time_s;
    readings.mm_per_s2.push_back({(*numbers)[1], (*numbers)[2], (*numbers)[3]});
  }
  const std::size_t count = readings.mm_per_s2.size();
  if (count < kLeastReadings)
    return Error<std::string>(fmt::format("{} readings; expected at least {}", count, kLeastReadings));
  readings.period_s = (last_s - first_s) / static_cast<double>(count - 1);
  if (readings.period_s > 1 / kLeastRate_hz)
    return Error<std::string>(fmt::format("{:.0f} readings a second; expected at least {:.0f}",
                                          1 / readings.period_s, kLeastRate_hz));
  return readings;
}

}  // namespace kinebus
