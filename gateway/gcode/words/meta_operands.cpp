// Values, names and functions in expressions of RepRapFirmware.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"
#include "gateway/gcode/words/meta_expression.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

bool is_letter(char c) {
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

using Function = double (*)(double);
struct FunctionName {
  std::string_view name;
  Function function;
};
constexpr std::array<FunctionName, 14> kFunctions = {
    {{"abs", [](double x) { return std::abs(x); }},
     {"acos", [](double x) { return std::acos(x); }},
     {"asin", [](double x) { return std::asin(x); }},
     {"atan", [](double x) { return std::atan(x); }},
     {"ceil", [](double x) { return std::ceil(x); }},
     {"cos", [](double x) { return std::cos(x); }},
     {"degrees", [](double x) { return x * 180 / std::numbers::pi; }},
     {"exp", [](double x) { return std::exp(x); }},
     {"floor", [](double x) { return std::floor(x); }},
     {"log", [](double x) { return std::log(x); }},
     {"radians", [](double x) { return x * std::numbers::pi / 180; }},
     {"sin", [](double x) { return std::sin(x); }},
     {"sqrt", [](double x) { return std::sqrt(x); }},
     {"tan", [](double x) { return std::tan(x); }}}};

const MetaVariable* find_variable(const std::vector<MetaVariable>& all, std::string_view name) {
  for (const MetaVariable& variable : all)
    if (variable.name == name) return &variable;
  return nullptr;
}

}  // namespace

bool MetaReader::read_operand(MetaValue& value, bool counts) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  if (cursor_.at_end()) return fail(start, say("expected a value"));
  const char c = *start;
  double read = 0;
  if (is_digit(c) || c == '.') {
    const char* const after = parse_decimal(start, cursor_.end, read);
    if (after == nullptr) return fail(start, say("expected a value"));
    cursor_.p = after;
    value = read;
    return true;
  }
  if (c == '"') return read_text(value);
  if (is_letter(c)) return read_named(value, counts);
  if (depth_ >= kMaxDepth) return fail(start, say("the expression is nested too deep (40 levels at most)"));
  ++depth_;
  bool good = true;
  ++cursor_.p;
  if (c == '(' || c == '{' || c == '[') {
    const char close = c == '(' ? ')' : c == '{' ? '}' : ']';
    good =
        read_choice(value, counts) &&
        (cursor_.accept(close) || fail(cursor_.p, say("expected an operator or %1", std::string(1, close))));
  } else if (c == '!') {
    good = read_operand(value, counts);
    if (good && counts) {
      const auto* truth = std::get_if<bool>(&value);
      if (truth == nullptr)
        good = fail(start, say("expected a condition (true or false), not %1", shown_value(value)));
      else
        value = !*truth;
    }
  } else if (c == '-' || c == '+') {
    good = read_operand(value, counts);
    if (good && counts) {
      good = number(start, value, read);
      value = c == '-' ? -read : read;
    }
  } else if (c == '#') {
    cursor_.skip_blanks();
    if (!cursor_.at_end() && is_letter(*cursor_.p)) {
      const char* const name_at = cursor_.p;
      std::string path;
      good = read_path(name_at, path, counts);
      const int count = good ? model_count(state_, path) : -1;
      if (good && count >= 0) {
        value = static_cast<double>(count);
        --depth_;
        return true;
      }
      cursor_.p = name_at;
    }
    good = good && read_operand(value, counts);
    if (good && counts) {
      const auto* text = std::get_if<std::string>(&value);
      if (text == nullptr)
        good = fail(start, say("# counts the letters of a text, or a list of the object model"));
      else
        value = static_cast<double>(text->size());
    }
  } else {
    cursor_.p = start;
    good = fail(start, say("expected a value"));
  }
  --depth_;
  return good;
}

bool MetaReader::read_text(MetaValue& value) {
  const char* const start = cursor_.p++;
  std::string text;
  for (;;) {
    if (cursor_.at_end()) return fail(start, say("the text needs a closing quotation mark"));
    const char c = *cursor_.p++;
    // Two of them stand for one.
    if (c == '"') {
      if (cursor_.at_end() || *cursor_.p != '"') break;
      ++cursor_.p;
    }
    if (text.size() >= kMaxText) return fail(start, say("the text is too long (500 letters at most)"));
    text += c;
  }
  value = std::move(text);
  return true;
}

bool MetaReader::read_name(std::string& name) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  name.clear();
  if (!cursor_.at_end() && is_letter(*cursor_.p))
    while (!cursor_.at_end() && (is_letter(*cursor_.p) || is_digit(*cursor_.p))) name += *cursor_.p++;
  if (name.empty()) return fail(start, say("expected a name: letters, digits and _"));
  if (name.size() > ParameterState::kMaxNameLength)
    return fail(start, say("the name is too long (64 letters at most)"));
  return true;
}

/// "move.axes[0].homed": what stands in [ ] is read as an expression.
bool MetaReader::read_path(const char* start, std::string& path, bool counts) {
  if (!read_name(path)) return false;
  while (!cursor_.at_end() && (*cursor_.p == '.' || *cursor_.p == '[')) {
    if (path.size() > 200) return fail(start, say("the name is too long (64 letters at most)"));
    if (*cursor_.p == '.') {
      ++cursor_.p;
      std::string part;
      if (!read_name(part)) return false;
      path += "." + part;
      continue;
    }
    const char* const at = ++cursor_.p;
    MetaValue index;
    double number_of = 0;
    if (!read_choice(index, counts)) return false;
    if (!cursor_.accept(']')) return fail(cursor_.p, say("expected an operator or %1", "]"));
    if (!counts) continue;
    if (!number(at, index, number_of)) return false;
    if (!(number_of >= 0 && number_of < 1000) || number_of != std::floor(number_of))
      return fail(at, say("an index is a whole number from 0"));
    path += "[" + std::to_string(static_cast<int>(number_of)) + "]";
  }
  return true;
}

bool MetaReader::call(const char* start, const std::string& name, MetaValue& value, bool counts) {
  if (name == "exists") return exists(value);
  std::vector<double> arguments;
  do {
    MetaValue each;
    double of = 0;
    cursor_.skip_blanks();
    const char* const at = cursor_.p;
    if (!read_choice(each, counts)) return false;
    if (counts && !number(at, each, of)) return false;
    if (arguments.size() >= 16) return fail(at, say("a function has 16 arguments at most"));
    arguments.push_back(of);
  } while (cursor_.accept(','));
  if (!cursor_.accept(')')) return fail(cursor_.p, say("expected an operator or %1", ")"));
  std::optional<double> result;
  if (name == "max") result = *std::max_element(arguments.begin(), arguments.end());
  if (name == "min") result = *std::min_element(arguments.begin(), arguments.end());
  if (arguments.size() == 2) {
    const double a = arguments[0], b = arguments[1];
    if (name == "mod" && b == 0 && counts) return fail(start, say("division by zero"));
    if (name == "mod") result = b == 0 ? 0 : std::fmod(a, b);
    if (name == "pow") result = std::pow(a, b);
    if (name == "atan2") result = std::atan2(a, b);
  }
  if (arguments.size() == 1) {
    if (name == "isnan") {
      value = false;  // what has no value is refused
      return true;
    }
    for (const FunctionName& entry : kFunctions)
      if (name == entry.name) result = entry.function(arguments[0]);
  }
  if (!result) return fail(start, say("there is no function %1 of %2 values", name, arguments.size()));
  if (counts && !std::isfinite(*result)) return fail(start, say("%1 is not defined for this value", name));
  value = *result;
  return true;
}

bool MetaReader::exists(MetaValue& value) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  std::string path;
  if (!read_path(start, path, true)) return false;
  if (!cursor_.accept(')')) return fail(cursor_.p, say("expected an operator or %1", ")"));
  Sentence why;
  MetaValue found;
  const std::string_view name = path;
  if (name.starts_with("var."))
    value = find_variable(state_.parameters.meta_locals, name.substr(4)) != nullptr;
  else if (name.starts_with("global."))
    value = find_variable(state_.parameters.meta_globals, name.substr(7)) != nullptr;
  else if (name.starts_with("param."))
    value = gcode::read_named(state_, in_lower_case(name.substr(6))).has_value();
  else
    value = read_model(state_, path, found, why);
  return true;
}

bool MetaReader::read_named(MetaValue& value, bool counts) {
  const char* const start = cursor_.p;
  std::string path;
  if (!read_path(start, path, counts)) return false;
  if (path.find('.') == std::string::npos && cursor_.accept('(')) {
    if (depth_ >= kMaxDepth) return fail(start, say("the expression is nested too deep (40 levels at most)"));
    ++depth_;
    const bool good = call(start, path, value, counts);
    --depth_;
    return good;
  }
  if (path == "true" || path == "false") {
    value = path == "true";
    return true;
  }
  value = std::monostate{};
  if (path == "null" || !counts) return true;
  if (path == "pi") {
    value = std::numbers::pi;
    return true;
  }
  if (path == "iterations") {
    if (state_.parameters.iterations < 0) return fail(start, say("iterations has a value in a loop alone"));
    value = state_.parameters.iterations;
    return true;
  }
  const std::string_view name = path;
  const bool local = name.starts_with("var."), global = name.starts_with("global.");
  if (local || global) {
    const MetaVariable* const variable = find_variable(
        local ? state_.parameters.meta_locals : state_.parameters.meta_globals, name.substr(local ? 4 : 7));
    if (variable == nullptr) return fail(start, say("%1 has no value yet", path));
    value = variable->value;
    return true;
  }
  if (name.starts_with("param.")) {
    const auto given = gcode::read_named(state_, in_lower_case(name.substr(6)));
    if (!given) return fail(start, say("the call gives no %1", path));
    value = *given;
    return true;
  }
  Sentence why;
  return read_model(state_, path, value, why) || fail(start, std::move(why));
}

}  // namespace kinebus::gcode
