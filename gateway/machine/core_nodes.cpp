// What the nodes' news mean for the machine.

#include <algorithm>
#include <utility>

#include "gateway/machine/core.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A status frame is at most so old when it comes.
constexpr BusTime kFrameDelay = 50ms;
/// A node that executes records sends its status every 100 to 120 ms; one of two may be late or lost.
constexpr BusTime kStatusTimeout = 250ms;

}  // namespace

// --------------------------------------------------------------------------------------------

void Gateway::Core::watch_nodes() {
  // Nodes that move tell how far they are: one that does not is dead, and its carriages stand while others go
  // on.
  const bool streaming = streams_flow() && runner_->active() && !runner_->suspended() && rate_.rate(now_) > 0;
  if (!streaming) streaming_since_ = now_;
  const bool judged = now_ - streaming_since_ > kStatusTimeout;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    NodeLink& link = links_[i];
    // So do those whose carriages home: with one that is dead the others must not go on.
    const bool tells =
        judged || (state_ == MachineState::kHoming && homing_.reports(i, now_ - kStatusTimeout));
    const BusTime timeout = tells ? kStatusTimeout : BusTime{machine_.bus.heartbeat_timeout};
    take_emergencies(link);
    const bool watched = state_ != MachineState::kOff && state_ != MachineState::kBringUp && !need_bring_up_;
    if (!watched) continue;
    const auto name = [&] { return say("node %1", link.id()); };
    if (link.take_boot_up()) {
      need_bring_up_ = true;
      homed_ = false;
      alarm(AlarmCode::kNodeRestarted, say("%1 has restarted", name()), link.id());
      stop_all(true);
    } else if (now_ - (judged ? std::max(link.last_heard(), streaming_since_) : link.last_heard()) >
               timeout) {
      need_bring_up_ = true;
      alarm(AlarmCode::kHeartbeatLost, say("%1 is silent", name()), link.id());
      stop_all(true);
    }
  }
}

void Gateway::Core::take_emergencies(NodeLink& link) {
  while (const auto emergency = link.next_emergency()) {
    if (emergency->code == emcy::kNoError) continue;
    const AlarmText text = describe_emergency(*emergency);
    events_.push({.kind = MachineEvent::Kind::kAlarm,
                  .when = now_,
                  .code = emergency->code,
                  .node = emergency->node,
                  .words = text.words,
                  .advice = text.advice});
    const auto reason = static_cast<StopReason>(emergency->vendor[0] & 0x7F);
    if (reason == StopReason::kNone || bring_up_.busy() || state_ == MachineState::kOff) continue;
    const bool lost = reason == StopReason::kStarved || reason == StopReason::kSequenceError ||
                      reason == StopReason::kCheckpointError || reason == StopReason::kStreamError;
    stream_lost_ = stream_lost_ || lost;
    stop_all(reason == StopReason::kAxisFault);
  }
}

/// Path time at rest is the same number everywhere, and clocks stay synchronised as long as anything moves.
bool Gateway::Core::check_clock(const NodeLink& link, const StreamStatus& status) {
  const auto name = [&] { return say("node %1", link.id()); };
  if ((status.flags & StreamStatus::kSynchronised) == 0) {
    alarm(AlarmCode::kSyncError, say("%1 has lost the synchronisation of its clock", name()), link.id());
    stop_all(false);
    return false;
  }
  const bool rested = rate_.at_rest(now_) && rate_.rate(now_ - kFrameDelay) == 0;
  const auto units = static_cast<std::uint32_t>(rate_.tau(now_).count() / kPathTicksPerUnit);
  if (!rested || status.path_units == units) return true;
  alarm(AlarmCode::kPathTimeDiffers,
        say("%1 rests at another path time than the gateway: %2 us apart", name(),
            std::int64_t{static_cast<std::int32_t>(status.path_units - units)} * 16),
        link.id());
  need_bring_up_ = true;
  stop_all(true);
  return false;
}

void Gateway::Core::take_stream_status(NodeLink& link) {
  const auto status = link.take_stream();
  if (!status || !runner_->active() || runner_->suspended() || stream_lost_) return;
  if (state_ == MachineState::kStopping || state_ == MachineState::kStopped) {
    // What the nodes have taken before they stopped is told but once, and counts when the run goes on.
    stream_lost_ = !group_.on_status(now_, link.id(), *status, rate_.tau(now_));
    return;
  }
  if (!streams_flow() || !check_clock(link, *status)) return;
  const auto taken = group_.on_status(now_, link.id(), *status, rate_.tau(now_));
  if (taken) return;
  using Kind = StreamError::Kind;
  const Kind kind = taken.error().kind;
  counters_.sequence_errors += kind == Kind::kSequence || kind == Kind::kSilent ? 1 : 0;
  counters_.checkpoint_errors += kind == Kind::kCheckpoint ? 1 : 0;
  counters_.underruns += kind == Kind::kUnderrun ? 1 : 0;
  stream_lost_ = true;
  alarm(AlarmCode::kStreamLost, to_string(taken.error()), link.id(), taken.error().line);
  stop_all(false);
}

}  // namespace kinebus
