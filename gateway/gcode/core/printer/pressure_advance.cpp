// M900 K, M572 S, SET_PRESSURE_ADVANCE.
#include <cmath>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kMostAdvance_s = 2, kMostSmooth_s = 0.2;

/// The number behind S; none: there is none.
std::optional<double> value_of_s(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (in_lower_case(text[i]) != 's') continue;
    double value = 0;
    if (parse_decimal(text.data() + i + 1, text.data() + text.size(), value) != nullptr) return value;
  }
  return std::nullopt;
}

}  // namespace

bool Core::set_pressure_advance(std::uint32_t column, std::optional<double> advance_s,
                                std::optional<double> smooth_s) {
  if (advance_s && !(*advance_s >= 0 && *advance_s <= kMostAdvance_s))
    return fail(column, say("pressure advance of %1 s; allowed are 0 to %2 s", printed("%.6g", *advance_s),
                            printed("%.6g", kMostAdvance_s)));
  if (smooth_s && !(*smooth_s >= 0 && *smooth_s <= kMostSmooth_s))
    return fail(column, say("pressure advance averaged over %1 s; allowed are 0 to %2 s",
                            printed("%.6g", *smooth_s), printed("%.6g", kMostSmooth_s)));
  if (advance_s || smooth_s) emit(canonical::PressureAdvance{advance_s.value_or(-1), smooth_s.value_or(-1)});
  return true;
}

/// Without a value they tell the one in force to those who ask: nothing to carry out.
bool Core::pressure_advance(Code code) {
  std::optional<double> advance_s;
  std::uint32_t column = code.column;
  if (code.number == 572) {
    advance_s = value_of_s(block_.text);
  } else {
    if (has('K')) {
      column = block_.column_of('K');
      advance_s.emplace();
      if (!take('K', *advance_s)) return false;
    }
    for (const char letter : {'T', 'L', 'S'}) pass_over(letter);
  }
  if (code.number == 900 && advance_s && *advance_s > kMostAdvance_s && !options_.spindle) {
    note(code.number,
         say("K%1 is on the scale of linear advance 1.0 (Marlin before 1.1.9), which says nothing in "
             "seconds: write K in s, 0 to %2, or leave it to advance_s in [pressure_advance]",
             printed("%.6g", *advance_s), printed("%.6g", kMostAdvance_s)));
    return true;
  }
  if (advance_s && !options_.spindle) return set_pressure_advance(column, advance_s, std::nullopt);
  note(code.number, say("%1 has no effect on this machine", m_name(code.number)));
  return true;
}

}  // namespace kinebus::gcode
