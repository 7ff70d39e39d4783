#pragma once
// The whole machine in virtual time: gateway core, node cores, motors, switches, bus and clocks, from one
// seed. Deterministic: the same seed gives the same run, frame for frame.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/journal/journal_state.hpp"
#include "gateway/machine/gateway.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"
#include "tools/simulation/bus/virtual_nodes.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

struct SimulationOptions {
  /// The machine as it really is, where it is not as described: geometry, and calibration as the truth about
  /// each joint. Same joints and nodes. Must outlive the simulation. nullptr: as described.
  const MachineDescription* plant = nullptr;
  std::uint64_t seed = 1;
  /// Crystals over +-25 ppm (50 ppm apart), interrupts up to 20 us late, power-up times apart.
  VirtualClocks clocks{.drift_ppm = 25,
                       .latency_max = std::chrono::microseconds{20},
                       .offset_max = std::chrono::milliseconds{900}};
  /// The gateway's task wakes up late by up to this (Linux).
  BusTime gateway_latency_max = std::chrono::microseconds{200};
  BusTime sample_period = std::chrono::milliseconds{1};
  /// How much later than that the gateway's task wakes up at this time (a slow or busy computer).
  std::function<BusTime(BusTime now)> gateway_delay;
  bool journal = false;  ///< the gateway keeps one, for the next
};

class Simulation {
 public:
  Simulation(const MachineDescription& machine, const Kinematics& kinematics,
             const SimulationOptions& options);
  /// With nodes of another make (firmware images on emulated boards) for the same machine description.
  Simulation(const MachineDescription& machine, const Kinematics& kinematics,
             const SimulationOptions& options, std::unique_ptr<NodeMachine> nodes);

  Gateway& gateway() { return *gateways_.back(); }
  /// The daemon is dead: nothing is served until start_gateway(). What it had planned can still be asked.
  void kill_gateway();
  /// A new one, with its machine file, the journal of the one before, and the text of the job that was under
  /// way. False: the journal was not taken up.
  bool start_gateway(std::unique_ptr<ByteSource> job = nullptr);
  bool gateway_alive() const { return alive_; }
  /// The planned pose at a path time by the gateway that runs, or ran last.
  std::optional<PlannedPose> planned_pose(PathTime tau) const;
  NodeMachine& machine() { return *nodes_; }
  BusTime now() const { return now_; }

  /// Runs until `until`, calling on_sample (if set) every sample period.
  void run_until(BusTime until);
  /// Runs until the gateway's state satisfies `done`, at most `limit`. False: not reached.
  bool run_until_state(const std::function<bool(MachineState)>& done, BusTime limit);

  Sample sample();
  Probe probe();
  /// Finds the pose of a sample. Dear where there is none, as before homing: for those who look at the tool.
  void locate(Sample& sample);

  std::function<void(const Sample&)> on_sample;
  std::function<void(const Probe&)> on_probe;  ///< at a random instant of every sample period
  std::function<void(BusTime, const CanFrame&)> on_frame;
  std::function<void(const NodeMachine::Received&)> on_received;  ///< the same, with who sent it
  std::function<void(BusTime)> on_turn;                           ///< after every event
  std::function<void(const MachineEvent&)> on_event;
  bool in_job = false;

  std::uint64_t trace_hash() const { return hash_; }

 private:
  std::uint8_t next_epoch();
  void step(BusTime until);
  void serve_gateway(BusTime now);
  void hash(BusTime when, const CanFrame& frame);
  BusTime gateway_due();

  const MachineDescription& description_;
  const Kinematics& kinematics_;
  SimulationOptions options_;
  std::vector<std::unique_ptr<Gateway>> gateways_;  // the last one is the one that runs
  bool alive_ = true;
  journal::State journal_;
  std::uint64_t journal_records_ = 0;
  std::unique_ptr<NodeMachine> nodes_;
  std::vector<int> node_of_joint_;
  std::vector<JointPlant> plants_;                ///< by joint
  std::unique_ptr<Kinematics> plant_kinematics_;  ///< of options.plant, if there is one
  std::mt19937_64 random_;
  BusTime now_{0};
  BusTime next_sample_{0}, next_probe_{0};
  BusTime asked_{BusTime::max()}, woken_{0};  // the gateway's deadline, and when Linux lets it run
  BusTime served_{-1'000'000};                // when it ran last
  Sample last_{};
  std::array<Pose, 2> warm_{};  // the last two poses found
  std::uint64_t hash_ = 1469598103934665603ULL;
};

}  // namespace kinebus
