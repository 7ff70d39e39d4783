#include "gateway/sessions/job_check_task.hpp"

#include <algorithm>
#include <utility>

#include "gateway/sessions/messages.hpp"

namespace kinebus {
namespace {
/// Some ten milliseconds of work.
constexpr int kLinesPerSlice = 2000;
}  // namespace

JobCheckTask::JobCheckTask(JobStore& store, const MachineDescription& machine, std::string machine_mark,
                           std::string name, const gcode::WorkOffsets& offsets, const MeshGrid* mesh,
                           const HotendTargets& hotends)
    : store_(store),
      machine_(machine),
      machine_mark_(std::move(machine_mark)),
      name_(std::move(name)),
      offsets_(offsets),
      mesh_(mesh != nullptr ? std::optional(*mesh) : std::nullopt),
      hotends_(hotends) {}

void JobCheckTask::run(Worker& worker, std::function<void(double)> progress,
                       std::function<void(const Found&)> done) {
  progress_ = std::move(progress);
  done_ = std::move(done);
  next(worker);
}

void JobCheckTask::next(Worker& worker) {
  worker.post([self = shared_from_this()] { self->slice(); },
              [self = shared_from_this(), &worker] {
                if (self->found_) return self->done_(*self->found_);
                // A tenth is enough for a display.
                if (self->fraction_ >= self->told_ + 0.1) self->progress_(self->told_ = self->fraction_);
                self->next(worker);
              });
}

void JobCheckTask::slice() {
  if (!preflight_) {
    auto source = store_.open_job(name_);
    const auto job = store_.find(name_);
    if (!source || !job) {
      found_ = Error<StoreError>(
          source ? StoreError{StoreError::Kind::kNoSuchJob, say("no stored job has the name %1", name_)}
                 : source.error());
      return;
    }
    auto kinematics = make_kinematics(machine_);
    if (!kinematics) {
      found_ = Error<StoreError>({StoreError::Kind::kDisk, kinematics.error().what});
      return;
    }
    hash_ = job->hash;
    source_ = std::move(*source);
    kinematics_ = std::make_unique<LevelledKinematics>(std::move(*kinematics));
    if (mesh_) kinematics_->set_mesh(std::make_shared<const BedMesh>(*mesh_));
    JobCheck::Options options;
    options.hotend_celsius = hotends_;
    preflight_ = std::make_unique<Preflight>(machine_, *kinematics_, *source_, kinematics_->bed_reference(),
                                             options, offsets_);
  }
  const bool done = preflight_->step(kLinesPerSlice);
  if (const auto size = source_->size(); size && *size > 0)
    fraction_ = static_cast<double>(preflight_->bytes()) / static_cast<double>(*size);
  if (!done) return;
  const ProblemList& problems = preflight_->problems();
  const JobReport& report = preflight_->report();
  joblink::PreflightResult result = to_message(report, problems);
  result.set_name(name_);
  result.set_hash(hash_);
  if (offsets_ == gcode::WorkOffsets{} && !mesh_ && !preflight_->feeds_by_found_heat())
    static_cast<void>(store_.save_preflight(hash_, machine_mark_,
                                            {.errors = result.summary().errors(),
                                             .warnings = result.summary().warnings(),
                                             .lines = report.lines,
                                             .motion_s = report.motion_s,
                                             .dwell_s = report.dwell_s}));
  found_ = std::move(result);
  // The file is closed here, not by the loop that lets this go.
  preflight_.reset();
  source_.reset();
}

}  // namespace kinebus
