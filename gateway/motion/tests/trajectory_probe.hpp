#pragma once
// Measures a planner's output from outside: nothing but the phases, the kinematics and the programmed moves.

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/gcode/canonical.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/motion_limits.hpp"
#include "gateway/motion/planner.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus::probe {

using Lines = std::vector<canonical::Line>;

struct Measured {
  bool planned = false;  ///< no error, and all came out
  std::string error;
  double duration_s = 0;
  std::size_t phases = 0;
  Planner::Counters counters;
  // Greatest values over finely sampled time.
  double tool_speed_mm_per_s = 0, tool_accel_mm_per_s2 = 0;
  double joint_speed_ratio = 0, joint_accel_ratio = 0;  ///< to the limits
  double axis_speed_ratio = 0, axis_accel_ratio = 0;
  double path_error_mm = 0;  ///< to the programmed moves
  std::uint32_t path_error_line = 0;
  // By third differences of positions a millisecond apart; only where jerk is limited.
  double tool_jerk_mm_per_s3 = 0;
  double joint_jerk_ratio = 0;      ///< to the limits
  double accel_jump_mm_per_s2 = 0;  ///< between phases, of the tool
  double position_jump = 0;         ///< between phases, any axis, mm or rad
  double velocity_jump = 0;         ///< between phases, any axis, per s
  double speed_at_ends = 0;         ///< ds/dt at start and end of the run
  double end_error = 0;             ///< last pose against the programmed end, any axis
  bool last_marked = false;         ///< exactly the last phase carries `last`
  std::vector<Phase> all;           ///< when asked for
};

/// Feeds and pulls as the interface says, finishes, and measures. samples: at least this many a phase, and
/// one a millisecond.
Measured measure(const Kinematics& kinematics, const MotionLimits& limits, const Lines& lines,
                 int samples = 8, bool keep = false, Planner::Options options = {});

/// A programmed job, written short.
class Job {
 public:
  explicit Job(const Pose& start = {}, Frame frame = Frame::kPart);
  Job& feed(double mm_per_s) {
    feed_ = mm_per_s;
    return *this;
  }
  Job& to(const Pose& target);     ///< Feed
  Job& by(const Pose& delta);      ///< Feed, relative
  Job& rapid(const Pose& target);  ///< Traverse
  Job& arc(const Pose& target, const std::array<double, 3>& centre, const std::array<double, 3>& normal,
           double sweep_rad);
  Job& add(const canonical::Command& command);
  const Lines& lines() const { return lines_; }
  const Pose& at() const { return at_; }

 private:
  Pose at_{};
  Frame frame_{};
  double feed_ = 100;
  Lines lines_;
};

/// 0.2 mm lines along a smooth closed curve of this size, coordinates rounded to 1 um as in a file, E with 5
/// digits. tilt_rad, turn_rad: amplitude of A and C along it; 0: three axes.
Lines dense_curve(int count, double size_mm, double feed_mm_per_s, double tilt_rad, double turn_rad);

/// A print like a slicer's: outlines with arcs of short lines, infill, travels, retractions. Reproducible by
/// seed.
Lines random_print(std::uint64_t seed, int moves);

/// Anything that moves, on five axes: lines from 0.02 to 30 mm, runs of short ones, arcs and helices,
/// traverses, moves of A, C or E alone, feeds from 2 to 400 mm/s. Reproducible by seed.
Lines random_five_axis(std::uint64_t seed, int moves, Frame frame);

/// Moves of a sliced file (plain, or .gz by zcat); empty when it cannot be read.
Lines sliced_file(const std::string& path);

}  // namespace kinebus::probe
