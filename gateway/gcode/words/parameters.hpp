#pragma once
// #1 .. #5602, #<name>, and the numbers that stand for something: offsets, tool, current point
// (RS274/NGC, 3.2.1).

#include <optional>
#include <string_view>
#include <vector>

#include "gateway/gcode/words/state.hpp"

namespace kinebus::gcode {

/// What a parameter number may be used for.
enum class ParameterUse : std::uint8_t { kNone, kRead, kReadWrite };
ParameterUse parameter_use(int index);

/// Value of #index, which must be readable. #5211-#5219 are the G92 offsets, #5221-#5229 those of G54, and so
/// on in steps of 20 to G59.3 (X Y Z A B C U V W: mm, degrees; behind them, #5230 ..., their angle), #5210:
/// G92 is active, #5220: 1 for G54 ... 9 for G59.3, #5400: tool, #5401 to #5403: its offset, #5420-#5428:
/// current point X Y Z A B C U V W in the units in force (mm or inches, degrees).
double read_parameter(const State& state, int index);

bool is_offset_parameter(int index);

/// Sets #index, which must be writable.
void write_parameter(State& state, int index, double value);

/// `name` in lower case without blanks: a value that was assigned, or a predefined one (#<_x>).
std::optional<double> read_named(const State& state, std::string_view name);
/// It tells the state of the machine and can only be read.
bool is_predefined(std::string_view name);
/// All of them, for the reference.
std::vector<std::string_view> predefined_names();
/// False when there are kMaxNamed others already.
bool write_named(ParameterState& parameters, std::string_view name, double value);

}  // namespace kinebus::gcode
