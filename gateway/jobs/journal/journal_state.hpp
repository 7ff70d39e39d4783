#pragma once
// All records of a journal together: what is known of the job that was under way.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "gateway/jobs/journal/journal_record.hpp"

namespace kinebus::journal {

struct State {
  std::optional<std::uint8_t> epoch;
  std::vector<Offsets> offsets;  ///< of the machines that had this gateway, the one set last at the end
  std::optional<JobBegin> job;   ///< none: nothing to take up
  std::optional<RunBegin> run;   ///< none: the job stands at `interrupted`, or has not moved
  std::optional<Interrupted> interrupted;
  std::optional<PathTime> found;  ///< counts for `run`
  std::uint64_t waits_done = 0;
  std::vector<FeedScale> scales;
  std::vector<LeftOut> left_out;  ///< in the order of the job
  std::optional<double> override_ratio;
  std::optional<Heat> heat;
  std::vector<Learned> learned;  ///< in the order of the job
  std::vector<Mesh> meshes;      ///< of the machines, the one measured last at the end
  std::vector<MeshInForce> meshes_in_force;
  std::optional<Progress> progress;
  std::optional<Printed> printed;  ///< none: not known, or nothing
  std::optional<JobTime> time;
  friend bool operator==(const State&, const State&) = default;

  static constexpr std::size_t kMeshes = 32;    ///< kept
  static constexpr std::size_t kMachines = 16;  ///< whose offsets are kept

  void take(const Record& record);
  /// All 0 for a machine that never had any.
  gcode::WorkOffsets offsets_of(const std::string& machine) const;
  /// The fewest records that lead to this state.
  std::vector<Record> records() const;
};

}  // namespace kinebus::journal
