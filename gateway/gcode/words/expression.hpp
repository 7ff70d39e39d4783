#pragma once
// Values of words: numbers, #parameters, [expressions] and functions (RS274/NGC 3.3.2).

#include <cstdint>
#include <string>

#include "gateway/gcode/words/state.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// A place in a line.
struct Cursor {
  const char* begin = nullptr;
  const char* p = nullptr;
  const char* end = nullptr;

  std::uint32_t column() const { return column_of(p); }
  std::uint32_t column_of(const char* at) const { return static_cast<std::uint32_t>(at - begin) + 1; }
  bool at_end() const { return p == end; }
  void skip_blanks() {
    while (p != end && (*p == ' ' || *p == '\t' || *p == '\r')) ++p;
  }
  /// Skips blanks, then one `c` if it stands there.
  bool accept(char c) {
    skip_blanks();
    if (p == end || *p != c) return false;
    ++p;
    return true;
  }
};

struct SyntaxError {
  std::uint32_t column = 0;
  Sentence message;
};

/// #12 or #<name>.
struct ParameterRef {
  int index = 0;     ///< 0: named
  std::string name;  ///< lower case, without blanks
};

/// Reads values at a cursor. Every function returns false with `error` filled in. Angles are degrees.
/// Operators by falling precedence: **; * / MOD; + -; EQ NE GT GE LT LE; AND OR XOR; all from the left. EQ
/// and NE have a tolerance of 0.0001, as in LinuxCNC. Nesting is limited, so that no line can exhaust the
/// stack.
class ValueReader {
 public:
  ValueReader(const State& state, Cursor& cursor, SyntaxError& error)
      : state_(state), cursor_(cursor), error_(error) {}

  /// Whether a value begins at the cursor (blanks skipped): digit, point, sign, #, [ or the name of a
  /// function.
  bool starts_value();
  bool read_value(double& value);
  /// The cursor stands after the #.
  bool read_parameter_ref(ParameterRef& ref, bool may_be_none = false);

 private:
  static constexpr int kMaxDepth = 40;

  bool fail(const char* at, Sentence message);
  bool read_bracket(double& value);
  bool read_meta(double& value);
  bool read_expression(int lowest_level, double& value);
  bool read_function(double& value);
  bool read_arc_tangent(const char* start, double& value);
  bool read_exists(double& value);
  bool read_parameter(double& value);

  const State& state_;
  Cursor& cursor_;
  SyntaxError& error_;
  int depth_ = 0;
};

}  // namespace kinebus::gcode
