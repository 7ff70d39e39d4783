#include "gateway/machine/print_job.hpp"

namespace kinebus {
namespace {
constexpr BusTime kProgressPeriod = std::chrono::milliseconds{250};
}  // namespace

void PrintJob::begin_check(std::unique_ptr<ByteSource> source, const HotendTargets& hotends,
                           const gcode::WorkOffsets& offsets) {
  source_ = std::make_unique<HashedSource>(std::move(source));
  offsets_ = offsets;
  told_ = 0;
  JobCheck::Options options;
  options.hotend_celsius = hotends;
  preflight_ = std::make_unique<Preflight>(machine_, kinematics_, *source_, kinematics_.bed_reference(),
                                           options, offsets_);
}

bool PrintJob::check(BusTime now, int budget) {
  const bool done = preflight_->step(budget);
  tell_problems(now);
  if (!done) return false;
  report_ = preflight_->report();
  errors_ = preflight_->problems().errors();
  bytes_ = source_->bytes();
  hash_ = source_->hash();
  preflight_.reset();
  return true;
}

void PrintJob::tell_problems(BusTime now) {
  const auto& problems = preflight_->problems().all();
  for (; told_ < problems.size(); ++told_) {
    const Problem& problem = problems[told_];
    const bool error = problem.severity == Problem::Severity::kError;
    events_.push({.kind = MachineEvent::Kind::kProblem,
                  .when = now,
                  .line = problem.line,
                  .words = error ? say("error: %1", problem.words) : say("warning: %1", problem.words),
                  .advice = {}});
  }
}

bool PrintJob::is_the_text_of(const journal::JobBegin& begun) const {
  return hash_ == begun.hash && bytes_ == begun.bytes;
}

bool PrintJob::progress_is_due(BusTime now, bool moving) {
  if (now < progress_due_ || runner_.suspended() || runner_.between_runs() || !moving) return false;
  progress_due_ = now + kProgressPeriod;
  return true;
}

bool PrintJob::growth_is_due(double top_mm) {
  constexpr double kCell_mm = 1;  // of what is printed
  if (noted_top_mm_ && top_mm < *noted_top_mm_ + kCell_mm) return false;
  noted_top_mm_ = top_mm;
  return true;
}

journal::JobBegin PrintJob::record(const Pose& start) const {
  return {name_, bytes_, hash_, start, offsets_};
}

}  // namespace kinebus
