#include "tools/tune/pressure_widths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/calibrate/csv.hpp"

namespace kinebus {
namespace {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

}  // namespace

Result<std::vector<LineWidths>, std::string> read_widths(std::string_view text) {
  const auto csv = Csv::parse(text);
  if (!csv) return Error<std::string>(to_string(csv.error(), "widths"));
  std::vector<LineWidths> widths;
  for (std::size_t row = 0; row < csv->rows(); ++row) {
    const auto advance = csv->plain(row, "advance_s");
    const auto faster = csv->quantity(row, "faster"), slower = csv->quantity(row, "slower");
    const bool near = csv->has("faster_near") || csv->has("slower_near");
    const auto faster_near = near ? csv->quantity(row, "faster_near") : faster;
    const auto slower_near = near ? csv->quantity(row, "slower_near") : slower;
    for (const auto* number : {&advance, &faster, &slower, &faster_near, &slower_near})
      if (!*number) return Error<std::string>(to_string(number->error(), "widths"));
    if (!(*advance >= 0 && *faster >= 0 && *slower >= 0 && *faster_near >= 0 && *slower_near >= 0))
      return Error<std::string>(fmt::format("widths:{}: no value can be below 0", csv->line(row)));
    widths.push_back({*advance, *faster, *slower, near ? *faster_near : 0, near ? *slower_near : 0});
  }
  return widths;
}

std::string write_widths(const std::vector<LineWidths>& widths) {
  const bool near = std::any_of(widths.begin(), widths.end(), [](const LineWidths& w) { return w.near(); });
  std::string text =
      fmt::format("advance_s,faster_mm,slower_mm{}\n", near ? ",faster_near_mm,slower_near_mm" : "");
  for (const LineWidths& w : widths) {
    text += fmt::format("{:.5f},{:.3f},{:.3f}", w.advance_s, w.faster_mm, w.slower_mm);
    if (near) text += fmt::format(",{:.3f},{:.3f}", w.faster_near_mm, w.slower_near_mm);
    text += "\n";
  }
  return text;
}

Result<PressureChoice, std::string> choose_advance(const std::vector<LineWidths>& widths) {
  if (widths.size() < 3) return Error<std::string>("at least three lines have to be measured");
  std::vector<double> slopes, levels, off;
  for (std::size_t i = 0; i < widths.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double by = widths[i].advance_s - widths[j].advance_s;
      if (by == 0) continue;
      slopes.push_back(
          ((widths[i].slower_mm - widths[i].faster_mm) - (widths[j].slower_mm - widths[j].faster_mm)) / by);
    }
  if (slopes.empty()) return Error<std::string>("the lines have to differ in their advance");
  const double slope = median(slopes);
  for (const LineWidths& w : widths) levels.push_back(w.slower_mm - w.faster_mm - slope * w.advance_s);
  const double level = median(levels);
  PressureChoice choice;
  double squares = 0, mean = 0, spread = 0;
  const auto count = static_cast<double>(widths.size());
  for (const LineWidths& w : widths) mean += w.advance_s / count;
  for (const LineWidths& w : widths) {
    const double left = w.slower_mm - w.faster_mm - slope * w.advance_s - level;
    squares += left * left;
    spread += (w.advance_s - mean) * (w.advance_s - mean);
  }
  choice.rms_mm = std::sqrt(squares / count);
  // Too much advance makes the line thinner behind the slowing down: the difference falls.
  if (!(slope < 0) || -slope * std::sqrt(spread) < 2 * choice.rms_mm)
    return Error<std::string>(
        "the widths do not change with the advance as they should: were the columns exchanged?");
  choice.advance_s = -level / slope;
  const double away = choice.advance_s - mean;
  choice.sigma_s = choice.rms_mm / -slope * std::sqrt(1 / count + away * away / spread);
  const auto [low, high] =
      std::minmax_element(widths.begin(), widths.end(),
                          [](const LineWidths& a, const LineWidths& b) { return a.advance_s < b.advance_s; });
  if (choice.advance_s < low->advance_s)
    return Error<std::string>(fmt::format(
        "even the least advance printed, {:g} s, is too much: print lines below it", low->advance_s));
  if (choice.advance_s > high->advance_s)
    return Error<std::string>(fmt::format(
        "even the greatest advance printed, {:g} s, is too little: print lines above it", high->advance_s));
  return choice;
}

}  // namespace kinebus
