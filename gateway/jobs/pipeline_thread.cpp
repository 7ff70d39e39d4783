// Threads: where the tool is as fast as the spindle wants it, the pitch is right. A plan that is slower,
// because of a joint's limit or for want of way, is refused.

#include <algorithm>

#include "gateway/jobs/job_pipeline.hpp"

namespace kinebus {
namespace {

constexpr double kOfSpeed = 1e-6;  // rounding of the planner

}  // namespace

void JobPipeline::watch_thread(const Phase& phase) {
  const double end = phase.speed(phase.duration_s), fast = thread_.sync.feed_per_s * (1 - kOfSpeed);
  if (thread_.line != 0 && phase.line != thread_.line) thread_.corners = true;
  thread_.line = phase.line;
  if (thread_.slows && end >= fast) thread_.slowed = true;
  if (phase.v0 >= fast && end < fast) thread_.slows = true;
  thread_.fastest_per_s = std::max({thread_.fastest_per_s, phase.v0, end});
}

/// At the end of its run.
void JobPipeline::check_thread() {
  if (thread_.line == 0) return;
  const Thread thread = thread_;
  thread_ = {thread.sync};
  const bool fast = thread.fastest_per_s >= thread.sync.feed_per_s * (1 - kOfSpeed);
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
