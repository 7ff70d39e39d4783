// A job whose stream is lost, and one that another gateway reads again: what is left of it, and from where.

#include <utility>

#include "gateway/run/runner.hpp"

namespace kinebus {
namespace {

/// What a command behind which a job's text depends on what is found leaves in the journal.
std::optional<journal::Learned::What> learns(const canonical::Command& command) {
  if (std::holds_alternative<canonical::Probe>(command)) return journal::Learned::What::kProbed;
  if (std::holds_alternative<canonical::AwaitInput>(command)) return journal::Learned::What::kInput;
  const auto* mesh = std::get_if<canonical::Mesh>(&command);
  if (mesh == nullptr || !BedLevel::moves_poses(*mesh)) return std::nullopt;
  return journal::Learned::What::kMesh;
}

}  // namespace

void Runner::suspend(PathTime tau) {
  if (!active_ || suspended_) return;
  suspended_ = true;
  feed_.suspend(tau);
  // The run was over but for the waiting.
  const bool over = wait_ == Wait::kRunDone || wait_ == Wait::kRest;
  if (over && !feed_.pending()) wait_ = Wait::kNone;
  if (noted_) journal_.push(journal::Interrupted{feed_.place(tau), feed_.extruder_shift_mm()});
}

void Runner::go_on(BusTime now) {
  suspended_ = held_ = still_ = hold_waits_ = false;
  if (wait_ == Wait::kPause) end_wait();
  look_at_input_anew();
  // A pass of a thread is the plan from its very beginning.
  feed_.go_on(follower_.follows() ? 0 : to_seconds(BusTime{machine_.stop.hold_ramp}));
  heating_.restart();
  doing_ = say("moving");
  last_time_ = now;
}

PlannedPose Runner::rest_pose() const {
  PlannedPose rest{start_, Frame::kMachine, 0};
  static_cast<void>(feed_.rest_pose(rest.pose, rest.frame, rest.line));
  return rest;
}

void Runner::shift_extruder(double by_mm) {
  feed_.shift_extruder(by_mm);
  start_[kE] += by_mm;
}

void Runner::start_replay(std::unique_ptr<ByteSource> source, const journal::State& state, PathTime tau) {
  start_job(std::move(source), state.job->start, state.job->offsets);
  pipeline_.replay_feed_scales(state.scales);
  pipeline_.replay_left_out(state.left_out);
  if (!state.left_out.empty()) check_what_follows();
  learned_ = state.learned;
  next_learned_ = 0;
  const bool had_mesh = !learned_.empty() && learned_.front().what == journal::Learned::What::kBeginning;
  if (bed_ != nullptr) bed_->put(had_mesh ? learned_.front().mesh : MeshGrid{});
  if (had_mesh) ++next_learned_;
  waits_replayed_ = state.waits_done;
  doing_ = say("reading the job up to where it was");
  if (state.run) {
    const journal::RunBegin& run = *state.run;
    feed_.replay_to(RunFeed::Run{run.start, run.from, run.ramp_s}, tau);
    feed_.shift_extruder(run.extruder_shift_mm);
  } else {
    feed_.replay_to(state.interrupted ? state.interrupted->place : JobPlace{});
    feed_.shift_extruder(state.interrupted ? state.interrupted->extruder_shift_mm : 0);
  }
}

Result<void, Sentence> Runner::leave_out(const std::string& name) {
  if (!active_ || !noted_ || feed_.replaying())
    return Error<Sentence>(say("no job runs of which an object could be left out"));
  const auto from = pipeline_.leave_out(name);
  if (!from) return Error<Sentence>(from.error());
  journal_.push(journal::ObjectLeftOut{*from});
  check_what_follows();
  return {};
}

Runner::Outcome Runner::replay(int budget) {
  using Step = JobPipeline::Step;
  while (feed_.replaying()) {
    switch (pipeline_.next(budget)) {
      case Step::kMore:
        return Outcome::kBusy;
      case Step::kPhase:
        take_phase();
        break;
      case Step::kBarrier:
        last_line_ = pipeline_.command().line;
        if (const auto* sync = std::get_if<canonical::SpindleSync>(&pipeline_.command().command))
          begin_thread(*sync);
        if (const auto what = learns(pipeline_.command().command)) {
          if (replay_learned(*what)) break;
          // The place is before it: it is done, or done again.
          barrier_waits_ = true;
          feed_.end_replay();
          break;
        }
        if (!waits(pipeline_.command())) break;
        if (waits_done_ < waits_replayed_) {
          ++waits_done_;
          break;
        }
        barrier_waits_ = true;
        feed_.end_replay();
        break;
      case Step::kEnd:
        feed_.end_replay();
        break;
      case Step::kProblem:
        return fail(pipeline_.problem().line, pipeline_.problem().words, false);
      case Step::kRunEnd:
        thread_over_ = true;
        break;
      case Step::kEvent:  // what it set is in the journal, else
        if (const auto* per_turn = std::get_if<canonical::FeedPerTurn>(&pipeline_.command().command))
          per_turn_.follow(per_turn->rpm);
        break;
      case Step::kMelt:  // heaters are as hot as they were before it goes on
      case Step::kProbed:
      case Step::kStarved:
        break;
    }
  }
  if (is_within_thread())
    return fail(last_line_, say("the job ends: it was stopped in a thread, which has to be cut in one go"),
                false);
  suspended_ = true;
  doing_ = say("interrupted");
  return Outcome::kDone;
}

}  // namespace kinebus
