#include "vcan_tests/campaign/bus_faults.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using enum FaultKind;

/// Share of the frames that are struck: from one in 300 to one in 5.
double share_of(const Fault& fault) {
  return 0.003 + 0.2 * fault.strength * fault.strength;
}

}  // namespace

bool ReceiverFaults::concerns(FaultKind kind) {
  return kind == kReceiveOverrun || (kind >= kFramesDropped && kind <= kFramesCorrupted) ||
         kind == kLateStatus || kind == kWrongParameters || kind == kHeatNodeOffBus;
}

void ReceiverFaults::on_arrival(int station, std::vector<VirtualMachine::Arrival>& arrivals) {
  if (fault_.kind == kLateStatus) {
    if (station != VirtualMachine::kGatewayStation) return;
    // All of them later by the same, in their order: a receive thread that is held up.
    for (auto& arrival : arrivals)
      arrival.at += 2ms + BusTime{static_cast<std::int64_t>(80e6 * fault_.strength)};
    return;
  }
  if (fault_.kind == kWrongParameters) {
    CanFrame& frame = arrivals[0].frame;
    const bool fingerprint = cob_id::node_of(frame.id, cob_id::kSdoReply) == fault_.node + 1 &&
                             get_u16_le(std::span(frame.data).subspan(1)) == object::kFingerprint.index;
    if (station == VirtualMachine::kGatewayStation && fingerprint && !keeps_parameters(fault_))
      frame.data[4] ^= 0x40;
    return;
  }
  if (station != fault_.node) return;
  if (fault_.kind == kHeatNodeOffBus) return arrivals.clear();
  if (fault_.kind == kReceiveOverrun) {
    overruns_ += static_cast<std::uint32_t>(arrivals.size());
    arrivals.clear();
    return;
  }
  if (kept_ && fault_.kind == kFramesReordered) {
    kept_->at = arrivals.back().at;
    arrivals.push_back(*kept_);
    kept_.reset();
    return;
  }
  if (unit(random_) >= share_of(fault_)) return;
  switch (fault_.kind) {
    case kFramesDropped:
      arrivals.clear();
      break;
    case kFramesDelayed:
      arrivals[0].at +=
          between(random_, 50us, 200us + BusTime{static_cast<std::int64_t>(8e6 * fault_.strength)});
      break;
    case kFramesDoubled:
      arrivals.push_back(arrivals[0]);  // an error in the last bit of the end of frame: sent again at once
      break;
    case kFramesReordered:
      kept_ = arrivals[0];
      arrivals.clear();
      break;
    case kFramesCorrupted:
      if (arrivals[0].frame.length > 0) {
        const std::size_t byte = random_() % arrivals[0].frame.length;
        arrivals[0].frame.data[byte] =
            static_cast<std::uint8_t>(arrivals[0].frame.data[byte] ^ (1u << (random_() % 8)));
      }
      break;
    default:
      break;
  }
}

std::uint32_t ReceiverFaults::take_overruns() {
  return std::exchange(overruns_, 0u);
}

bool WireFaults::concerns(FaultKind kind) {
  return kind == kBitErrors || kind == kBusOff || kind == kHeatNodeOffBus;
}

bool WireFaults::destroys(BusModel::Port from) {
  if (fault_.kind == kBusOff || fault_.kind == kHeatNodeOffBus)
    return from == victim_;  // its transmitter sends nonsense
  return unit(random_) < 0.0005 + 0.05 * fault_.strength;
}

bool Stranger::concerns(FaultKind kind) {
  return kind == kBabblerAbove || kind == kBabblerBelow || kind == kForeignTraffic ||
         kind == kNodeIdCollision;
}

Stranger::Stranger(const Fault& fault, std::uint64_t seed, VirtualMachine& machine, std::uint8_t taken_id)
    : fault_(fault), random_(seed), machine_(machine), port_(machine.add_stranger(3)), taken_id_(taken_id) {}

CanFrame Stranger::next_foreign_frame() {
  constexpr std::uint8_t kForeignNode = 0x31;
  ++count_;
  switch (random_() % 6) {
    case 0:
      return CanFrame::make(cob_id::kHeartbeat + kForeignNode, {5});
    case 1:
      return CanFrame::make(0x180 + kForeignNode, {count_, 2, 3, 4, 5, 6, 7, 8});
    case 2:
      return CanFrame::make(0x600 + kForeignNode, {0x40, 0x41, 0x60, 0, 0, 0, 0, 0});
    case 3:
      return CanFrame::make(0x580 + kForeignNode, {0x4B, 0x41, 0x60, 0, count_, 0, 0, 0});
    case 4:
      return CanFrame::make(0x080 + kForeignNode, {0x10, 0x81, 0x11, 0, 0, 0, 0, 0});
    default:
      return CanFrame::make(0x480 + kForeignNode, {count_});
  }
}

void Stranger::on_time(BusTime now) {
  BusModel& bus = machine_.bus_for_faults();
  if (fault_.kind == kBabblerAbove || fault_.kind == kBabblerBelow) {
    const std::uint32_t id = fault_.kind == kBabblerAbove ? 0x001 : 0x7FF;
    while (bus.has_room(port_)) bus.send(port_, now, CanFrame::make(id, {1, 2, 3, 4, 5, 6, 7, 8}));
    return;
  }
  if (now < next_ || !bus.has_room(port_)) return;
  if (fault_.kind == kForeignTraffic) {
    next_ = now + between(random_, 1ms, 12ms);
    bus.send(port_, now, next_foreign_frame());
    return;
  }
  // A node with an id that is taken: boots, then lives.
  next_ = now + 500ms;
  const auto state = static_cast<std::uint8_t>(count_++ == 0 ? 0 : 0x7F);
  bus.send(port_, now, CanFrame::make(cob_id::kHeartbeat + taken_id_, {state}));
}

void SecondGateway::start(BusTime now) {
  gateway_.on_time(now);
  static_cast<void>(gateway_.carry_out(command::BringUp{}));
  serve(now);
}

void SecondGateway::on_frame(const NodeMachine::Received& received) {
  if (received.from == port_)
    gateway_.on_frame_sent(received.when, received.frame);
  else
    gateway_.on_frame(received.when, received.frame);
  serve(received.when);
}

void SecondGateway::on_time(BusTime now) {
  gateway_.on_time(now);
  serve(now);
}

void SecondGateway::serve(BusTime now) {
  BusModel& bus = machine_.bus_for_faults();
  while (bus.has_room(port_)) {
    const auto frame = gateway_.next_frame(now);
    if (!frame) break;
    bus.send(port_, now, *frame);
  }
  while (gateway_.next_event()) {
  }
}

}  // namespace kinebus
