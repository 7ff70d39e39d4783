#include "tools/tune/node_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <optional>

namespace kinebus {
namespace {

constexpr std::size_t kLeastBands = 100;
constexpr double kMostClipped = 1e-3, kSlowestChip_hz = 1000, kFastestChip_hz = 20'000;

double band_width_hz(const NodeSpectrum& s) {
  return 1 / (s.period_s() * static_cast<double>(NodeSpectrum::kPoints));
}

std::optional<std::array<double, 3>> three_numbers(std::string_view line) {
  std::array<double, 3> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), numbers[i]);
    if (error != std::errc() || !(numbers[i] >= 0) || !std::isfinite(numbers[i])) return std::nullopt;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    if (i + 1 == numbers.size()) return line.empty() ? std::optional(numbers) : std::nullopt;
    if (line.empty() || line.front() != ',') return std::nullopt;
    line.remove_prefix(1);
  }
  return std::nullopt;
}

/// What the mean over a period leaves of a frequency, and the node's triangle of 15 readings: energies.
double gain_of_mean(double hz, double period_s) {
  const double x = std::numbers::pi * hz * period_s;
  return x == 0 ? 1 : std::pow(std::sin(x) / x, 2);
}
double gain_of_node(double hz, double rate_hz) {
  const double x = std::numbers::pi * hz / rate_hz;
  return x == 0 ? 1
                : std::pow(
                      std::sin(NodeSpectrum::kDecimation * x) / (NodeSpectrum::kDecimation * std::sin(x)), 4);
}

}  // namespace

Bands NodeSpectrum::bands(double from_hz, double to_hz) const {
  const double width = band_width_hz(*this);
  const double first = std::ceil(from_hz / width), last = std::floor(to_hz / width);
  const double most = static_cast<double>(energy.size()) - 1;
  const double count = std::min(last, most) - first + 1;
  return {(first - 0.5) * width, width, count > 0 ? static_cast<std::size_t>(count) : 0};
}

std::vector<double> NodeSpectrum::of(std::size_t axis, const Bands& bands) const {
  const auto first = static_cast<std::size_t>(std::lround(bands.from_hz / bands.width_hz + 0.5));
  std::vector<double> values(bands.count);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = energy[first + i][axis];
  return values;
}

Result<NodeSpectrum, std::string> read_node_spectrum(std::string_view text) {
  NodeSpectrum s;
  const std::string head(text.substr(0, text.find('\n')));
  int used = 0;
  if (std::sscanf(head.c_str(), "rate_hz %lf windows %u clipped %u%n", &s.rate_hz, &s.windows, &s.clipped,
                  &used) != 3 ||
      head.find_last_not_of('\r') + 1 != static_cast<std::size_t>(used))
    return Error<std::string>("1: expected \"rate_hz R windows W clipped C\"");
  if (!(s.rate_hz >= kSlowestChip_hz && s.rate_hz <= kFastestChip_hz))
    return Error<std::string>(fmt::format("1: {:.0f} readings a second; expected {:.0f} to {:.0f}", s.rate_hz,
                                          kSlowestChip_hz, kFastestChip_hz));
  const double readings = s.windows * static_cast<double>(NodeSpectrum::kHop) * NodeSpectrum::kDecimation;
  if (s.windows == 0 || s.clipped >= kMostClipped * readings)
    return Error<std::string>(fmt::format(
        "1: {} readings of some {:.0f} clipped; expected less than one in a thousand", s.clipped, readings));
  text.remove_prefix(std::min(text.size(), head.size() + 1));
  for (int line_number = 2; !text.empty(); ++line_number) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty()) continue;
    const auto numbers = three_numbers(line);
    if (!numbers) return Error<std::string>(fmt::format("{}: expected three numbers, x,y,z", line_number));
    s.energy.push_back(*numbers);
  }
  if (s.energy.size() < kLeastBands)
    return Error<std::string>(fmt::format("{} bands; expected at least {}", s.energy.size(), kLeastBands));
  return s;
}

std::vector<double> as_the_node(const std::vector<double>& values, const NodeSpectrum& spectrum,
                                const Bands& bands) {
  constexpr std::size_t kPoints = NodeSpectrum::kPoints;
  std::vector<double> sum(bands.count, 0.0), window(kPoints);
  // Rest before and behind: every value lies in as many windows as any other.
  const auto at = [&](std::ptrdiff_t i) {
    return i < 0 || i >= static_cast<std::ptrdiff_t>(values.size()) ? 0 : values[static_cast<std::size_t>(i)];
  };
  for (auto begin = -static_cast<std::ptrdiff_t>(kPoints); begin < static_cast<std::ptrdiff_t>(values.size());
       begin += NodeSpectrum::kHop) {
    for (std::size_t i = 0; i < kPoints; ++i)
      window[i] = at(begin + static_cast<std::ptrdiff_t>(i)) * 0.5 *
                  (1 - std::cos(2 * std::numbers::pi * static_cast<double>(i) / kPoints));
    const std::vector<double> energy = energy_spectrum(window, spectrum.period_s(), bands);
    for (std::size_t b = 0; b < sum.size(); ++b) sum[b] += energy[b];
  }
  for (std::size_t b = 0; b < sum.size(); ++b) {
    const double hz = bands.middle_hz(b);
    sum[b] *= gain_of_node(hz, spectrum.rate_hz) / gain_of_mean(hz, spectrum.period_s());
  }
  return sum;
}

}  // namespace kinebus
