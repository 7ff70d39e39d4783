#include "gateway/gcode/words/meta_expression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace kinebus::gcode {
namespace {

enum class Operator : std::uint8_t {
  kJoin,
  kAnd,
  kOr,
  kLess,
  kLessEqual,
  kGreater,
  kGreaterEqual,
  kEqual,
  kUnequal,
  kPlus,
  kMinus,
  kTimes,
  kDivide
};
struct OperatorName {
  std::string_view text;
  Operator op;
  int level;
};
// Longer names before their beginnings.
constexpr std::array<OperatorName, 16> kOperators = {{{"&&", Operator::kAnd, 2},
                                                      {"||", Operator::kOr, 2},
                                                      {"<=", Operator::kLessEqual, 3},
                                                      {">=", Operator::kGreaterEqual, 3},
                                                      {"==", Operator::kEqual, 3},
                                                      {"!=", Operator::kUnequal, 3},
                                                      {"^", Operator::kJoin, 1},
                                                      {"&", Operator::kAnd, 2},
                                                      {"|", Operator::kOr, 2},
                                                      {"<", Operator::kLess, 3},
                                                      {">", Operator::kGreater, 3},
                                                      {"=", Operator::kEqual, 3},
                                                      {"+", Operator::kPlus, 4},
                                                      {"-", Operator::kMinus, 4},
                                                      {"*", Operator::kTimes, 5},
                                                      {"/", Operator::kDivide, 5}}};

const OperatorName* operator_at(const Cursor& cursor) {
  const std::string_view rest(cursor.p, static_cast<std::size_t>(cursor.end - cursor.p));
  for (const OperatorName& entry : kOperators)
    if (rest.starts_with(entry.text)) return &entry;
  return nullptr;
}

bool same(const MetaValue& a, const MetaValue& b) {
  const auto* x = std::get_if<double>(&a);
  const auto* y = std::get_if<double>(&b);
  if (x == nullptr || y == nullptr) return a == b;
  return std::abs(*x - *y) <= 1e-9 * std::max({1.0, std::abs(*x), std::abs(*y)});
}

}  // namespace

std::string shown_value(const MetaValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "true" : "false";
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr) return "null";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.9g", *number);
  return text.data();
}

bool MetaReader::fail(const char* at, Sentence message) {
  error_.column = cursor_.column_of(at);
  error_.message = std::move(message);
  return false;
}

bool MetaReader::number(const char* at, const MetaValue& value, double& result) {
  const auto* found = std::get_if<double>(&value);
  if (found == nullptr) return fail(at, say("expected a number, not %1", shown_value(value)));
  result = *found;
  return true;
}

bool MetaReader::read(MetaValue& value) {
  return read_choice(value, true);
}

bool MetaReader::read_number(double& value) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  MetaValue found;
  return read(found) && number(start, found, value);
}

bool MetaReader::read_condition(bool& value) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  MetaValue found;
  if (!read(found)) return false;
  const auto* truth = std::get_if<bool>(&found);
  if (truth == nullptr)
    return fail(start, say("expected a condition (true or false), not %1", shown_value(found)));
  value = *truth;
  return true;
}

/// `counts`: false for what another operand has decided already: it is read, and need not have a value.
bool MetaReader::read_choice(MetaValue& value, bool counts) {
  cursor_.skip_blanks();
  const char* const start = cursor_.p;
  if (depth_ >= kMaxDepth) return fail(start, say("the expression is nested too deep (40 levels at most)"));
  ++depth_;
  bool good = read_joined(1, value, counts);
  if (good && cursor_.accept('?')) {
    const auto* truth = std::get_if<bool>(&value);
    if (counts && truth == nullptr) {
      good = fail(start, say("expected a condition (true or false), not %1", shown_value(value)));
    } else {
      const bool first = counts && *truth;
      MetaValue a, b;
      good = read_choice(a, first) && (cursor_.accept(':') || fail(cursor_.p, say("expected %1", ":"))) &&
             read_choice(b, counts && !first);
      if (good) value = first ? std::move(a) : std::move(b);
    }
  }
  --depth_;
  return good;
}

bool MetaReader::read_joined(int lowest_level, MetaValue& value, bool counts) {
  cursor_.skip_blanks();
  const char* left_at = cursor_.p;
  if (!read_operand(value, counts)) return false;
  for (;;) {
    cursor_.skip_blanks();
    const OperatorName* const entry = operator_at(cursor_);
    if (entry == nullptr || entry->level < lowest_level) return true;
    const char* const at = cursor_.p;
    cursor_.p += entry->text.size();
    const bool logical = entry->op == Operator::kAnd || entry->op == Operator::kOr;
    const auto* truth = std::get_if<bool>(&value);
    if (counts && logical && truth == nullptr)
      return fail(left_at, say("expected a condition (true or false), not %1", shown_value(value)));
    const bool decided = logical && counts && *truth == (entry->op == Operator::kOr);
    cursor_.skip_blanks();
    const char* const right_at = cursor_.p;
    MetaValue right;
    if (!read_joined(entry->level + 1, right, counts && !decided)) return false;
    if (!counts || decided) continue;
    double a = 0, b = 0;
    switch (entry->op) {
      case Operator::kJoin: {
        std::string text = shown_value(value) + shown_value(right);
        if (text.size() > kMaxText) return fail(at, say("the text is too long (500 letters at most)"));
        value = std::move(text);
        continue;
      }
      case Operator::kAnd:
      case Operator::kOr:
        if (!std::holds_alternative<bool>(right))
          return fail(right_at, say("expected a condition (true or false), not %1", shown_value(right)));
        value = std::move(right);
        continue;
      case Operator::kEqual:
        value = same(value, right);
        continue;
      case Operator::kUnequal:
        value = !same(value, right);
        continue;
      default:
        break;
    }
    if (!number(left_at, value, a) || !number(right_at, right, b)) return false;
    switch (entry->op) {
      case Operator::kLess:
        value = a < b;
        break;
      case Operator::kLessEqual:
        value = a <= b;
        break;
      case Operator::kGreater:
        value = a > b;
        break;
      case Operator::kGreaterEqual:
        value = a >= b;
        break;
      default: {
        if (entry->op == Operator::kDivide && b == 0) return fail(at, say("division by zero"));
        const double result = entry->op == Operator::kPlus    ? a + b
                              : entry->op == Operator::kMinus ? a - b
                              : entry->op == Operator::kTimes ? a * b
                                                              : a / b;
        if (!std::isfinite(result)) return fail(at, say("the operation has no finite result"));
        value = result;
      }
    }
  }
}

}  // namespace kinebus::gcode
