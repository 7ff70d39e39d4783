// Threads: path time begins with an index pulse and goes with the spindle until the pass is over. A hold
// waits for its end, an override does not count. A stop is one on the path, and ends the job: what goes on
// within a thread would have to begin at full speed.

#include <algorithm>
#include <cmath>

#include "gateway/run/runner.hpp"
#include "gateway/run/thread_control.hpp"

namespace kinebus {
namespace {

/// A smaller change is not worth a command, of which the bus carries each several times.
constexpr double kLeastChange = 0.001;
constexpr double kMostChange =
    0.25;  // of the rate at once, far beyond what a spindle does in ThreadControl::kPeriod

}  // namespace

bool Runner::cuts_thread() const {
  return active_ && follower_.follows() && started_ && feed_.streaming();
}

void Runner::begin_thread(const canonical::SpindleSync& sync) {
  follower_.follow(sync.rpm);
  begin_tap(sync);
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
  look_at_spindle();
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
    tap_.looked = feed_.run_start();
    tap_.start = tap_point(tap_.looked).value_or(PosePoint{});
    return;
  }
  if (now < follower_.started()) return;
  follow_tap(now);
  if (now - last_rate_change_ < ThreadControl::kPeriod) return;
  const auto rate = tap_.run_in_mm ? tap_rate(now) : thread_rate(now);
  if (!rate) return;
  const double present = rate_.target();
  double wanted = *rate;
  wanted = std::clamp(wanted, present - kMostChange, present + kMostChange);
  const double allowed = group_.allowed_rate(tau);
  wanted = std::clamp(wanted, 0.0, std::min(1.0, allowed));
  // Spread over the time to the next one, and no steeper than a hold.
  const double change = std::abs(wanted - present);
  if (change < kLeastChange) return;
  last_rate_change_ = now;
  const double even_ms = static_cast<double>(ThreadControl::kPeriod.count()) / 1e6 / std::max(change, 1e-3);
  const auto ramp = std::chrono::milliseconds{std::llround(std::min(even_ms, 500.0))};
  rate_.request(wanted, std::max(ramp, machine_.stop.hold_ramp), now);
}

void Runner::lose_thread(double turns) {
  thread_lost_ =
      say("the thread is lost: the tool is %1 turns from the spindle's angle; a spindle may be a "
          "tenth faster than S",
          printed("%.2f", std::abs(turns)));
}

std::optional<double> Runner::thread_rate(BusTime now) {
  const double behind = follower_.behind(now + ThreadControl::kAhead, rate_.tau(now + ThreadControl::kAhead));
  if (std::abs(behind) > ThreadControl::kLost_turns) {
    lose_thread(behind);
    return std::nullopt;
  }
  return follower_.ratio(now + ThreadControl::kAhead + ThreadControl::kPeriod / 2) +
         behind / follower_.planned_turns_per_s() / ThreadControl::kCatchUp_s;
}

}  // namespace kinebus
