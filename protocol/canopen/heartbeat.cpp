#include "protocol/canopen/heartbeat.hpp"

#include <algorithm>

namespace kinebus {

void HeartbeatProducer::set_period(std::chrono::milliseconds period, LocalTime now) {
  period_ = period;
  due_ = now;
}

std::optional<CanFrame> HeartbeatProducer::next_frame(LocalTime now, NmtState state, std::uint8_t node) {
  if (period_.count() == 0 || now < due_) return std::nullopt;
  due_ = std::max(due_ + period_, now + period_ / 2);  // after a pause: no burst
  return heartbeat_frame(state, node);
}

bool HeartbeatConsumer::configure(std::size_t place, std::uint32_t entry) {
  if (place >= kCapacity) return false;
  const auto node = static_cast<std::uint8_t>((entry >> 16) & 0x7F);
  const std::chrono::milliseconds time{entry & 0xFFFF};
  if (node != 0 && time.count() != 0)
    for (std::size_t i = 0; i < kCapacity; ++i)
      if (i != place && watches_[i].node == node) return false;
  watches_[place] = {};
  if (node != 0 && time.count() != 0)
    watches_[place] = {.node = node, .time = time, .health = Health::kUnknown};
  return true;
}

std::optional<HeartbeatConsumer::Event> HeartbeatConsumer::on_frame(LocalTime now, const CanFrame& frame) {
  const auto beat = decode_heartbeat(frame);
  if (!beat) return std::nullopt;
  const auto watch =
      std::find_if(watches_.begin(), watches_.end(), [&](const Watch& w) { return w.node == beat->node; });
  if (watch == watches_.end()) return std::nullopt;
  const Watch before = *watch;
  watch->due = now + watch->time;
  watch->state = beat->state;
  watch->health = Health::kAlive;
  if (beat->state == NmtState::kInitialising) return Event{Event::Kind::kBootUp, beat->node, beat->state};
  if (before.health != Health::kAlive) return Event{Event::Kind::kStarted, beat->node, beat->state};
  if (before.state != beat->state) return Event{Event::Kind::kStateChanged, beat->node, beat->state};
  return std::nullopt;
}

std::optional<HeartbeatConsumer::Event> HeartbeatConsumer::on_time(LocalTime now) {
  for (Watch& watch : watches_) {
    if (watch.health != Health::kAlive || now < watch.due) continue;
    watch.health = Health::kLost;
    return Event{Event::Kind::kLost, watch.node, watch.state};
  }
  return std::nullopt;
}

LocalTime HeartbeatConsumer::next_deadline() const {
  LocalTime earliest = kNever;
  for (const Watch& watch : watches_)
    if (watch.health == Health::kAlive) earliest = std::min(earliest, watch.due);
  return earliest;
}

HeartbeatConsumer::Health HeartbeatConsumer::health(std::uint8_t node) const {
  for (const Watch& watch : watches_)
    if (watch.node == node && node != 0) return watch.health;
  return Health::kUnwatched;
}

NmtState HeartbeatConsumer::state(std::uint8_t node) const {
  for (const Watch& watch : watches_)
    if (watch.node == node && node != 0) return watch.state;
  return NmtState::kInitialising;
}

}  // namespace kinebus
