// Levelling in a run: the mesh changes at rest, and the tool's place gets another name; and what a job that
// is read again has found out before.

#include <utility>

#include "gateway/jobs/machine_setup.hpp"
#include "gateway/run/runner.hpp"

namespace kinebus {

using Learned = journal::Learned;

/// The pipeline's command, at rest.
Runner::Outcome Runner::level(BusTime now, const canonical::Mesh& mesh, std::uint32_t line) {
  if (bed_ == nullptr) return fail(line, say("no bed mesh is in force"), false);
  Frame frame = pipeline_.planner().end_frame();
  Pose pose = pipeline_.planner().end_pose();
  JointVector joints{};
  if (const auto reached = kinematics_.inverse(frame, pose, joints); !reached)
    return fail(line, to_string(reached.error()), false);
  if (auto done = bed_->carry_out(now, mesh, pipeline_.touched(), line); !done)
    return fail(line, done.error(), false);
  if (!BedLevel::moves_poses(mesh)) {
    if (live_) answers_.push_back({});
    return Outcome::kBusy;
  }
  const double e_mm = pose[kE];
  if (const auto found = kinematics_.forward(frame, joints, pose); !found)
    return fail(line, to_string(found.error()), false);
  pose[kE] = e_mm;
  Learned learned{.what = Learned::What::kMesh, .frame = frame, .at = pose, .stand = pose};
  if (const MeshGrid* const grid = bed_->in_force()) learned.mesh = *grid;
  learn(learned);
  feed_.cut();
  if (!stand_at(frame, pose)) return fail(line, say("the tool's place cannot be named"), false);
  if (live_) answers_.push_back({.stand = PlannedPose{pose, frame, line}});
  return Outcome::kBusy;
}

void Runner::learn(journal::Learned learned) {
  if (!noted_) return;
  learned.phases = feed_.added();
  journal_.push(std::move(learned));
}

/// Nothing is under way, the tool stands there, and the job goes on from it.
bool Runner::stand_at(Frame frame, const Pose& pose) {
  const auto in_machine = convert_pose(kinematics_, frame, pose, Frame::kMachine);
  if (!in_machine) return false;
  start_ = *in_machine;
  start_[kE] += feed_.extruder_shift_mm() + pipeline_.filament_offset_mm();
  pipeline_.stands(pose, frame);
  check_what_follows();
  return true;
}

/// The pre-flight did not know what is known now. A live line's is checked before it is taken.
void Runner::check_what_follows() {
  if (live_ || check_) return;
  check_ = std::make_unique<JobCheck>(
      machine_, kinematics_,
      JobCheck::Options{.hotend_celsius = heat_.hotend_targets(), .tool = heat_.tool_of_job()});
}

/// Of a job that is read again: the next thing that it had found out at a barrier. false: it had not come
/// there.
bool Runner::replay_learned(Learned::What what) {
  if (next_learned_ == learned_.size() || learned_[next_learned_].what != what) return false;
  const Learned& found = learned_[next_learned_++];
  feed_.skip_to(found.phases);
  if (what == Learned::What::kInput) {
    pipeline_.input_read(found.at[kX]);
    check_what_follows();
    return true;
  }
  if (what == Learned::What::kProbed) {
    pipeline_.probed({found.contact, found.at, found.stand, found.frame});
    if (const auto stand = convert_pose(kinematics_, found.frame, found.stand, Frame::kMachine))
      start_ = *stand;
    check_what_follows();
    return true;
  }
  if (bed_ != nullptr) bed_->put(found.mesh);
  return stand_at(found.frame, found.stand);
}

}  // namespace kinebus
