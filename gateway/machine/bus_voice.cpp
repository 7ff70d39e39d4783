#include "gateway/machine/bus_voice.hpp"

#include <algorithm>

#include "protocol/can/bit_length.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

/// SYNC comes often until the clocks agree, and grows rare by steps: after a jump from 5 to 50 ms the line
/// through the window's old, dense end would hang on few recent samples. Latency 20 us, three nodes, worst
/// instant of a run in a hundred: 1.8 us apart with the jump, 1.0 us with these steps.
struct SyncPace {
  BusTime until;  ///< since SYNC began, or the last bring-up ended
  BusTime period;
};
constexpr SyncPace kSyncPaces[] = {{6s, 5ms}, {9s, 10ms}, {18s, 25ms}};

BusTime sync_period_at(BusTime age, BusTime usual) {
  for (const SyncPace& pace : kSyncPaces)
    if (age < pace.until) return std::min(pace.period, usual);
  return usual;
}

}  // namespace

BusVoice::BusVoice(const MachineDescription& machine, std::uint8_t epoch)
    : machine_(machine), sync_({.period = machine.bus.sync_period, .epoch = epoch}) {}

void BusVoice::begin(BusTime now) {
  if (speaks_) return;
  speaks_ = true;
  since_ = now;
  sync_.start(now);
  heartbeat_.set_period(machine_.bus.heartbeat_period, now);
}

void BusVoice::on_time(BusTime now, bool bringing_up) {
  load_.advance(now);
  const BusTime period = sync_period_at(bringing_up ? 0s : now - since_, machine_.bus.sync_period);
  if (period != sync_.period()) sync_.set_period(period, now);
}

void BusVoice::on_frame(BusTime when, const CanFrame& frame) {
  load_.add(when, bit_length(frame));
}

void BusVoice::on_frame_sent(BusTime when, const CanFrame& frame) {
  load_.add(when, bit_length(frame));
  sync_.on_frame_sent(when, frame);
}

std::optional<CanFrame> BusVoice::next_frame(BusTime now) {
  if (!speaks_) return std::nullopt;
  if (const auto frame = sync_.next_frame(now)) return frame;
  return heartbeat_.next_frame(now, NmtState::kOperational, kGatewayNodeId);
}

BusTime BusVoice::next_deadline(BusTime now, BusTime otherwise) const {
  // What is due already waits for the bus, not for time: it is pulled when a frame can be sent.
  for (const BusTime deadline : {sync_.next_deadline(), heartbeat_.next_deadline()})
    if (speaks_ && deadline > now) otherwise = std::min(otherwise, deadline);
  return otherwise;
}

}  // namespace kinebus
