#pragma once
// What kinebus-kinematics answers: a row of numbers in, lines of numbers out. One entry of the table a
// command.

#include <iosfwd>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/kinematics/number_table.hpp"
#include "tools/kinematics/subject.hpp"

namespace kinebus::kinematics_tool {

using Json = nlohmann::ordered_json;

struct Question {
  const Subject& subject;
  Frame frame = Frame::kPart;
  bool mirrored = false;
  std::span<const double> values;  ///< by the command's columns
};

// Json's move only asserts.
struct Answer {  // NOLINT(bugprone-exception-escape)
  struct Line {
    std::vector<double> values;  ///< by the command's result columns
    std::string remark;          ///< behind a #
  };
  std::vector<Line> lines;
  Json json;                         ///< of this row
  std::optional<std::string> error;  ///< this pose cannot be taken: why; no lines then
};

struct Command {
  const char* name;
  const char* what;  ///< for --help
  NumberColumns (*columns)(const Subject&);
  std::vector<std::string> (*result_columns)(const Subject&);
  Answer (*answer)(const Question&);
  bool of_bodies = false;  ///< asked of machines with bodies only
};
std::span<const Command> commands();

/// The program: arguments without its own name. 0; 1 when a pose cannot be taken or an input is wrong, with
/// words on `err`; CLI11's codes (above 100) for wrong options.
int run(std::vector<std::string> arguments, std::istream& in, std::ostream& out, std::ostream& err);

}  // namespace kinebus::kinematics_tool
