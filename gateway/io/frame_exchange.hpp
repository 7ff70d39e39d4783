#pragma once
// What a turn of the loop does for the bus: frames that came, SYNC, the core's work, frames that go.

#include "gateway/io/bus_port.hpp"
#include "gateway/io/event_loop.hpp"

namespace kinebus {

/// Frames taken in one turn, so that a flooded bus cannot keep the loop from its deadlines.
inline constexpr int kFramesPerTurn = 256;

template <typename Core>
void send_frames(EventLoop& loop, BusPort& bus, Core& core) {
  LocalTime now = loop.now();
  while (bus.can_send(now)) {
    const auto frame = core.next_frame(now);
    if (!frame) break;
    bus.send(now, *frame);
    now = loop.now();
  }
}

/// `core`: the Gateway, or what has its words.
template <typename Core>
void exchange_frames(EventLoop& loop, BusPort& bus, Core& core) {
  for (int i = 0; i < kFramesPerTurn; ++i) {
    const auto received = bus.receive(loop.now());
    if (!received) break;
    switch (received->kind) {
      case BusPort::Received::Kind::kFrame:
        core.on_frame(received->when, received->frame);
        break;
      case BusPort::Received::Kind::kSent:
        core.on_frame_sent(received->when, received->frame);
        break;
      case BusPort::Received::Kind::kFailure:
        core.on_bus_failure(received->when, received->failure);
        break;
    }
  }
  // Nodes learn the time from it: it does not wait until the next piece of the path is planned.
  if (loop.now() >= core.sync_due()) send_frames(loop, bus, core);
  if (const LocalTime now = loop.now(); now >= core.next_deadline()) core.on_time(now);
  send_frames(loop, bus, core);
}

}  // namespace kinebus
