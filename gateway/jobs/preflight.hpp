#pragma once
// A whole job checked before anything moves or heats: the same pipeline that will run it, with its phases
// checked instead of streamed. One pass, bounded memory.

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/jobs/byte_source.hpp"
#include "gateway/jobs/job_check.hpp"
#include "gateway/jobs/job_pipeline.hpp"

namespace kinebus {

/// What is known of a job after its pre-flight.
struct JobReport {
  std::uint32_t lines = 0;
  std::uint64_t moves = 0;   ///< motion commands with a length
  double motion_s = 0;       ///< time in motion at 100 %
  double dwell_s = 0;        ///< stated waits (G4)
  std::uint32_t runs = 0;    ///< stretches of motion from rest to rest
  std::uint32_t pauses = 0;  ///< M0, M1
  std::uint32_t heat_waits = 0;
  std::vector<std::string> objects;  ///< of the print, as the text names them
};

/// Takes what a command adds to the report.
void count_command(const canonical::Command& command, JobReport& report);

/// What the job has no effect with here is told as warnings.
void tell_notes(JobPipeline& pipeline, JobCheck& check);

/// "cube_1", or the number that M486 gave it.
std::string shown_name(const gcode::PrintObject& object);

class Preflight {
 public:
  /// `source` at its beginning; must outlive this. The job starts at `start`, Frame::kMachine, with the
  /// machine's work offsets.
  Preflight(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
            const Pose& start, JobCheck::Options options, const gcode::WorkOffsets& offsets = {});
  Preflight(const MachineDescription& machine, const Kinematics& kinematics, ByteSource& source,
            const Pose& start);

  /// Works on about `lines` lines. True: done.
  bool step(int lines);

  const JobReport& report() const { return report_; }
  /// What it feeds first depends on the hot end as the job finds it.
  bool feeds_by_found_heat() const { return check_.feeds_by_found_heat(); }
  const ProblemList& problems() const { return check_.problems(); }
  std::uint64_t bytes() const { return pipeline_.bytes(); }

 private:
  JobPipeline pipeline_;
  JobCheck check_;
  JobReport report_;
};

}  // namespace kinebus
