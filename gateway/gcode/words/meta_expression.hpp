#pragma once
// Expressions of RepRapFirmware's meta commands: {move.axes[0].machinePosition + 5}, var.count < 3.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "gateway/gcode/words/expression.hpp"
#include "gateway/gcode/words/state.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// "true", "12.5", "text" without its quotation marks, "null".
std::string shown_value(const MetaValue& value);

/// Reads one expression at a cursor; false with `error` filled in. By rising precedence: ? :, ^ (joins
/// texts), & && | ||, comparisons (= and ==, numbers equal within 1e-9 of their size), + -, * /, and ! - + #
/// (length of a text, a list of the object model) before their operand. Angles are radians. Names: var.,
/// global., param., iterations, pi, true, false, null, and those of the object model that a text which is
/// read ahead of the machine can know (meta_model.cpp); others are refused. Bounded in depth and in the
/// length of texts.
class MetaReader {
 public:
  static constexpr std::size_t kMaxText = 500;

  MetaReader(const State& state, Cursor& cursor, SyntaxError& error)
      : state_(state), cursor_(cursor), error_(error) {}

  bool read(MetaValue& value);
  bool read_number(double& value);
  bool read_condition(bool& value);
  /// "count": letters, digits and _, not a digit first.
  bool read_name(std::string& name);

 private:
  static constexpr int kMaxDepth = 40;

  bool fail(const char* at, Sentence message);
  bool read_choice(MetaValue& value, bool counts);
  bool read_joined(int lowest_level, MetaValue& value, bool counts);
  bool read_operand(MetaValue& value, bool counts);
  bool read_text(MetaValue& value);
  bool read_named(MetaValue& value, bool counts);
  bool read_path(const char* start, std::string& path, bool counts);
  bool call(const char* start, const std::string& name, MetaValue& value, bool counts);
  bool exists(MetaValue& value);
  bool number(const char* at, const MetaValue& value, double& result);

  const State& state_;
  Cursor& cursor_;
  SyntaxError& error_;
  int depth_ = 0;
};

/// A name of the object model, whose indices stand in [ ]: "heat.heaters[1].active". False: `why` not.
bool read_model(const State& state, std::string_view path, MetaValue& value, Sentence& why);
/// How many there are of "tools"; below 0: no list of the object model has this name.
int model_count(const State& state, std::string_view path);

}  // namespace kinebus::gcode
