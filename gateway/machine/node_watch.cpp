#include "gateway/machine/node_watch.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// A status frame is at most so old when it comes.
constexpr BusTime kFrameDelay = 50ms;

Sentence name_of(const NodeLink& link) {
  return say("node %1", link.id());
}

}  // namespace

bool NodeWatch::is_of_absence(StopReason reason) {
  return reason == StopReason::kStarved || reason == StopReason::kGatewayLost ||
         reason == StopReason::kSyncLost || reason == StopReason::kPeer;
}

void NodeWatch::on_time(BusTime now, bool streaming) {
  if (!streaming) streaming_since_ = now;
}

NodeWatch::Verdict NodeWatch::look(BusTime now, std::size_t node, const Situation& situation) {
  // Nodes that move tell how far they are: one that does not is dead, and its carriages stand while others go
  // on.
  NodeLink& link = links_[node];
  const bool judged = link.functions().has_axes() && now - streaming_since_ > kStatusTimeout;
  // So do those whose carriages home: with one that is dead the others must not go on.
  const BusTime timeout =
      judged || situation.homes ? kStatusTimeout : BusTime{machine_.bus.heartbeat_timeout};
  Verdict verdict;
  take_emergencies(now, link, situation, verdict);
  const bool watched =
      situation.state != MachineState::kOff && situation.state != MachineState::kBringUp && !needs_bring_up_;
  if (!watched) return verdict;
  if (link.take_boot_up()) {
    needs_bring_up_ = true;
    verdict.stop = verdict.fault = true;
    verdict.by_absence = false;
    verdict.positions_lost = link.functions().has_axes();
    events_.alarm(now, AlarmCode::kNodeRestarted, say("%1 has restarted", name_of(link)), link.id());
  } else if (const BusTime heard = std::max(link.last_heard(), listens_since_);
             now - (judged ? std::max(heard, streaming_since_) : heard) > timeout) {
    needs_bring_up_ = true;
    verdict.stop = verdict.fault = true;
    verdict.by_absence = false;
    events_.alarm(now, AlarmCode::kHeartbeatLost, say("%1 is silent", name_of(link)), link.id());
  } else if (link.nmt_state() == NmtState::kStopped || link.nmt_state() == NmtState::kPreOperational) {
    needs_bring_up_ = true;
    verdict.stop = verdict.fault = true;
    verdict.by_absence = false;
    events_.alarm(now, AlarmCode::kNodeChanged,
                  say("%1 was taken out of operation by an NMT command of another device", name_of(link)),
                  link.id());
  } else if (link.functions().has_axes() && link.drive_known()) {
    check_drives(now, link, situation, verdict);
  }
  return verdict;
}

void NodeWatch::check_drives(BusTime now, const NodeLink& link, const Situation& situation,
                             Verdict& verdict) {
  for (const JointDescription& joint : machine_.joints) {
    if (joint.node_id != link.id() || verdict.stop) continue;
    const std::size_t axis = joint.axis & 1u;
    const std::uint16_t word = link.statusword(axis);
    constexpr auto kMode = static_cast<std::int8_t>(cia402::Mode::kInterpolatedPosition);
    const bool told_at_rest =
        situation.rests_since && link.drive_told() > *situation.rests_since + kFrameDelay;
    const std::uint8_t number = joint.axis + 1u;
    Sentence words;
    if (situation.enabled && link.drive_state(axis) != cia402::State::kOperationEnabled) {
      words = say("%1: the drive of axis %2 was switched off by another device or a fault (statusword %3)",
                  name_of(link), number, printed("%04Xh", static_cast<unsigned>(word)));
      // A motor without current may have been turned; the node says so when it is asked again.
      verdict.positions_lost = true;
    } else if (situation.follows && link.mode(axis) != kMode) {
      words = say("%1: axis %2 was set to the mode of operation %3 by another device", name_of(link), number,
                  link.mode(axis));
    } else if (told_at_rest && (word & cia402::status::kTargetReached) == 0) {
      words = say("%1: axis %2 moves, and not by this gateway", name_of(link), number);
    } else {
      continue;
    }
    verdict.stop = verdict.fault = verdict.stream_lost = true;
    verdict.by_absence = false;
    events_.alarm(now, AlarmCode::kNodeChanged, std::move(words), link.id());
  }
}

void NodeWatch::take_emergencies(BusTime now, NodeLink& link, const Situation& situation, Verdict& verdict) {
  while (const auto emergency = link.next_emergency()) {
    if (emergency->code == emcy::kNoError) continue;
    const AlarmText text = describe_emergency(*emergency);
    events_.push({.kind = MachineEvent::Kind::kAlarm,
                  .when = now,
                  .code = emergency->code,
                  .node = emergency->node,
                  .words = text.words,
                  .advice = text.advice});
    const auto reason = static_cast<StopReason>(emergency->vendor[0] & 0x7F);
    if (reason == StopReason::kNone || situation.bringing_up || situation.state == MachineState::kOff)
      continue;
    verdict.stream_lost = verdict.stream_lost || reason == StopReason::kStarved ||
                          reason == StopReason::kSequenceError || reason == StopReason::kCheckpointError ||
                          reason == StopReason::kStreamError;
    verdict.by_absence = (verdict.by_absence || !verdict.stop) && is_of_absence(reason);
    verdict.stop = true;
    verdict.fault = verdict.fault || reason == StopReason::kAxisFault;
  }
}

/// Path time at rest is the same number everywhere, and clocks stay synchronised as long as anything moves.
bool NodeWatch::check_clock(BusTime now, const NodeLink& link, const StreamStatus& status, Verdict& verdict) {
  if ((status.flags & StreamStatus::kSynchronised) == 0) {
    events_.alarm(now, AlarmCode::kSyncError,
                  say("%1 has lost the synchronisation of its clock", name_of(link)), link.id());
    verdict.stop = verdict.by_absence = true;
    return false;
  }
  const bool rested = rate_.at_rest(now) && rate_.rate(now - kFrameDelay) == 0;
  const std::int64_t units = rate_.tau(now).count() / kPathTicksPerUnit;
  const std::int64_t told = status.path_near(units);
  if (!rested || told == units) return true;
  events_.alarm(
      now, AlarmCode::kPathTimeDiffers,
      say("%1 rests at another path time than the gateway: %2 us apart", name_of(link), (told - units) * 16),
      link.id());
  needs_bring_up_ = true;
  verdict.stop = verdict.fault = true;
  return false;
}

/// The nodes put records in order; what exchanges them may lose others.
void NodeWatch::tell_order(BusTime now, const NodeLink& link, const StreamStatus& status) {
  if (told_order_ || (status.flags & StreamStatus::kReordered) == 0) return;
  told_order_ = true;
  events_.message(now, say("frames reach %1 in another order than they were sent; it puts them right. A USB "
                           "adapter does that: "
                           "gs_usb keeps the order from Linux 6.6 on, candleLight's firmware from 2.0 on",
                           name_of(link)));
}

NodeWatch::Verdict NodeWatch::take_stream(BusTime now, NodeLink& link, const StreamStatus& status,
                                          bool stopping) {
  Verdict verdict;
  const PathTime tau = rate_.tau(now);
  if (stopping) {
    // What the nodes have taken before they stopped is told but once, and counts when the run goes on.
    verdict.stream_lost = !group_.on_status(now, link.id(), status, tau);
    return verdict;
  }
  tell_order(now, link, status);
  if (!check_clock(now, link, status, verdict)) return verdict;
  const auto taken = group_.on_status(now, link.id(), status, tau);
  if (taken) return verdict;
  using Kind = StreamError::Kind;
  const Kind kind = taken.error().kind;
  counters_.sequence_errors += kind == Kind::kSequence || kind == Kind::kSilent ? 1 : 0;
  counters_.checkpoint_errors += kind == Kind::kCheckpoint || kind == Kind::kTakenOtherwise ? 1 : 0;
  counters_.underruns += kind == Kind::kUnderrun ? 1 : 0;
  events_.alarm(now, AlarmCode::kStreamLost, to_string(taken.error()), link.id(), taken.error().line);
  verdict.stream_lost = verdict.stop = true;
  verdict.by_absence = kind == Kind::kUnderrun;
  return verdict;
}

}  // namespace kinebus
