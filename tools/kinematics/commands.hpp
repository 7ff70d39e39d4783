#pragma once
// What kinebus-kinematics answers: a row of numbers in, lines of numbers out. One entry of the table a
// command.

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/kinematics/number_table.hpp"

namespace kinebus::kinematics_tool {

using Json = nlohmann::ordered_json;

/// A machine, and what of it takes part in its kinematics: all but the filament.
class Subject {
 public:
  /// The error: why no machine can have this geometry.
  static Result<Subject, std::string> of(MachineDescription machine);

  const MachineDescription& machine() const { return machine_; }
  const Kinematics& kinematics() const { return *kinematics_; }

  struct Axis {
    std::string name;   ///< "X", "tower1"
    std::size_t index;  ///< in a Pose or JointVector
    bool rotary;
    double unit() const { return rotary ? kRadPerDeg : 1; }  ///< of a number that a person reads
    std::string column(const char* per = "") const;          ///< "x_mm", "x_mm_per_s"
  };
  const std::vector<Axis>& pose_axes() const { return pose_axes_; }
  const std::vector<Axis>& joints() const { return joints_; }
  /// So many joints belong to the mechanism that is not a table on its own: forward() needs them at least.
  std::size_t mechanism_joints() const;

 private:
  MachineDescription machine_;
  std::unique_ptr<Kinematics> kinematics_;
  std::vector<Axis> pose_axes_, joints_;
};

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
};
std::span<const Command> commands();

/// The program: arguments without its own name. 0; 1 when a pose cannot be taken or an input is wrong, with
/// words on `err`; CLI11's codes (above 100) for wrong options.
int run(std::vector<std::string> arguments, std::istream& in, std::ostream& out, std::ostream& err);

}  // namespace kinebus::kinematics_tool
