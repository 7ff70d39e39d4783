#include "tools/tune/pressure_pattern.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "gateway/shaping/advance_model.hpp"
#include "tools/drawing/document.hpp"

namespace kinebus {

double PressurePattern::advance_s(int line) const {
  return from_s + (to_s - from_s) * line / (lines - 1);
}

double PressurePattern::filament_per_mm() const {
  return width_mm * height_mm / (0.25 * std::numbers::pi * filament_mm * filament_mm);
}

Result<void, std::string> check(const PressurePattern& p) {
  const auto wrong = [](const char* what) { return Error<std::string>(what); };
  if (!(p.from_s >= 0 && p.to_s > p.from_s && p.to_s <= AdvanceModel::kMost_s))
    return wrong("the advances have to rise, from 0 s or more to 2 s at most");
  if (p.lines < 3 || p.lines > 60) return wrong("3 to 60 lines are printed");
  if (!(p.slow_mm_per_s > 0 && p.fast_mm_per_s > 1.5 * p.slow_mm_per_s))
    return wrong("the fast part has to be faster than the slow ones, 1.5 times or more");
  if (!(p.width_mm > 0 && p.height_mm > 0 && p.filament_mm > 0))
    return wrong("the bead and the filament need a width, a height and a diameter");
  if (p.fast_part_mm < kWidthOver_mm + kBrakes_mm || p.slow_part_mm < kWidthOver_mm)
    return wrong("the parts are too short to be measured");
  return {};
}

std::string pattern_job(const PressurePattern& p) {
  const double per_mm = p.filament_per_mm();
  std::string text = fmt::format(
      "; pressure advance {:g} to {:g} s in {} lines, from below upwards\n; each: {:g} mm at {:g} mm/s, {:g} "
      "mm at {:g} mm/s, "
      "{:g} mm at {:g} mm/s\nG21\nG90\nM83\n",
      p.from_s, p.to_s, p.lines, p.slow_part_mm, p.slow_mm_per_s, p.fast_part_mm, p.fast_mm_per_s,
      p.slow_part_mm, p.slow_mm_per_s);
  if (p.bed_celsius > 0) text += fmt::format("M140 S{:g}\n", p.bed_celsius);
  if (p.hotend_celsius > 0) text += fmt::format("M109 S{:g}\n", p.hotend_celsius);
  if (p.bed_celsius > 0) text += fmt::format("M190 S{:g}\n", p.bed_celsius);
  const double length_mm = 2 * p.slow_part_mm + p.fast_part_mm;
  const auto travel = [&](double y_mm) {
    text += fmt::format(
        "G1 E-{0:g} F{1:.0f}\nG0 Z{2:.3f}\nG0 X{3:.3f} Y{4:.3f} F9000\nG0 Z{5:.3f}\nG1 E{0:g} F{1:.0f}\n",
        p.retract_mm, 60 * p.retract_mm_per_s, p.height_mm + 0.6, p.left_mm(), y_mm, p.height_mm);
  };
  const auto feed = [&](double x_mm, double along_mm, double mm_per_s) {
    text += fmt::format("G1 X{:.3f} E{:.5f} F{:.0f}\n", x_mm, along_mm * per_mm, 60 * mm_per_s);
  };
  text += fmt::format("G0 Z{:.3f} F3000\n", p.height_mm + 0.6);
  text += fmt::format("G1 E{:g} F{:.0f}\n", p.retract_mm, 60 * p.retract_mm_per_s);
  travel(p.line_y_mm(0) - p.pitch_mm);
  feed(p.left_mm() + length_mm, length_mm, p.slow_mm_per_s);
  for (int i = 0; i < p.lines; ++i) {
    text += fmt::format("; line {}: {:.4f} s\nM572 S{:.5f}\n", i + 1, p.advance_s(i), p.advance_s(i));
    travel(p.line_y_mm(i));
    feed(p.speeds_up_mm(), p.slow_part_mm, p.slow_mm_per_s);
    feed(p.slows_down_mm(), p.fast_part_mm, p.fast_mm_per_s);
    feed(p.left_mm() + length_mm, p.slow_part_mm, p.slow_mm_per_s);
  }
  text +=
      fmt::format("G1 E-{:g} F{:.0f}\nG0 Z{:.1f}\n", p.retract_mm, 60 * p.retract_mm_per_s, p.height_mm + 20);
  if (p.hotend_celsius > 0) text += "M104 S0\n";
  if (p.bed_celsius > 0) text += "M140 S0\n";
  return text;
}

std::string draw_pattern(const PressurePattern& p) {
  using drawing::Point;
  constexpr std::string_view kBead = "#e07b39", kPlace = "#29788e";
  constexpr double kLeft = 60, kRow = 110, kTop = 150;
  const double scale = 900 / (2 * p.slow_part_mm + p.fast_part_mm);
  drawing::Document document(1120, 620);
  document.heading(40, "Pressure advance: how to read the lines",
                   fmt::format("{} lines, the lowest with {:g} s, each higher one with {:.4g} s more",
                               p.lines, p.from_s, (p.to_s - p.from_s) / (p.lines - 1)));
  const double up = kLeft + scale * p.slow_part_mm, down = up + scale * p.fast_part_mm, right = kLeft + 900;
  struct Case {
    const char* words;
    double error;  ///< of the advance: below 0 too little
  };
  // An exponential lack behind the speeding up, a surplus behind the slowing down.
  constexpr std::array<Case, 3> kCases = {
      {{"too little: thin behind the speeding up, thick behind the slowing down", -1},
       {"right: the same width everywhere", 0},
       {"too much: thick behind the speeding up, thin behind the slowing down", 1}}};
  double y = kTop;
  for (const Case& c : kCases) {
    document.text({kLeft, y - 26}, c.words, {.size = 15, .bold = true});
    std::vector<Point> top, bottom;
    for (double x = kLeft; x <= right; x += 2) {
      double width = 1;
      if (x > up && x < down) width += 0.55 * c.error * std::exp((up - x) / (4 * scale));
      if (x > down) width -= 0.7 * c.error * std::exp((down - x) / (2.5 * scale));
      top.push_back({x, y - 11 * width});
      bottom.push_back({x, y + 11 * width});
    }
    top.insert(top.end(), bottom.rbegin(), bottom.rend());
    document.polygon(top, {.fill = kBead});
    y += kRow;
  }
  const double low = y - kRow + 30;
  for (const double x : {up, down})
    document.line({x, kTop - 20}, {x, low + 8}, {.stroke = drawing::kMuted, .width = 1, .dash = "4 4"});
  const auto words = [&](double x, double at_y, const std::string& what) {
    document.text({x, at_y}, what, {.size = 13, .anchor = drawing::Anchor::kMiddle, .fill = drawing::kMuted});
  };
  words(0.5 * (kLeft + up), low + 24, fmt::format("{:g} mm/s", p.slow_mm_per_s));
  words(0.5 * (up + down), low + 24, fmt::format("{:g} mm/s", p.fast_mm_per_s));
  words(0.5 * (down + right), low + 24, fmt::format("{:g} mm/s", p.slow_mm_per_s));
  const auto place = [&](double from_mm, const std::string& name) {
    const double x = kLeft + scale * (from_mm - p.left_mm());
    document.rectangle({x, low + 36, scale * kWidthOver_mm, 10}, {.fill = kPlace});
    document.text({x, low + 66}, name, {.size = 13, .fill = kPlace});
  };
  place(p.speeds_up_mm(), "faster_mm: mean width here");
  place(p.slows_down_mm() - kBrakes_mm, "slower_mm: mean width here");
  const auto place_near = [&](double from_mm, const std::string& name) {
    const double x = kLeft + scale * (from_mm - p.left_mm());
    document.rectangle({x, low + 50, scale * kNear_mm, 5}, {.fill = kBead});
    document.text({x, low + 84}, name, {.size = 12, .fill = kBead});
  };
  place_near(p.speeds_up_mm() + kNearBehind_mm, "faster_near_mm: for the melt");
  place_near(p.slows_down_mm() - kNearBefore_mm, "slower_near_mm: for the melt");
  document.text({kLeft, low + 104},
                "By eye: take the advance of the evenest line. By measuring: a table "
                "advance_s,faster_mm,slower_mm of all lines;",
                {.size = 14});
  document.text({kLeft, low + 124},
                "kinebus tune pressure --widths TABLE.csv finds where both widths are the same.",
                {.size = 14});
  return document.svg();
}

}  // namespace kinebus
