// Frames in and out of the gateway.

#include "gateway/machine/core.hpp"
#include "protocol/can/bit_length.hpp"
#include "protocol/canopen/cob_id.hpp"

namespace kinebus {
namespace {

/// Frames that only a gateway sends.
bool is_of_a_gateway(const CanFrame& frame) {
  return !frame.extended && (frame.id == cob_id::kSync || frame.id == kRateCobId ||
                             frame.id == kSyncStampCobId || frame.id == cob_id::kHeartbeat + kGatewayNodeId);
}

}  // namespace

void Gateway::Core::on_frame(BusTime when, const CanFrame& frame) {
  now_ = std::max(now_, when);
  ++counters_.frames_received;
  load_.add(when, bit_length(frame));
  if (is_of_a_gateway(frame)) {
    ++counters_.foreign_frames;
    if (bring_up_.busy()) {
      bring_up_.on_foreign_gateway();
    } else if (state_ != MachineState::kOff && state_ != MachineState::kAlarm && !fault_) {
      alarm(AlarmCode::kSecondGateway, say("another gateway has begun to speak on this bus"));
      stop_all(true);
    }
    return;
  }
  // Path time first: every node that heard this EMCY has begun to count.
  if (const auto request = decode_stop_request(frame, when); request && speaking_) {
    rate_.on_stop_request(*request, now_);
    if (!bring_up_.busy()) stop_all(false);
  }
  for (NodeLink& link : links_) {
    if (!link.on_frame(when, frame)) continue;
    take_stream_status(link);
    return;
  }
  if (cob_id::node_of(frame.id, cob_id::kHeartbeat) != 0)
    ++counters_.foreign_frames;
  else
    ++counters_.malformed_frames;
}

void Gateway::Core::on_frame_sent(BusTime when, const CanFrame& frame) {
  now_ = std::max(now_, when);
  ++counters_.frames_sent;
  load_.add(when, bit_length(frame));
  sync_.on_frame_sent(when, frame);
  rate_.on_frame_sent(when, frame);
}

std::optional<CanFrame> Gateway::Core::next_frame(BusTime now) {
  now_ = std::max(now_, now);
  if (const auto frame = rate_.next_frame(now)) return frame;
  if (const auto frame = rate_.next_repeat(now)) return frame;
  if (speaking_) {
    if (const auto frame = sync_.next_frame(now)) return frame;
    if (const auto frame = heartbeat_.next_frame(now, NmtState::kOperational, kGatewayNodeId)) return frame;
  }
  if (const auto frame = bring_up_.next_frame()) return frame;
  for (NodeLink& link : links_)
    if (const auto frame = link.next_frame(now)) return frame;
  if (!streams_flow()) return std::nullopt;
  const auto frame = group_.next_frame(now, rate_.tau(now));
  if (frame) ++counters_.segments_sent;
  return frame;
}

BusTime Gateway::Core::next_deadline() const {
  using namespace std::chrono_literals;
  BusTime wait = 100ms;
  switch (state_) {
    case MachineState::kChecking:
      wait = 1ms;
      break;
    case MachineState::kRunning:
    case MachineState::kMoving:
    case MachineState::kHolding:
    case MachineState::kCancelling:
    case MachineState::kStopping:
      wait = 5ms;
      break;
    case MachineState::kBringUp:
    case MachineState::kHoming:
      wait = 10ms;
      break;
    default:
      if (standstill_.busy() || clearing_) wait = 10ms;
      break;
  }
  // From when time was served, not from the last frame: no flood of frames puts it off.
  BusTime due = std::max(served_ + wait, now_ + BusTime{1});
  if (!speaking_) return due;
  // What is due already waits for the bus, not for time: it is pulled when a frame can be sent.
  for (const BusTime deadline : {sync_.next_deadline(), heartbeat_.next_deadline(), rate_.next_deadline()})
    if (deadline > now_) due = std::min(due, deadline);
  return due;
}

}  // namespace kinebus
