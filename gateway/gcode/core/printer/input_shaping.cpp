// M593 (Marlin's and RepRapFirmware's), SET_INPUT_SHAPER (Klipper's).
#include <array>

#include "gateway/gcode/core/core.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"

namespace kinebus::gcode {
namespace {

using canonical::InputShaping;

constexpr double kLeast_hz = 1, kMost_hz = 500, kMostDamping = 0.5;
constexpr std::string_view kShapedAxes = "xyz";

struct ShaperName {
  std::string_view name;  ///< lower case
  ShaperKind kind;
};
// Klipper's and RepRapFirmware's, and the machine file's.
constexpr std::array<ShaperName, 13> kShaperNames = {{{"none", ShaperKind::kNone},
                                                      {"zv", ShaperKind::kZv},
                                                      {"mzv", ShaperKind::kMzv},
                                                      {"zvd", ShaperKind::kZvd},
                                                      {"zvdd", ShaperKind::kZvdd},
                                                      {"zvddd", ShaperKind::kZvddd},
                                                      {"ei", ShaperKind::kEi},
                                                      {"ei2", ShaperKind::kTwoHump},
                                                      {"2hump", ShaperKind::kTwoHump},
                                                      {"2hump_ei", ShaperKind::kTwoHump},
                                                      {"ei3", ShaperKind::kThreeHump},
                                                      {"3hump", ShaperKind::kThreeHump},
                                                      {"3hump_ei", ShaperKind::kThreeHump}}};

std::optional<ShaperKind> shaper_named(std::string_view text) {
  const std::string name = in_lower_case(text);
  for (const ShaperName& known : kShaperNames)
    if (known.name == name) return known.kind;
  return std::nullopt;
}

Sentence unknown_shaper(std::string_view name) {
  return say(
      "there is no shaper %1; known are none, zv, mzv, zvd, zvdd, zvddd, ei, ei2 (2hump_ei), ei3 (3hump_ei)",
      std::string(name));
}

/// What is wrong with the values of one axis; none: nothing.
std::optional<Sentence> wrong_values(const InputShaping::Axis& axis) {
  if (axis.frequency_hz != -1 && axis.frequency_hz != 0 &&
      !(axis.frequency_hz >= kLeast_hz && axis.frequency_hz <= kMost_hz))
    return say("a shaper for %1 Hz; allowed are %2 to %3 Hz, or 0 for none",
               printed("%.6g", axis.frequency_hz), printed("%.6g", kLeast_hz), printed("%.6g", kMost_hz));
  if (axis.damping_ratio != -1 && !(axis.damping_ratio >= 0 && axis.damping_ratio <= kMostDamping))
    return say("a shaper for a damping ratio of %1; allowed are 0 to %2", printed("%.6g", axis.damping_ratio),
               printed("%.6g", kMostDamping));
  return std::nullopt;
}

/// The words of a line: letters with a number, a quoted text, or nothing behind them.
struct LineWord {
  char letter = 0;  ///< lower case
  std::optional<double> value;
  std::string_view text;  ///< what was quoted
};

/// The next word of `text` from `at` on; none: there is none.
std::optional<LineWord> next_word(std::string_view text, std::size_t& at) {
  while (at < text.size() && (text[at] == ' ' || text[at] == '\t' || text[at] == '\r')) ++at;
  if (at == text.size() || text[at] == ';' || text[at] == '*' || text[at] == '(') return std::nullopt;
  LineWord word{in_lower_case(text[at++]), {}, {}};
  if (at < text.size() && text[at] == '"') {
    const std::size_t end = std::min(text.find('"', at + 1), text.size());
    word.text = text.substr(at + 1, end - at - 1);
    at = std::min(end + 1, text.size());
    return word;
  }
  double value = 0;
  const char* const after = parse_decimal(text.data() + at, text.data() + text.size(), value);
  if (after != nullptr && after != text.data() + at) {
    word.value = value;
    at = static_cast<std::size_t>(after - text.data());
  }
  return word;
}

}  // namespace

/// Without a value it tells the one in force to those who ask: nothing to carry out.
bool Core::input_shaping() {
  InputShaping::Axis asked;
  asked.usual = rules_->dialect == Dialect::kMarlin ? ShaperKind::kZv : ShaperKind::kMzv;
  std::array<bool, kShapedAxes.size()> named{};
  const std::string_view text = block_.text;
  for (std::size_t at = 0;;) {
    const auto word = next_word(text, at);
    if (!word) break;
    const std::uint32_t column = block_.text_column;
    const std::string letter(1, static_cast<char>(word->letter - 'a' + 'A'));
    if (const std::size_t axis = kShapedAxes.find(word->letter); axis != std::string_view::npos) {
      named[axis] = true;
    } else if (word->letter == 'p') {
      asked.shaper = shaper_named(word->text);
      if (!asked.shaper) return fail(column, unknown_shaper(word->text));
    } else if (word->letter == 'f' || word->letter == 'd' || word->letter == 's') {
      if (!word->value) return fail(column, say("%1 needs a number", letter));
      (word->letter == 'f' ? asked.frequency_hz : asked.damping_ratio) = *word->value;
    } else if (word->letter != 'l') {
      return fail(column,
                  say("%1 with %2 is not supported: X Y Z, F in Hz, D or S for the damping, P\"shaper\"",
                      "M593", letter));
    }
  }
  if (auto wrong = wrong_values(asked)) return fail(block_.text_column, std::move(*wrong));
  if (!asked.asks()) return true;
  const bool all = named == std::array<bool, kShapedAxes.size()>{};
  InputShaping shaping;
  for (std::size_t i = 0; i < named.size(); ++i)
    if (all || named[i]) shaping.axes[i] = asked;
  emit(shaping);
  return true;
}

bool Core::set_input_shaper(std::uint32_t column, std::span<const ShaperWord> words) {
  constexpr std::string_view kFrequency = "shaper_freq", kDamping = "damping_ratio", kType = "shaper_type";
  InputShaping shaping;
  for (InputShaping::Axis& axis : shaping.axes) axis.usual = ShaperKind::kMzv;
  bool asks = false;
  for (const ShaperWord& word : words) {
    std::string_view key = word.name;
    std::size_t first = 0, behind = 2;  // without an axis: X and Y
    if (key.size() > 2 && key[key.size() - 2] == '_') {
      first = kShapedAxes.find(key.back());
      behind = first + 1;
      if (first != std::string_view::npos) key.remove_suffix(2);
    }
    if (first == std::string_view::npos || (key != kFrequency && key != kDamping && key != kType))
      return fail(
          column,
          say("%1 knows no %2: SHAPER_TYPE, SHAPER_FREQ and DAMPING_RATIO, with _X, _Y or _Z behind them",
              "SET_INPUT_SHAPER", in_upper_case(word.name)));
    const auto kind = shaper_named(word.text);
    if (key == kType && !kind) return fail(column, unknown_shaper(word.text));
    if (key != kType && !word.value) return fail(column, say("%1 needs a number", in_upper_case(word.name)));
    asks = true;
    for (std::size_t i = first; i < behind; ++i) {
      InputShaping::Axis& axis = shaping.axes[i];
      if (key == kType) axis.shaper = kind;
      if (key == kFrequency) axis.frequency_hz = *word.value;
      if (key == kDamping) axis.damping_ratio = *word.value;
      if (auto wrong = wrong_values(axis)) return fail(column, std::move(*wrong));
    }
  }
  if (asks) emit(shaping);
  return true;
}

}  // namespace kinebus::gcode
