#include "vcan_tests/campaign/injector.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "protocol/canopen/node_objects.hpp"
#include "tools/simulation/bus/virtual_nodes.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using enum FaultKind;

/// A wakeup that is late by so much at most: a computer that swaps.
constexpr double kSlowestWakeup_ns = 60e6;
/// 10 mm on a carriage.
constexpr double kFromSwitch_counts = 12'800;

}  // namespace

Injector::Injector(const MachineDescription& machine, const FaultPlan& plan)
    : description_(machine), plan_(plan), random_(plan.seed * 0xD1342543DE82EF95ULL + 7) {
  for (const Fault& fault : plan.faults) {
    Active active;
    active.fault = fault;
    active_.push_back(std::move(active));
  }
}

std::unique_ptr<NodeMachine> Injector::make_nodes() {
  const SimulationOptions usual;
  std::vector<VirtualNodeOptions> nodes = virtual_nodes_of(description_, usual.clocks, plan_.seed);
  // Not far from their switches, so that most of a run is the job.
  for (VirtualNodeOptions& node : nodes)
    for (VirtualAxis& axis : node.axes)
      if (axis.switch_input != 0)
        axis.start_counts =
            axis.switch_counts + (axis.active_above ? -1 : 1) * (0.3 + unit(random_)) * kFromSwitch_counts;
  for (const Fault& fault : plan_.faults) {
    VirtualNodeOptions& node = nodes[static_cast<std::size_t>(fault.node)];
    if (fault.kind == kCrystals)
      for (VirtualNodeOptions& each : nodes) each.clock_drift_ppm = 200 * unit(random_) - 100;
    if (fault.kind == kInterruptLatency)
      for (VirtualNodeOptions& each : nodes) each.latency_max = latency_of(fault);
    if (fault.kind == kWrongIdentity) node.node.identity.product_code ^= 0x0101;
    if (fault.kind == kSwitchesExchanged) exchange_switches(fault, nodes);
  }
  auto machine = std::make_unique<VirtualMachine>(nodes, plan_.seed);
  nodes_ = machine.get();
  return machine;
}

// The carriages of two nodes often stand at the same distance from their switches, as after an earlier
// homing: then each comes to its own one just when the other's is seen.
void Injector::exchange_switches(const Fault& fault, std::vector<VirtualNodeOptions>& nodes) const {
  VirtualAxis& one = nodes[static_cast<std::size_t>(fault.node)].axes[0];
  const bool carriages = fault.node < 2;
  if (!carriages || !between_nodes(fault))
    return std::swap(one.switch_input, nodes[static_cast<std::size_t>(fault.node)].axes[1].switch_input);
  VirtualAxis& other = nodes[static_cast<std::size_t>(1 - fault.node)].axes[0];
  std::swap(one.switch_input, other.switch_input);
  one.switch_node = 1 - fault.node;
  other.switch_node = fault.node;
  if (fault.strength < 0.7) other.start_counts = other.switch_counts + one.start_counts - one.switch_counts;
}

void Injector::attach(Simulation& simulation) {
  simulation_ = &simulation;
  for (Active& active : active_) {
    const Fault& fault = active.fault;
    if (ReceiverFaults::concerns(fault.kind))
      active.receiver = std::make_unique<ReceiverFaults>(fault, next_seed());
    if (WireFaults::concerns(fault.kind)) {
      const bool gateway = fault.strength < 0.3;
      active.wire = std::make_unique<WireFaults>(
          fault, next_seed(), gateway ? nodes_->gateway_port() : nodes_->node_port(fault.node));
    }
    if (Stranger::concerns(fault.kind))
      active.stranger = std::make_unique<Stranger>(
          fault, next_seed(), *nodes_, description_.nodes[static_cast<std::size_t>(fault.node)].id);
  }
  const auto any = [this](auto&& has) { return std::any_of(active_.begin(), active_.end(), has); };
  if (any([](const Active& a) { return a.receiver != nullptr; }))
    nodes_->set_arrival_hook([this](int station, std::vector<VirtualMachine::Arrival>& arrivals) {
      for (Active& active : active_)
        if (active.on && active.receiver && !arrivals.empty()) active.receiver->on_arrival(station, arrivals);
    });
  if (any([](const Active& a) { return a.wire != nullptr; }))
    nodes_->bus_for_faults().destroyed = [this](BusTime, BusModel::Port from, const CanFrame&) {
      bool gone = false;
      for (Active& active : active_) gone = (active.on && active.wire && active.wire->destroys(from)) || gone;
      return gone;
    };
  // Bounces first: what a switch that is dead or stuck shows is neither.
  std::vector<Fault> of_switches;
  for (const Active& active : active_) {
    if (active.fault.kind == kSwitchBounces) of_switches.insert(of_switches.begin(), active.fault);
    if (active.fault.kind == kSwitchDead || active.fault.kind == kSwitchStuck)
      of_switches.push_back(active.fault);
  }
  if (!of_switches.empty())
    nodes_->set_switch_hook(
        [this, of_switches](int node, int input, std::vector<VirtualMachine::Edge>& edges) {
          for (const Fault& fault : of_switches) disturb_switch(fault, node, input, edges);
        });
  simulation.on_turn = [this](BusTime now) { on_time(now); };
  simulation.on_received = [this](const NodeMachine::Received& received) {
    for (Active& active : active_) {
      if (active.on && active.stranger) active.stranger->on_time(received.when);
      if (active.on && active.second) active.second->on_frame(received);
    }
  };
  begin(FaultPhase::kFromPowerUp, BusTime{0});
}

void Injector::disturb_switch(const Fault& fault, int node, int input,
                              std::vector<VirtualMachine::Edge>& edges) {
  const auto& inputs = description_.nodes[static_cast<std::size_t>(node)].inputs;
  const bool active_level = !inputs[static_cast<std::size_t>(input - 1)].active_low;
  const VirtualMachine::Edge edge = edges[0];
  if (fault.kind == kSwitchBounces) {
    // Contacts chatter for up to 150 us: less than the debounce time of 160.
    BusTime at = edge.at;
    for (int i = 0; i < 2 + static_cast<int>(random_() % 4); ++i) {
      at += between(random_, 2us, 20us);
      edges.push_back({at, !edge.level});
      at += between(random_, 2us, 15us);
      edges.push_back({at, edge.level});
    }
    return;
  }
  const std::size_t joint =
      static_cast<std::size_t>(2 * fault.node + fault.axis) % description_.joints.size();
  const auto& homing = description_.joints[joint].homing;
  if (node == fault.node && homing && input == homing->switch_input)
    edges = {{edge.at, fault.kind == kSwitchStuck ? active_level : !active_level}};
}

void Injector::begin(FaultPhase phase, BusTime now) {
  for (Active& active : active_) {
    if (active.fault.phase != phase || active.from != BusTime::max()) continue;
    active.from = now + active.fault.after;
    if (phase != FaultPhase::kFromPowerUp) active.to = active.from + active.fault.length;
  }
}

bool Injector::cause_over(BusTime now) const {
  return std::all_of(active_.begin(), active_.end(), [&](const Active& active) {
    return active.fault.phase == FaultPhase::kFromPowerUp || active.over || now < active.from;
  });
}

void Injector::on_time(BusTime now) {
  for (Active& active : active_) {
    if (!active.on && !active.over && now >= active.from) {
      active.on = true;
      if (note)
        note(fmt::format("FAULT {} at node {} axis {} for {:.3f} ms, strength {:.2f}",
                         to_string(active.fault.kind), active.fault.node + 1, active.fault.axis,
                         1e3 * to_seconds(active.fault.length), active.fault.strength));
      turn_on(active, now);
    }
    if (active.on && now >= active.to) {
      active.on = false;
      active.over = true;
      turn_off(active, now);
      if (note) note(fmt::format("over: {}", to_string(active.fault.kind)));
    }
    if (active.on || active.over) serve(active, now);
  }
  measure_ramp(now);
}

void Injector::turn_on(Active& active, BusTime now) {
  const Fault& fault = active.fault;
  Gateway& gateway = simulation_->gateway();
  switch (fault.kind) {
    case kGatewayDies:
    case kHotGatewayDies:
      simulation_->kill_gateway();
      nodes_->bus_for_faults().clear(nodes_->gateway_port());
      stop_cause_ = now;
      break;
    case kNodeDies:
    case kNodeRestarts:
      nodes_->set_power(fault.node, now, false);
      stop_cause_ = now;
      break;
    case kNodeStalls:
      nodes_->set_stalled(fault.node, now, true);
      break;
    case kEmergencyStop:
      nodes_->set_input(fault.node, now, kEmergencyInput, true);
      stop_cause_ = pressed_ = now;
      break;
    case kDriveFault:
      nodes_->set_drive_fault(fault.node, now, fault.axis, true);
      stop_cause_ = now;
      break;
    case kHeatNodeDies:
      nodes_->set_power(fault.node, now, false);
      break;
    case kSensorOpen:
    case kSensorShorted:
    case kSensorLoose:
    case kHeaterLoose:
    case kHeaterStuck:
    case kHotEndFanStands:
    case kFilamentOut:
    case kFilamentJams:
      break_heat(fault, true);
      break;
    case kLostSteps: {
      const double counts = (fault.axis == 0 ? 1 : -1) * (20 + 2000 * fault.strength);
      nodes_->lose_steps(fault.node, fault.axis, counts);
      excused_counts_ = std::abs(counts);
      break;
    }
    case kWrongParameters:
      if (keeps_parameters(fault)) nodes_->write_parameter(fault.node, now, object::kStopRamp, 2, 20);
      break;
    case kSecondGateway:
      active.second = std::make_unique<SecondGateway>(description_, *nodes_);
      active.second->start(now);
      break;
    case kHold:
      if (gateway.carry_out(command::Hold{})) stop_cause_ = now;
      break;
    case kCancel:
      if (gateway.carry_out(command::Cancel{})) stop_cause_ = now;
      break;
    case kOperatorStop:
      static_cast<void>(gateway.carry_out(command::Stop{}));
      stop_cause_ = now;
      break;
    default:
      break;
  }
}

void Injector::break_heat(const Fault& fault, bool broken) {
  const std::string place = fault.axis == 0 ? "1" : "2";
  const auto what = [&]() -> std::string {
    switch (fault.kind) {
      case kSensorOpen:
        return "sensor " + place + (broken ? " open" : " ok");
      case kSensorShorted:
        return "sensor " + place + (broken ? " short" : " ok");
      case kSensorLoose:
        return "sensor " + place + (broken ? " loose" : " ok");
      case kHeaterLoose:
        return "heater " + place + (broken ? " loose" : " ok");
      case kHeaterStuck:
        return "heater " + place + (broken ? " stuck" : " ok");
      case kHotEndFanStands:
        return std::string("fan 1 ") + (broken ? "stalled" : "ok");
      case kFilamentOut:
        return std::string("filament ") + (broken ? "out" : "ok");
      default:
        return std::string("filament ") + (broken ? "jammed" : "ok");
    }
  };
  if (const std::string wrong = nodes_->heat_plant(fault.node).command(what()); !wrong.empty() && note)
    note(wrong);
}

void Injector::turn_off(Active& active, BusTime now) {
  const Fault& fault = active.fault;
  switch (fault.kind) {
    case kGatewayDies:
    case kHotGatewayDies:
      if (!simulation_->start_gateway(job ? job() : nullptr) && note) note("the journal was not taken up");
      break;
    case kNodeDies:
    case kNodeRestarts:
    case kHeatNodeDies:
      nodes_->set_power(fault.node, now, true);
      break;
    case kSensorOpen:
    case kSensorShorted:
    case kSensorLoose:
    case kHeaterLoose:
    case kHeaterStuck:
    case kHotEndFanStands:
    case kFilamentOut:
    case kFilamentJams:
      break_heat(fault, false);
      break;
    case kNodeStalls:
      nodes_->set_stalled(fault.node, now, false);
      break;
    case kEmergencyStop:
      nodes_->set_input(fault.node, now, kEmergencyInput, false);
      break;
    case kDriveFault:
      nodes_->set_drive_fault(fault.node, now, fault.axis, false);
      break;
    default:
      break;
  }
}

void Injector::serve(Active& active, BusTime now) {
  if (active.on && active.stranger) active.stranger->on_time(now);
  if (active.on && active.second) active.second->on_time(now);
  if (active.receiver) nodes_->count_overruns(active.fault.node, now, active.receiver->take_overruns());
  const bool off_bus = active.fault.kind == kHeatNodeOffBus;
  if (active.fault.kind != kBusOff && !off_bus) return;
  // A controller that was bus-off comes back by itself once its transmitter works again.
  BusModel& bus = nodes_->bus_for_faults();
  const bool of_gateway = active.fault.strength < 0.3;
  const BusModel::Port port = of_gateway ? nodes_->gateway_port() : nodes_->node_port(active.fault.node);
  if (!bus.errors(port).bus_off()) return;
  if (!stop_cause_ && !off_bus) {
    stop_cause_ = now;
    if (of_gateway && simulation_->gateway_alive()) simulation_->gateway().on_bus_failure(now, "bus-off");
  }
  if (active.over) bus.recover(port);
}

void Injector::measure_ramp(BusTime now) {
  if (!pressed_ || ramp_ms_ > 0 || now < *pressed_ + 3ms) return;
  BusTime last{0};
  for (int n = 0; n < nodes_->node_count(); ++n) {
    const auto start = nodes_->stop_start(n);
    last = std::max(last, start ? *start : *pressed_ + 1s);
  }
  ramp_ms_ = 1e3 * to_seconds(last - *pressed_);
}

BusTime Injector::gateway_delay(BusTime now) {
  for (const Active& active : active_)
    if (active.on && active.fault.kind == kSlowGateway && now < active.to)
      return BusTime{static_cast<std::int64_t>(kSlowestWakeup_ns * active.fault.strength * unit(random_))};
  return BusTime{0};
}

}  // namespace kinebus
