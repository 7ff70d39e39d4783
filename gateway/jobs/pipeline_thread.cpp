// Threads: where the tool is as fast as the spindle wants it, the pitch is right. A plan that is slower,
// because of a joint's limit or for want of way, is refused.

#include <algorithm>
#include <cmath>

#include "gateway/jobs/job_pipeline.hpp"
#include "gateway/jobs/tap_turn.hpp"

namespace kinebus {
namespace {

constexpr double kOfSpeed = 1e-6;        // rounding of the planner
constexpr double kFasterThanTold = 1.1;  // as the interpreter has it

}  // namespace

void JobPipeline::watch_thread(const Phase& phase) {
  const double end = phase.speed(phase.duration_s);
  if (thread_.sync.turns_back_mm > 0) return watch_tap(phase, end);
  const double fast = thread_.sync.feed_per_s * (1 - kOfSpeed);
  if (thread_.line != 0 && phase.line != thread_.line) thread_.corners = true;
  thread_.line = phase.line;
  if (thread_.slows && end >= fast) thread_.slowed = true;
  if (phase.v0 >= fast && end < fast) thread_.slows = true;
  thread_.fastest_per_s = std::max({thread_.fastest_per_s, phase.v0, end});
}

void JobPipeline::watch_tap(const Phase& phase, double end) {
  constexpr double kNear_mm = 0.02;  // limited jerk leaves the corner more gently than a spindle
  const canonical::SpindleSync& sync = thread_.sync;
  thread_.line = phase.line;
  thread_.fastest_per_s = std::max(thread_.fastest_per_s, end);
  thread_.way_mm += phase.s(phase.duration_s) - phase.s(0);
  if (thread_.fast_mm < 0 && end >= sync.feed_per_s * (1 - kOfSpeed)) thread_.fast_mm = thread_.way_mm;
  const TapTurn turn(machine_, sync.rpm / kFasterThanTold);
  const double pitch = sync.feed_per_s * 60 / sync.rpm;
  const double apart = std::abs(sync.turns_back_mm - thread_.way_mm);
  if (thread_.fast_mm < 0 || apart < kNear_mm || apart > turn.turns() * pitch) return;
  if (end < pitch * std::sqrt(2 * turn.turns_per_s2 * apart / pitch)) thread_.slow_turn = true;
}

void JobPipeline::check_tap(const Thread& thread) {
  const canonical::SpindleSync& sync = thread.sync;
  const double pitch = sync.feed_per_s * 60 / sync.rpm;
  // The spindle's speed is known a turn after the tool is as fast.
  const TapTurn turn(machine_, sync.rpm / kFasterThanTold);
  const double needs = thread.fast_mm + (turn.turns() + 1) * pitch;
  if (needs > sync.turns_back_mm)
    return refuse(line_of(thread.line), 0,
                  say("the tap needs %1 to be as fast as the spindle and to turn back with it, and has %2: a "
                      "slower spindle, a greater spindle.tap_rpm_per_s, or more way before the hole",
                      printed("%.3g mm", needs), printed("%.3g mm", sync.turns_back_mm)));
  if (thread.slow_turn)
    refuse(line_of(thread.line), 0,
           say("the axes cannot turn back as fast as the spindle in a tap: a slower spindle, or a smaller "
               "spindle.tap_rpm_per_s"));
}

/// At the end of its run.
void JobPipeline::check_thread() {
  if (thread_.line == 0) return;
  const Thread thread = thread_;
  thread_ = {thread.sync};
  const bool fast = thread.fastest_per_s >= thread.sync.feed_per_s * (1 - kOfSpeed);
  if (fast && thread.sync.turns_back_mm > 0) return check_tap(thread);
  if (fast && !(thread.slowed && !thread.corners)) return;
  const auto mm_per_s = [](double speed) { return printed("%.3g mm/s", speed); };
  if (!fast)
    return refuse(line_of(thread.line), 0,
                  say("the thread needs %1 at %2 rpm, a tenth more than S, and the plan reaches %3: a slower "
                      "spindle, or more way before and behind the thread",
                      mm_per_s(thread.sync.feed_per_s), printed("%.0f", thread.sync.rpm),
                      mm_per_s(thread.fastest_per_s)));
  refuse(line_of(thread.line), 0,
         say("the thread needs %1 at %2 rpm, a tenth more than S, and a limit slows the plan on the way: a "
             "slower spindle",
             mm_per_s(thread.sync.feed_per_s), printed("%.0f", thread.sync.rpm)));
}

}  // namespace kinebus
