#pragma once
// A finished job looked at from outside: read back by the gateway's own interpreter and planner.

#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/problem.hpp"
#include "tools/compose/joiner.hpp"
#include "tools/compose/nozzle.hpp"

namespace kinebus::compose {

struct Verification {
  ProblemList problems;             ///< of the pre-flight: reach, limits, temperatures
  double job_time_s = 0;            ///< heating not included
  double worst_layer_tilt_deg = 0;  ///< between the tool and the piece's normal while filament is fed
  double worst_overlap_mm = 0;      ///< of the nozzle with printed pieces or table; <= 0: it never meets them
  int worst_overlap_line = 0;
  double filament_mm = 0;  ///< in strands; what is drawn back and given back is not counted
  bool good() const { return problems.errors() == 0 && worst_overlap_mm <= 0 && worst_layer_tilt_deg <= 1; }
};

struct SweepOptions {
  Nozzle nozzle;
  double table_radius_mm = 100;
  double step_mm = 1;        ///< between places looked at along a move
  double step_rad = 0.0175;  ///< and while the table turns
};

/// `meshes`: the pieces in part coordinates, in the order of `job.pieces` (empty: only the table is in the
/// way).
Verification verify(const JoinedJob& job, const std::vector<JoinPiece>& pieces,
                    const std::vector<TriangleMesh>& meshes, const MachineDescription& machine,
                    const SweepOptions& options);

/// Job time of any G-code by the gateway's planner, s, and its problems.
double planned_time_s(const std::string& text, const MachineDescription& machine, ProblemList& problems);

}  // namespace kinebus::compose
