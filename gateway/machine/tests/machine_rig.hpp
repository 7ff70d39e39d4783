#pragma once
// The gateway core joined with real node cores, their motors and switches, on a modelled bus, in virtual
// time.

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/machine/gateway.hpp"
#include "gateway/status/alarm.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"
#include "tools/simulation/bus/virtual_nodes.hpp"

namespace kinebus {

/// `Machine`: what stands for the nodes (NodeMachine), made of virtual nodes' options and a seed.
template <typename Machine>
class RigOf {
 public:
  using Nodes = std::vector<VirtualNodeOptions>;
  /// `alter`: changes the virtual nodes before they are built.
  explicit RigOf(MachineDescription description = default_m1(), const std::function<void(Nodes&)>& alter = {},
                 std::uint64_t seed = 1)
      : machine(std::move(description)),
        gateway(std::make_unique<Gateway>(machine, Gateway::Options{.bus_secret = {.low = seed, .high = 1}})),
        nodes(make_nodes(machine, alter, seed), seed) {}

  /// Frames on their way to the gateway for which this is true are lost.
  std::function<bool(const CanFrame&)> lose_to_gateway;
  /// Frames of the gateway for which this is true are lost, though it believes they went out.
  std::function<bool(const CanFrame&)> lose_from_gateway;
  /// Sees all frames of the bus.
  std::function<void(BusTime, const CanFrame&)> on_frame;

  /// A frame that the gateway believes to be on the bus goes there after the present one.
  void send_late(const CanFrame& frame) { late_.push_back(frame); }
  /// Another device on the bus sends this: nodes and gateway hear it.
  void stranger_sends(const CanFrame& frame) { strangers_.push_back(frame); }

  void run_for(BusTime duration) {
    run_until([] { return false; }, duration);
  }
  /// False: not within `limit`.
  bool run_until(const std::function<bool()>& done, BusTime limit) {
    const BusTime until = now + limit;
    serve();
    while (!done()) {
      if (now >= until) return false;
      step(until);
    }
    return true;
  }
  bool reach(MachineState state, BusTime limit = std::chrono::seconds{60}) {
    return run_until([&] { return gateway->state() == state; }, limit);
  }
  /// The gateway is not run for `duration`; what came meanwhile waits for it.
  void stall(BusTime duration) {
    std::vector<NodeMachine::Received> waiting;
    const BusTime from = now;
    for (bool done = false; !done;) {
      done = nodes.advance(from + duration);
      while (auto got = nodes.receive()) waiting.push_back(*got);
    }
    now = from + duration;
    gateway->on_stall(now, duration, say("a test"));
    for (const auto& got : waiting) {
      if (on_frame) on_frame(got.when, got.frame);
      if (got.own)
        gateway->on_frame_sent(got.when, got.frame);
      else
        gateway->on_frame(got.when, got.frame);
    }
    gateway->on_time(now);
    serve();
  }
  /// Brings up, homes and goes to the bed reference.
  bool make_ready() {
    using namespace std::chrono_literals;
    if (!gateway->carry_out(command::BringUp{}) || !reach(MachineState::kUnhomed, 30s)) return false;
    if (!gateway->carry_out(command::Home{}) || !reach(MachineState::kReady, 120s)) return false;
    return gateway->carry_out(command::GoToReference{}) && reach(MachineState::kReady, 60s);
  }
  bool run_job(std::string text, BusTime limit = std::chrono::seconds{120}) {
    return gateway->carry_out(command::Run{std::make_unique<StringSource>(std::move(text)), "test"}) &&
           reach(MachineState::kReady, limit);
  }

  /// Where the motors really are: joint values, mm or rad.
  JointVector joints() {
    JointVector values{};
    for (std::size_t j = 0; j < machine.joints.size(); ++j) {
      const JointDescription& joint = machine.joints[j];
      for (std::size_t n = 0; n < machine.nodes.size(); ++n)
        if (machine.nodes[n].id == joint.node_id)
          values[j] = joint_from_counts(joint, nodes.true_counts(static_cast<int>(n), joint.axis, now));
    }
    return values;
  }
  /// All that was told, one a line.
  std::string story() const {
    std::string text;
    for (const MachineEvent& e : events)
      text += std::to_string(to_seconds(e.when)) + " s: " + e.words +
              (e.advice.empty() ? "" : " -> " + e.advice) + "\n";
    return text;
  }
  bool told(MachineEvent::Kind kind) const {
    for (const MachineEvent& e : events)
      if (e.kind == kind) return true;
    return false;
  }
  bool told(AlarmCode code) const {
    for (const MachineEvent& e : events)
      if (e.kind == MachineEvent::Kind::kAlarm && e.code == static_cast<std::uint16_t>(code)) return true;
    return false;
  }

  MachineDescription machine;
  std::unique_ptr<Gateway> gateway;
  Machine nodes;
  BusTime now{0};
  std::vector<MachineEvent> events;

 private:
  static Nodes make_nodes(const MachineDescription& machine, const std::function<void(Nodes&)>& alter,
                          std::uint64_t seed) {
    Nodes made =
        virtual_nodes_of(machine, {.drift_ppm = 40, .latency_max = std::chrono::microseconds{10}}, seed);
    if (alter) alter(made);
    return made;
  }
  void serve() {
    while (nodes.can_send()) {
      if (!late_.empty()) {
        nodes.send(now, late_.front());
        late_.pop_front();
        continue;
      }
      if (!strangers_.empty()) {
        nodes.send(now, strangers_.front());
        sent_by_strangers_.push_back(strangers_.front());
        strangers_.pop_front();
        continue;
      }
      const auto frame = gateway->next_frame(now);
      if (!frame) break;
      if (lose_from_gateway && lose_from_gateway(*frame))
        gateway->on_frame_sent(now, *frame);
      else
        nodes.send(now, *frame);
    }
    while (auto event = gateway->next_event()) events.push_back(std::move(*event));
  }
  void step(BusTime until) {
    const BusTime due = std::max(gateway->next_deadline(), now);
    const BusTime next = std::min({until, due, std::max(nodes.next_event(), now)});
    const bool done = nodes.advance(next);
    bool stirred = false;
    while (const auto got = nodes.receive()) {
      now = std::max(now, got->when);
      if (on_frame) on_frame(got->when, got->frame);
      stirred = true;
      const bool stranger =
          got->own && !sent_by_strangers_.empty() && sent_by_strangers_.front() == got->frame;
      if (stranger) sent_by_strangers_.pop_front();
      if (got->own && !stranger)
        gateway->on_frame_sent(got->when, got->frame);
      else if (!lose_to_gateway || !lose_to_gateway(got->frame))
        gateway->on_frame(got->when, got->frame);
    }
    if (done) now = std::max(now, next);
    if (done && now >= due) {
      gateway->on_time(now);
      stirred = true;
    }
    if (stirred) serve();
  }
  std::deque<CanFrame> strangers_, sent_by_strangers_, late_;
};
using MachineRig = RigOf<VirtualMachine>;

}  // namespace kinebus
