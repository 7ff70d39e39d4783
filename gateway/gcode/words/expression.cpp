#include "gateway/gcode/words/expression.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "gateway/gcode/letters.hpp"
#include "gateway/gcode/number.hpp"
#include "gateway/gcode/words/meta_expression.hpp"
#include "gateway/gcode/words/parameters.hpp"

namespace kinebus::gcode {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kEqualTolerance = 1e-4;

enum class Operator : std::uint8_t {
  kPower,
  kTimes,
  kDivide,
  kModulo,
  kPlus,
  kMinus,
  kEqual,
  kUnequal,
  kGreater,
  kGreaterEqual,
  kLess,
  kLessEqual,
  kAnd,
  kOr,
  kXor
};
struct OperatorName {
  std::string_view text;
  Operator op;
  int level;
};
// Longer names before their beginnings (** before *).
constexpr std::array<OperatorName, 15> kOperators = {{{"**", Operator::kPower, 5},
                                                      {"*", Operator::kTimes, 4},
                                                      {"/", Operator::kDivide, 4},
                                                      {"mod", Operator::kModulo, 4},
                                                      {"+", Operator::kPlus, 3},
                                                      {"-", Operator::kMinus, 3},
                                                      {"eq", Operator::kEqual, 2},
                                                      {"ne", Operator::kUnequal, 2},
                                                      {"gt", Operator::kGreater, 2},
                                                      {"ge", Operator::kGreaterEqual, 2},
                                                      {"lt", Operator::kLess, 2},
                                                      {"le", Operator::kLessEqual, 2},
                                                      {"and", Operator::kAnd, 1},
                                                      {"or", Operator::kOr, 1},
                                                      {"xor", Operator::kXor, 1}}};

enum class Function : std::uint8_t {
  kAbs,
  kAcos,
  kAsin,
  kAtan,
  kCos,
  kExists,
  kExp,
  kFix,
  kFup,
  kLn,
  kRound,
  kSin,
  kSqrt,
  kTan
};
struct FunctionName {
  std::string_view text;
  Function function;
};
constexpr std::array<FunctionName, 14> kFunctions = {{{"abs", Function::kAbs},
                                                      {"acos", Function::kAcos},
                                                      {"asin", Function::kAsin},
                                                      {"atan", Function::kAtan},
                                                      {"cos", Function::kCos},
                                                      {"exists", Function::kExists},
                                                      {"exp", Function::kExp},
                                                      {"fix", Function::kFix},
                                                      {"fup", Function::kFup},
                                                      {"ln", Function::kLn},
                                                      {"round", Function::kRound},
                                                      {"sin", Function::kSin},
                                                      {"sqrt", Function::kSqrt},
                                                      {"tan", Function::kTan}}};

bool matches(const Cursor& cursor, std::string_view text) {
  if (static_cast<std::size_t>(cursor.end - cursor.p) < text.size()) return false;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (in_lower_case(cursor.p[i]) != text[i]) return false;
  return true;
}

/// The function whose name and opening bracket stand at the cursor.
const FunctionName* function_at(const Cursor& cursor) {
  for (const FunctionName& entry : kFunctions) {
    if (!matches(cursor, entry.text)) continue;
    Cursor after{cursor.begin, cursor.p + entry.text.size(), cursor.end};
    if (after.accept('[')) return &entry;
  }
  return nullptr;
}

const OperatorName* operator_at(const Cursor& cursor) {
  for (const OperatorName& entry : kOperators)
    if (matches(cursor, entry.text)) return &entry;
  return nullptr;
}

double apply(Operator op, double left, double right) {
  switch (op) {
    case Operator::kPower:
      return std::pow(left, right);
    case Operator::kTimes:
      return left * right;
    case Operator::kDivide:
      return left / right;
    case Operator::kModulo: {
      // RS274/NGC: never below 0, whatever the signs.
      const double rest = std::fmod(left, right);
      return rest < 0 ? rest + std::abs(right) : rest;
    }
    case Operator::kPlus:
      return left + right;
    case Operator::kMinus:
      return left - right;
    case Operator::kEqual:
      return std::abs(left - right) < kEqualTolerance ? 1 : 0;
    case Operator::kUnequal:
      return std::abs(left - right) < kEqualTolerance ? 0 : 1;
    case Operator::kGreater:
      return left > right ? 1 : 0;
    case Operator::kGreaterEqual:
      return left >= right ? 1 : 0;
    case Operator::kLess:
      return left < right ? 1 : 0;
    case Operator::kLessEqual:
      return left <= right ? 1 : 0;
    case Operator::kAnd:
      return left != 0 && right != 0 ? 1 : 0;
    case Operator::kOr:
      return left != 0 || right != 0 ? 1 : 0;
    case Operator::kXor:
      return (left != 0) != (right != 0) ? 1 : 0;
  }
  return 0;
}

double call(Function function, double x) {
  switch (function) {
    case Function::kAbs:
      return std::abs(x);
    case Function::kAcos:
      return std::acos(x) * kDegrees;
    case Function::kAsin:
      return std::asin(x) * kDegrees;
    case Function::kCos:
      return std::cos(x / kDegrees);
    case Function::kExp:
      return std::exp(x);
    case Function::kFix:
      return std::floor(x);
    case Function::kFup:
      return std::ceil(x);
    case Function::kLn:
      return std::log(x);
    case Function::kRound:
      return std::round(x);
    case Function::kSin:
      return std::sin(x / kDegrees);
    case Function::kSqrt:
      return std::sqrt(x);
    case Function::kTan:
      return std::tan(x / kDegrees);
    case Function::kAtan:
    case Function::kExists:
      break;
  }
  return 0;
}

}  // namespace

bool ValueReader::fail(const char* at, Sentence message) {
  error_.column = cursor_.column_of(at);
  error_.message = std::move(message);
  return false;
}

bool ValueReader::starts_value() {
  cursor_.skip_blanks();
  if (cursor_.at_end()) return false;
  const char c = *cursor_.p;
  return (c >= '0' && c <= '9') || c == '.' || c == '+' || c == '-' || c == '#' || c == '[' || c == '{' ||
         function_at(cursor_) != nullptr;
}

bool ValueReader::read_value(double& value) {
  cursor_.skip_blanks();
  if (const char* after = parse_decimal(cursor_.p, cursor_.end, value)) {
    cursor_.p = after;
    return true;
  }
  bool negative = false;
  while (!cursor_.at_end() && (*cursor_.p == '-' || *cursor_.p == '+')) {
    negative = negative != (*cursor_.p == '-');
    ++cursor_.p;
    cursor_.skip_blanks();
  }
  const char* const start = cursor_.p;
  if (depth_ >= kMaxDepth) return fail(start, say("the expression is nested too deep (40 levels at most)"));
  ++depth_;
  bool good = true;
  if (const char* after = parse_decimal(cursor_.p, cursor_.end, value)) {
    cursor_.p = after;
  } else if (cursor_.accept('#')) {
    good = read_parameter(value);
  } else if (cursor_.accept('[')) {
    good = read_bracket(value);
  } else if (cursor_.accept('{')) {
    good = read_meta(value);
  } else if (function_at(cursor_) != nullptr) {
    good = read_function(value);
  } else {
    good = fail(start, say("expected a number, #parameter, [expression] or function"));
  }
  --depth_;
  if (negative) value = -value;
  return good;
}

bool ValueReader::read_bracket(double& value) {
  const char* const start = cursor_.p;
  if (!read_expression(1, value)) return false;
  if (!cursor_.accept(']')) return fail(cursor_.p, say("expected an operator or ]"));
  if (!std::isfinite(value)) return fail(start, say("the expression has no finite value"));
  return true;
}

/// {...}: an expression of RepRapFirmware.
bool ValueReader::read_meta(double& value) {
  if (!MetaReader(state_, cursor_, error_).read_number(value)) return false;
  return cursor_.accept('}') || fail(cursor_.p, say("expected an operator or %1", "}"));
}

bool ValueReader::read_expression(int lowest_level, double& value) {
  if (!read_value(value)) return false;
  for (;;) {
    cursor_.skip_blanks();
    const OperatorName* const entry = operator_at(cursor_);
    if (entry == nullptr || entry->level < lowest_level) return true;
    const char* const at = cursor_.p;
    cursor_.p += entry->text.size();
    double right = 0;
    if (!read_expression(entry->level + 1, right)) return false;
    if ((entry->op == Operator::kDivide || entry->op == Operator::kModulo) && right == 0)
      return fail(at, say("division by zero"));
    value = apply(entry->op, value, right);
    if (!std::isfinite(value)) return fail(at, say("the operation has no finite result"));
  }
}

bool ValueReader::read_function(double& value) {
  const char* const start = cursor_.p;
  const FunctionName* const entry = function_at(cursor_);
  cursor_.p += entry->text.size();
  cursor_.accept('[');
  if (entry->function == Function::kExists) return read_exists(value);
  if (!read_bracket(value)) return false;
  if (entry->function == Function::kAtan) return read_arc_tangent(start, value);
  value = call(entry->function, value);
  if (!std::isfinite(value))
    return fail(start, say("%1 is not defined for this value", std::string(entry->text)));
  return true;
}

bool ValueReader::read_arc_tangent(const char* start, double& value) {
  double other = 0;
  if (!cursor_.accept('/') || !cursor_.accept('[')) return fail(start, say("atan is written atan[y]/[x]"));
  if (!read_bracket(other)) return false;
  if (value == 0 && other == 0) return fail(start, say("atan[0]/[0] is not defined"));
  value = std::atan2(value, other) * kDegrees;
  return true;
}

bool ValueReader::read_exists(double& value) {
  ParameterRef ref;
  if (!cursor_.accept('#')) return fail(cursor_.p, say("exists is written exists[#<name>]"));
  if (!read_parameter_ref(ref, true)) return false;
  if (!cursor_.accept(']')) return fail(cursor_.p, say("expected ]"));
  value = (ref.index != 0 && parameter_use(ref.index) != ParameterUse::kNone) ||
                  read_named(state_, ref.name).has_value()
              ? 1
              : 0;
  return true;
}

bool ValueReader::read_parameter_ref(ParameterRef& ref, bool may_be_none) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  if (cursor_.accept('<')) {
    while (!cursor_.at_end() && *cursor_.p != '>') {
      const char c = in_lower_case(*cursor_.p++);
      if (c == ' ' || c == '\t') continue;
      if (c <= ' ' || c >= 0x7F || c == '#' || c == '<')
        return fail(cursor_.p - 1, say("a parameter's name is made of letters, digits, _ and -"));
      if (ref.name.size() >= ParameterState::kMaxNameLength)
        return fail(start, say("the parameter's name is too long (64 letters at most)"));
      ref.name.push_back(c);
    }
    if (!cursor_.accept('>')) return fail(start, say("the parameter's name needs a closing >"));
    if (ref.name.empty()) return fail(start, say("the parameter's name is empty"));
    return true;
  }
  double number = 0;
  if (!read_value(number)) return false;
  if (std::abs(number) > 1e6 || std::abs(number - std::round(number)) > kEqualTolerance)
    return fail(start, say("a parameter's number must be a whole number from 1 to 5602"));
  ref.index = static_cast<int>(std::lround(number));
  if (!may_be_none && parameter_use(ref.index) == ParameterUse::kNone)
    return fail(start, say("there is no parameter #%1; they are #1 to #5602", ref.index));
  return true;
}

bool ValueReader::read_parameter(double& value) {
  const char* const start = cursor_.p;
  ParameterRef ref;
  if (!read_parameter_ref(ref)) return false;
  if (ref.index != 0) {
    value = gcode::read_parameter(state_, ref.index);
    return true;
  }
  const auto named = read_named(state_, ref.name);
  if (!named) return fail(start, say("#<%1> has no value yet", ref.name));
  value = *named;
  return true;
}

}  // namespace kinebus::gcode
