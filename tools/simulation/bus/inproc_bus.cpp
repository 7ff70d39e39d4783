#include "tools/simulation/bus/inproc_bus.hpp"

#include "tools/simulation/bus/virtual_nodes.hpp"

namespace kinebus {
namespace {
// Crystals as real boards have them, so that clock synchronisation has something to do.
constexpr VirtualClocks kClocks{.drift_ppm = 25,
                                .latency_max = std::chrono::microseconds{20},
                                .offset_max = std::chrono::milliseconds{900}};
// Carriages that stand beside their switches would wake the process some thousand times a second.
constexpr BusTime kBetweenLooks = std::chrono::milliseconds{2};
}  // namespace

InprocBus::InprocBus(const MachineDescription& machine, LocalTime now, std::uint64_t seed)
    : start_(now), machine_(virtual_machine_of(machine, kClocks, seed)) {}

void InprocBus::advance(LocalTime now) {
  looked_ = now - start_;
  for (bool done = false; !done;) {
    done = machine_->advance(now - start_);
    while (const auto got = machine_->receive())
      received_.push_back(
          {got->own ? Received::Kind::kSent : Received::Kind::kFrame, start_ + got->when, got->frame, {}});
  }
}

LocalTime InprocBus::next_deadline() const {
  if (!received_.empty()) return LocalTime{0};
  const BusTime next = machine_->next_event(looked_ + kBetweenLooks);
  return next == BusTime::max() ? LocalTime::max() : start_ + next;
}

bool InprocBus::can_send(LocalTime now) {
  advance(now);
  return machine_->can_send();
}

void InprocBus::send(LocalTime now, const CanFrame& frame) {
  machine_->send(now - start_, frame);
}

std::optional<BusPort::Received> InprocBus::receive(LocalTime now) {
  if (received_.empty()) advance(now);
  if (received_.empty()) return std::nullopt;
  Received next = received_.front();
  received_.pop_front();
  return next;
}

}  // namespace kinebus
