#pragma once
// Makes a plan's faults happen to a simulation: when, to whom, for how long.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/simulation/simulation.hpp"
#include "vcan_tests/campaign/bus_faults.hpp"
#include "vcan_tests/campaign/fault.hpp"

namespace kinebus {

inline constexpr int kEmergencyInput = 7;  ///< of every node of the campaign's machine

class Injector {
 public:
  Injector(const MachineDescription& machine, const FaultPlan& plan);

  /// The nodes, with what the plan changes of them before their power comes.
  std::unique_ptr<NodeMachine> make_nodes();
  void attach(Simulation& simulation);
  VirtualMachine& machine() { return *nodes_; }

  /// A phase has begun: its faults count from here.
  void begin(FaultPhase phase, BusTime now);
  void on_time(BusTime now);

  /// Nothing that would keep a stop from being lifted.
  bool cause_over(BusTime now) const;
  /// When something happened that stops the machine; nullopt: nothing yet.
  std::optional<BusTime> stop_cause() const { return stop_cause_; }
  /// When the fault that names the run has come; nullopt: not yet.
  std::optional<BusTime> begun() const {
    const Active& first = active_.front();
    return first.on || first.over ? std::optional(first.from) : std::nullopt;
  }
  /// E-stop input to the last node's ramp; 0: there was none.
  double ramp_ms() const { return ramp_ms_; }
  /// By so many counts motors have lost steps since they were homed.
  double excused_counts() const { return excused_counts_; }
  BusTime gateway_delay(BusTime now);
  /// The text of the job, for a gateway that is started anew.
  std::function<std::unique_ptr<ByteSource>()> job;
  std::function<void(const std::string&)> note;

 private:
  struct Active {
    Fault fault;
    BusTime from = BusTime::max(), to = BusTime::max();
    bool on = false, over = false;
    std::unique_ptr<ReceiverFaults> receiver;
    std::unique_ptr<WireFaults> wire;
    std::unique_ptr<Stranger> stranger;
    std::unique_ptr<SecondGateway> second;
  };
  void turn_on(Active& active, BusTime now);
  void turn_off(Active& active, BusTime now);
  void break_heat(const Fault& fault, bool broken);
  void serve(Active& active, BusTime now);
  void measure_ramp(BusTime now);
  void exchange_switches(const Fault& fault, std::vector<VirtualNodeOptions>& nodes) const;
  void disturb_switch(const Fault& fault, int node, int input, std::vector<VirtualMachine::Edge>& edges);
  std::uint64_t next_seed() { return random_(); }

  const MachineDescription& description_;
  FaultPlan plan_;
  std::mt19937_64 random_;
  std::vector<Active> active_;
  VirtualMachine* nodes_ = nullptr;
  Simulation* simulation_ = nullptr;
  std::optional<BusTime> stop_cause_, pressed_;
  double ramp_ms_ = 0, excused_counts_ = 0;
};

}  // namespace kinebus
