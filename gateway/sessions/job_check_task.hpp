#pragma once
// The pre-flight of a stored job without the machine: in slices, so that other work is not kept waiting.

#include <functional>
#include <memory>
#include <string>

#include "gateway/jobs/preflight.hpp"
#include "gateway/jobs/store/job_store.hpp"
#include "gateway/kinematics/levelled.hpp"
#include "gateway/sessions/worker.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {

class JobCheckTask : public std::enable_shared_from_this<JobCheckTask> {
 public:
  using Found = Result<joblink::PreflightResult, StoreError>;
  /// `offsets`, `mesh`, `hotends` (Heat::hotends_found()): the machine's as they are now (nullptr:
  /// none). Only what was found with all offsets 0, without a mesh and by the job's own heat is kept in the
  /// store.
  JobCheckTask(JobStore& store, const MachineDescription& machine, std::string machine_mark, std::string name,
               const gcode::WorkOffsets& offsets, const MeshGrid* mesh, const HotendTargets& hotends);
  /// `progress` (0..1, some times a second of work) and `done` are called within the loop.
  void run(Worker& worker, std::function<void(double)> progress, std::function<void(const Found&)> done);

 private:
  void next(Worker& worker);
  void slice();

  JobStore& store_;
  const MachineDescription& machine_;
  std::string machine_mark_, name_, hash_;
  gcode::WorkOffsets offsets_;
  std::optional<MeshGrid> mesh_;
  HotendTargets hotends_;
  std::function<void(double)> progress_;
  std::function<void(const Found&)> done_;

  // The worker's, between post and done.
  std::unique_ptr<LevelledKinematics> kinematics_;
  std::unique_ptr<ByteSource> source_;
  std::unique_ptr<Preflight> preflight_;
  std::optional<Found> found_;
  double fraction_ = 0, told_ = 0;
};

}  // namespace kinebus
