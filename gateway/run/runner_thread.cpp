// Threads: path time begins with an index pulse and goes with the spindle until the pass is over. A hold
// waits for its end, an override does not count. A stop is one on the path, and ends the job: what goes on
// within a thread would have to begin at full speed.

#include <algorithm>
#include <cmath>

#include "gateway/run/runner.hpp"

namespace kinebus {
namespace {

constexpr BusTime kPeriod = std::chrono::milliseconds{10};
/// A smaller change is not worth a command, of which the bus carries each several times.
constexpr double kLeastChange = 0.001;
/// Where path time will be when a command of now is in force.
constexpr BusTime kAhead = std::chrono::milliseconds{6};
/// What is missing is caught up within it.
constexpr double kCatchUp_s = 0.04;
constexpr double kMostChange = 0.25;  // of the rate at once, far beyond what a spindle does in kPeriod
/// So far from its angle the thread is spoilt.
constexpr double kLost_turns = 0.1;

}  // namespace

bool Runner::cuts_thread() const {
  return active_ && follower_.follows() && started_ && feed_.streaming();
}

void Runner::begin_thread(const canonical::SpindleSync& sync) {
  follower_.follow(sync.rpm);
  thread_from_ = feed_.added();
  thread_over_ = false;
  // Each pass is the plan from its very beginning.
  feed_.go_on(0);
}

/// What was done of the pass under way cannot be followed by the rest of it.
bool Runner::is_within_thread() const {
  if (!follower_.follows()) return false;
  const JobPlace place = feed_.place({});
  const bool begun = place.phase > thread_from_ || place.phase_s > 0;
  return begun && (feed_.pending() || !thread_over_);
}

void Runner::follow_spindle(BusTime now) {
  follower_.look(heat_.spindle_angle());
  if (!feed_.streaming() || held_ || rate_.stop_latched()) return;
  const PathTime tau = rate_.tau(now);
  if (!started_) {
    doing_ = say("waiting for the spindle");
    if (!group_.primed(tau) || waits_for_journal(now)) return;
    const auto index = follower_.next_index(now, rate_.start_lead());
    if (!index) return;
    started_ = true;
    last_rate_change_ = now;
    doing_ = say("moving");
    rate_.begin_at(std::clamp(follower_.ratio(*index), 0.0, 1.0), *index, now);
    follower_.start(*index, tau);
    return;
  }
  if (now < follower_.started() || now - last_rate_change_ < kPeriod) return;
  const double behind = follower_.behind(now + kAhead, rate_.tau(now + kAhead));
  if (std::abs(behind) > kLost_turns) {
    thread_lost_ =
        say("the thread is lost: the tool is %1 turns from the spindle's angle; a spindle may be a "
            "tenth faster than S",
            printed("%.2f", std::abs(behind)));
    return;
  }
  const double present = rate_.target();
  double wanted =
      follower_.ratio(now + kAhead + kPeriod / 2) + behind / follower_.planned_turns_per_s() / kCatchUp_s;
  wanted = std::clamp(wanted, present - kMostChange, present + kMostChange);
  const double allowed = group_.allowed_rate(tau);
  wanted = std::clamp(wanted, 0.0, std::min(1.0, allowed));
  // Spread over the time to the next one, and no steeper than a hold.
  const double change = std::abs(wanted - present);
  if (change < kLeastChange) return;
  last_rate_change_ = now;
  const double even_ms = static_cast<double>(kPeriod.count()) / 1e6 / std::max(change, 1e-3);
  const auto ramp = std::chrono::milliseconds{std::llround(std::min(even_ms, 500.0))};
  rate_.request(wanted, std::max(ramp, machine_.stop.hold_ramp), now);
}

}  // namespace kinebus
