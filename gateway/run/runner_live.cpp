// Commands that come one by one, from a person or a print host: when a run of them begins, and when it is
// brought to rest.

#include <algorithm>

#include "gateway/run/runner.hpp"

namespace kinebus {
namespace {

/// Live commands: a run under way is brought to a planned stop when less than this is left to move and no
/// line came for a while, or when less than the second is left: the stop is in the nodes long before their
/// reserve (120 ms) begins.
constexpr double kLiveReserve_s = 0.6;
constexpr double kLiveLast_s = 0.35;
constexpr BusTime kLiveQuiet = std::chrono::milliseconds{30};
/// A run begins when no line came for a while, unless enough of it is known before: a stream of short moves
/// then begins as one.
constexpr BusTime kLiveGather = std::chrono::milliseconds{100};

/// Of the motion ahead so much is known for good while a run is under way, or lines are taken beyond the
/// lead: a stop that nobody asked for is not needed then.
constexpr double kLiveFinal_s = kLiveReserve_s + 0.4;
/// So much before the lead is full no more is taken: the end of a line and the way out of its ramp fit in.
constexpr double kLiveMargin_s = 0.25;
/// Commands taken while the machine has to come to rest before them.
constexpr std::size_t kLiveBehindRest = 4;

}  // namespace

void Runner::start_live(const Pose& start) {
  pipeline_.start_live(start);
  start_ = start;
  noted_ = false;
  begin();
  live_ = true;
  doing_ = say("waiting for lines");
}

void Runner::add(BusTime now, const canonical::Line& line) {
  // How a print host begins: what it has printed before is off the table.
  if (printed_ != nullptr && std::holds_alternative<canonical::Home>(line.command)) printed_->clear();
  pipeline_.add(line);
  last_added_ = now;
}

std::size_t Runner::live_room(BusTime now, std::size_t most) {
  const std::size_t waiting = pipeline_.waiting();
  if (pipeline_.rest_first()) return kLiveBehindRest - std::min(kLiveBehindRest, waiting);
  const Planner::Ahead planned = pipeline_.ahead();
  double given = feed_.pending_s();
  if (feed_.streaming()) given += std::max(0.0, live_left_s(now));
  const bool enough = !feed_.streaming() || given + planned.final_s >= kLiveFinal_s;
  // At half the rate the same motion takes twice as long.
  const double lead_s = (machine_.serial.lead_s - kLiveMargin_s) * std::min(1.0, override_);
  if (enough && given + planned.all_s >= lead_s) return 0;
  return most - std::min(most, waiting);
}

/// The pipeline has nothing more to give out before the next live command comes.
void Runner::settle_when_late(BusTime now) {
  if (!feed_.streaming()) {
    if (pipeline_.live_idle()) doing_ = say("waiting for lines");
    if (now - last_added_ >= kLiveGather) pipeline_.settle_live();
    return;
  }
  if (finished_ || !started_) {
    if (!finished_ && now - last_added_ >= kLiveGather) pipeline_.settle_live();
    return;
  }
  const double left = live_left_s(now);
  if (left >= kLiveReserve_s || (left >= kLiveLast_s && now - last_added_ < kLiveQuiet)) return;
  pipeline_.settle_live();
  ++counters_.live_stops;
}

/// Motion known and not yet carried out.
double Runner::live_left_s(BusTime now) const {
  return group_.sampler().end_s() - std::max(0.0, to_seconds(rate_.tau(now) - group_.run_start()));
}

}  // namespace kinebus
