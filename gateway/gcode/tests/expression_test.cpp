// Expressions against a reference that computes the same random tree while it writes the text.

#include "gateway/gcode/words/expression.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>

#include "gateway/gcode/tests/test_support.hpp"

namespace kinebus::gcode {
namespace {

std::string error_of(const std::string& text) {
  const auto state = std::make_unique<State>();
  Cursor cursor{text.data(), text.data(), text.data() + text.size()};
  SyntaxError error;
  double value = 0;
  return ValueReader(*state, cursor, error).read_value(value) && cursor.at_end() ? "" : error.message + " ";
}

double value_of(const std::string& text, const State& state = {}) {
  Cursor cursor{text.data(), text.data(), text.data() + text.size()};
  SyntaxError error;
  double value = 0;
  EXPECT_TRUE(ValueReader(state, cursor, error).read_value(value)) << text << ": " << error.message;
  EXPECT_TRUE(cursor.at_end()) << text;
  return value;
}

/// A random expression: text, value, and the level of its outermost operator (6: needs no brackets).
struct Sample {
  std::string text;
  double value = 0;
  int level = 6;
  double largest = 0;  ///< of all values inside
};

struct BinaryOperator {
  const char* text;
  int level;
  double (*apply)(double, double);
};
constexpr std::array<BinaryOperator, 13> kBinary = {{
    {" ** ", 5, [](double a, double b) { return std::pow(a, b); }},
    {"*", 4, [](double a, double b) { return a * b; }},
    {"/", 4, [](double a, double b) { return a / b; }},
    {" MOD ", 4, [](double a, double b) { return a - (b > 0 ? std::floor(a / b) : std::ceil(a / b)) * b; }},
    {"+", 3, [](double a, double b) { return a + b; }},
    {" - ", 3, [](double a, double b) { return a - b; }},
    {" gt ", 2, [](double a, double b) { return a > b ? 1.0 : 0.0; }},
    {" LE ", 2, [](double a, double b) { return a <= b ? 1.0 : 0.0; }},
    {" eq ", 2, [](double a, double b) { return std::abs(a - b) < 1e-4 ? 1.0 : 0.0; }},
    {"NE", 2, [](double a, double b) { return std::abs(a - b) < 1e-4 ? 0.0 : 1.0; }},
    {" and ", 1, [](double a, double b) { return a != 0 && b != 0 ? 1.0 : 0.0; }},
    {" or ", 1, [](double a, double b) { return a != 0 || b != 0 ? 1.0 : 0.0; }},
    {" xor ", 1, [](double a, double b) { return (a != 0) != (b != 0) ? 1.0 : 0.0; }},
}};

TEST(Expression, ModuloIsNeverNegative) {
  const State state;
  for (const auto& [text, expected] : {std::pair{"[7 MOD 3]", 1.0},
                                       {"[-7 MOD 3]", 2.0},
                                       {"[7 MOD -3]", 1.0},
                                       {"[-7 MOD -3]", 2.0},
                                       {"[-6 MOD 3]", 0.0},
                                       {"[5.5 MOD -2]", 1.5}}) {
    const std::string_view line = text;
    Cursor cursor{line.data(), line.data(), line.data() + line.size()};
    SyntaxError error;
    double value = 0;
    ASSERT_TRUE(ValueReader(state, cursor, error).read_value(value)) << text;
    EXPECT_NEAR(value, expected, 1e-12) << text;
  }
}

struct UnaryFunction {
  const char* text;
  double (*apply)(double);
};
constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr std::array<UnaryFunction, 8> kUnary = {{
    {"abs", [](double x) { return std::abs(x); }},
    {"SIN", [](double x) { return std::sin(x * kRadPerDegree); }},
    {"cos ", [](double x) { return std::cos(x * kRadPerDegree); }},
    {"fix", [](double x) { return std::floor(x); }},
    {"FUP", [](double x) { return std::ceil(x); }},
    {"round", [](double x) { return std::round(x); }},
    {"-", [](double x) { return -x; }},
    {"+", [](double x) { return x; }},
}};

Sample random_expression(std::mt19937& random, int depth) {
  const auto below = [&random](unsigned n) { return random() % n; };
  if (depth == 0 || below(5) == 0) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3f", static_cast<double>(below(20000)) / 1000);
    return {text.data(), std::strtod(text.data(), nullptr), 6, 0};
  }
  if (below(4) == 0) {
    const Sample inner = random_expression(random, depth - 1);
    const UnaryFunction& function = kUnary[below(kUnary.size())];
    return {function.text + ("[" + inner.text + "]"), function.apply(inner.value), 6, inner.largest};
  }
  const Sample left = random_expression(random, depth - 1), right = random_expression(random, depth - 1);
  const BinaryOperator& op = kBinary[below(kBinary.size())];
  const auto bracketed = [](const Sample& s, bool need) { return need ? "[" + s.text + "]" : s.text; };
  // Only the brackets that precedence and reading from the left make necessary.
  std::string text = bracketed(left, left.level < op.level);
  text += op.text;
  text += bracketed(right, right.level <= op.level);
  const double value = op.apply(left.value, right.value);
  return {text, value, op.level, std::max({left.largest, right.largest, std::abs(value)})};
}

TEST(Expression, RandomTreesHaveTheirReferenceValue) {
  constexpr unsigned kSeed = 7;
  std::mt19937 random(kSeed);
  const auto state = std::make_unique<State>();
  int finite = 0;
  for (int i = 0; i < 20000; ++i) {
    const Sample sample = random_expression(random, 4);
    const std::string text = "[" + sample.text + "]";
    Cursor cursor{text.data(), text.data(), text.data() + text.size()};
    SyntaxError error;
    double value = 0;
    const bool good = ValueReader(*state, cursor, error).read_value(value);
    // Not finite somewhere inside (a division by zero that a comparison hides) may be refused.
    if (!good) {
      ASSERT_TRUE(error.message.find("finite") != std::string::npos ||
                  error.message.find("zero") != std::string::npos)
          << text << ": " << error.message;
      continue;
    }
    // The reference for MOD and rounding is exact enough for moderate values only.
    if (!(sample.largest < 1e6)) continue;
    ++finite;
    ASSERT_NEAR(value, sample.value, 1e-6 * (1 + std::abs(sample.value)))
        << text << " (seed " << kSeed << ")";
  }
  EXPECT_GT(finite, 10000);
}

TEST(Expression, FunctionsWorkInDegrees) {
  EXPECT_NEAR(value_of("sin[30]"), 0.5, 1e-15);
  EXPECT_NEAR(value_of("TAN[45]"), 1, 1e-15);
  EXPECT_NEAR(value_of("asin[.5]"), 30, 1e-12);
  EXPECT_NEAR(value_of("acos[.5]"), 60, 1e-12);
  EXPECT_NEAR(value_of("atan[1]/[-1]"), 135, 1e-12);
  EXPECT_NEAR(value_of("exp[ln[7]]"), 7, 1e-12);
  EXPECT_EQ(value_of("sqrt[16]"), 4);
  EXPECT_EQ(value_of("fix[-2.8]"), -3);
  EXPECT_EQ(value_of("fup[-2.8]"), -2);
  EXPECT_EQ(value_of("[-7 mod 3]"), 2);
}

TEST(Expression, ParametersAreReadThroughParameters) {
  const auto state = std::make_unique<State>();
  state->parameters.numbered[3] = 4;
  state->parameters.numbered[4] = 11;
  EXPECT_EQ(value_of("##3", *state), 11);
  EXPECT_EQ(value_of("#[#3]", *state), 11);
  EXPECT_EQ(value_of("[#3*#4]", *state), 44);
  EXPECT_EQ(value_of("-#4", *state), -11);
}

TEST(Expression, DeepNestingIsRefusedNotCrashed) {
  EXPECT_EQ(error_of(std::string(30, '[') + "1" + std::string(30, ']')), "");
  EXPECT_NE(error_of(std::string(100000, '[')), "");
  EXPECT_NE(error_of(std::string(100000, '#')), "");
  EXPECT_EQ(error_of(std::string(100000, '-') + "1"), "");
}

TEST(Parameters, AreAssignedAfterTheLineIsCarriedOut) {
  Session session;
  session.must("#1=5\n#1=6 G0 X#1\nG0 X#1\n#<Tool Width>=[#1/2] #2=#1\nG0 X#<toolwidth> Y#2");
  const auto moves = session.all<canonical::Traverse>();
  ASSERT_EQ(moves.size(), 3U);
  EXPECT_EQ(moves[0].target[kAxisX], 5);
  EXPECT_EQ(moves[1].target[kAxisX], 6);
  EXPECT_EQ(moves[2].target[kAxisX], 3);
  EXPECT_EQ(moves[2].target[kAxisY], 6);
}

TEST(Parameters, ARefusedLineAssignsNothing) {
  Session session;
  session.must("#1=5");
  EXPECT_NE(session.run("#1=6 G1 X1"), "");
  EXPECT_EQ(session.interpreter.state().parameters.numbered[1], 5);
}

TEST(Parameters, NamesAreLimitedInNumber) {
  Session session;
  for (std::size_t i = 0; i < ParameterState::kMaxNamed; ++i)
    session.must("#<name" + std::to_string(i) + ">=1");
  EXPECT_NE(session.run("#<one_more>=1").find("too many named"), std::string::npos);
  session.must("#<name5>=2");
}

}  // namespace
}  // namespace kinebus::gcode
