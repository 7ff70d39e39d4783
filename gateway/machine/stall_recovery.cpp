#include "gateway/machine/stall_recovery.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// What the nodes did meanwhile is known so long after a stall.
constexpr BusTime kHeardWithin = 2s;
/// Everything that is wrong has been told.
constexpr BusTime kQuiet = 1s;
/// A computer on which this comes again and again needs a person; one that ran so long in between does not.
constexpr int kMostInARow = 5;
constexpr BusTime kRow = 10min;

}  // namespace

void StallRecovery::on_stall(BusTime now, BusTime length, const Sentence& why) {
  if (now - stall_end_ > kRow) in_a_row_ = 0;
  stalled_ = true;
  stall_end_ = now;
  events_.message(now, say("the gateway did not run for %1 s: %2", printed("%.2f", to_seconds(length)), why));
}

void StallRecovery::on_stop(BusTime now, bool by_absence) {
  const bool first = doing_ != Doing::kStopped;
  const bool mine = by_absence && stalled_ && now - stall_end_ < kHeardWithin;
  if (!mine)
    doing_ = Doing::kNothing;
  else if (first && !stopping_)
    doing_ = Doing::kStopped;
  stopping_ = true;
}

void StallRecovery::commanded() {
  doing_ = Doing::kNothing;
  in_a_row_ = 0;
}

StallRecovery::Step StallRecovery::next(BusTime now, BusTime since, bool stopped) {
  if (!stopped) stopping_ = false;
  if (doing_ == Doing::kNothing || !wanted_) return Step::kNone;
  if (stopped) {
    if (doing_ != Doing::kStopped || now - since < kQuiet) return Step::kNone;
    if (++in_a_row_ > kMostInARow) {
      doing_ = Doing::kNothing;
      events_.message(now, say("the gateway was away %1 times: the job waits for a person", kMostInARow));
      return Step::kNone;
    }
    doing_ = Doing::kCleared;
    return Step::kClear;
  }
  if (doing_ != Doing::kCleared) return Step::kNone;
  doing_ = Doing::kNothing;
  return Step::kGoOn;
}

}  // namespace kinebus
