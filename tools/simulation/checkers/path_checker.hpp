#pragma once
// The tool against the programmed path, as an interpreter of the checker's own reads it from the job's text.

#include <cmath>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/interpreter.hpp"
#include "gateway/gcode/programs/job_reader.hpp"
#include "gateway/jobs/byte_source.hpp"
#include "gateway/motion/path_distance.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

/// Up to the first line that probes: where those behind it lead follows from what it measures.
class PathChecker {
 public:
  /// `source`: the job's text from its beginning; must outlive this. The job starts at `start`
  /// (Frame::kMachine).
  PathChecker(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
              const Pose& start);
  ~PathChecker();

  void on_sample(const Sample& sample);
  double max_um() const { return max_um_; }
  double rms_um() const { return samples_ > 0 ? std::sqrt(squares_um2_ / static_cast<double>(samples_)) : 0; }
  double last_um() const { return last_um_; }
  std::uint32_t nearest_line() const { return distance_.nearest_line(); }
  double worst_time_s() const { return worst_time_s_; }
  std::uint32_t worst_line() const { return worst_line_; }

 private:
  void read_ahead(std::uint32_t line);
  void take(const canonical::Line& line);

  const Kinematics& kinematics_;
  ByteSource& source_;
  std::unique_ptr<gcode::Interpreter> interpreter_;
  std::unique_ptr<gcode::JobReader> reader_;
  gcode::CommandBuffer commands_;
  PathDistance distance_;
  std::deque<std::pair<std::uint32_t, Frame>> frames_;  ///< from which line on XYZ mean what
  std::vector<char> text_;
  std::size_t text_at_ = 0, text_end_ = 0;
  bool ended_ = false;
  double squares_um2_ = 0;
  std::uint64_t samples_ = 0;
  double max_um_ = 0, last_um_ = 0, worst_time_s_ = 0;
  std::uint32_t worst_line_ = 0;
  std::uint32_t probe_line_ = 0;  ///< 0: none
};

}  // namespace kinebus
