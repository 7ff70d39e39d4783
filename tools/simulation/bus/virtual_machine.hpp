#pragma once
// Nodes, their motors and switches, and the bus that joins them, in virtual time: the machine without its
// gateway. The simulation drives it with the gateway in one virtual time; the daemon's `--bus inproc` drives
// it by the wall clock. All times are true time (BusTime of the bus itself); every node has a clock of its
// own.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "node_firmware/core/node.hpp"
#include "node_firmware/port/host/heat_plant.hpp"
#include "tools/simulation/bus/bus_model.hpp"
#include "tools/simulation/bus/node_machine.hpp"

namespace kinebus {

/// What stands behind one axis: a motor that follows its node exactly, and perhaps a switch on its way.
struct VirtualAxis {
  double start_counts = 0;   ///< where the carriage stands at power-up, counts from the joint's zero
  int switch_input = 0;      ///< 1..7 on this node; 0: none
  int switch_node = -1;      ///< the switch is wired (wrongly) to this node, by its place; -1: to its own
  double switch_counts = 0;  ///< where the switch's edge is
  bool active_above = true;  ///< the switch is active at and above its edge (else at and below)
  bool active_low = false;   ///< electrically
  /// What a linear scale on the carriage counts, when the motor is at these true counts; asked in the order
  /// of time. Empty: no scale.
  std::function<std::int32_t(double counts)> scale{};
  double max_counts_per_s = 1e6;  ///< bound used to find the edge without fine ticks
};

/// Something that a probe touches.
struct VirtualProbe {
  int node = 0;             ///< its place
  int input = 1;            ///< 1..7
  bool active_low = false;  ///< electrically
  int pin_node = -1;        ///< the heat node whose plant has the pin; none: it touches as it is
  /// By how many mm the probe is clear of it, < 0: it touches, with the motors at these true counts, by node;
  /// asked in the order of time.
  std::function<double(const std::vector<std::array<double, 2>>& counts)> gap_mm;
  double max_mm_per_s = 500;  ///< bound used to find the edge without fine ticks
};

/// The motor that feeds filament.
struct VirtualExtruder {
  int node = 0, axis = 0;  ///< its place
  double mm_per_count = 0;
};

struct VirtualNodeOptions {
  NodeOptions node;
  bool heat = false;                          ///< a heat node, with a HeatPlant behind it and no axes
  std::optional<VirtualExtruder> extruder{};  ///< what draws the filament past its sensors
  std::array<heat::SensorPart, heat::HeatPlant::kSensors> sensors{};  ///< of a heat node
  std::array<VirtualAxis, 2> axes{};
  BusTime clock_offset{0};
  double clock_drift_ppm = 0;
  BusTime latency_max{0};  ///< interrupt latency, one-sided, uniform, at every reception
};

class VirtualMachine final : public NodeMachine {
 public:
  static constexpr int kGatewayStation = -1;
  /// A frame on its way into one station; a fault may drop, delay, double or change it.
  struct Arrival {
    BusTime at{0};
    CanFrame frame;
  };
  /// `station`: a node's place, or kGatewayStation. `arrivals` holds the one undisturbed.
  using ArrivalHook = std::function<void(int station, std::vector<Arrival>& arrivals)>;
  /// What an input of a node shows instead of the level that its carriage gives; times of further raw edges
  /// (bounce) may be added. nullopt: this edge does not show.
  struct Edge {
    BusTime at{0};
    bool level = false;
  };
  using SwitchHook = std::function<void(int node, int input, std::vector<Edge>& edges)>;

  VirtualMachine(const std::vector<VirtualNodeOptions>& nodes, std::uint64_t seed, int gateway_mailboxes = 1);
  ~VirtualMachine() override;

  void set_probe(VirtualProbe probe);

  // The gateway's side of the bus.
  bool can_send() const override { return bus_.has_room(gateway_); }
  void send(BusTime now, const CanFrame& frame) override { bus_.send(gateway_, now, frame); }
  std::optional<Received> receive() override;

  /// When advance() has something to do next.
  BusTime next_event() const override;
  /// The same, but that the machine's own looks at its switches and its probe need not be before `looks`:
  /// whoever comes later finds them made in their time.
  BusTime next_event(BusTime looks) const;
  /// Does everything that falls due up to `now`, in order. Stops early, right after a delivery to the
  /// gateway, so that the gateway can react in time: call again until it returns true.
  bool advance(BusTime now) override;

  /// True position, counts, of an axis now. `at` at or after the last advance().
  double true_counts(int node, int axis, BusTime at) override;
  /// True time at which a node's latched stop begins or began; nullopt: none is latched.
  std::optional<BusTime> stop_start(int node) const;
  /// Where a node believes an axis is, counts from the joint's zero; nullopt: it does not claim to know.
  std::optional<double> believed_counts(int node, int axis, BusTime at);
  /// The node's own idea of path time at true time `at`.
  PathTime path_time(int node, BusTime at) override;
  /// Motion is queued, or path time runs or is about to.
  bool path_time_counts(int node, BusTime at) const;
  Node& node(int index);
  /// Of a heat node, which has power.
  heat::HeatNode& heat_node(int index);
  heat::HeatPlant& heat_plant(int index);
  heat::HeatPlant* heated(int node) override;
  int node_count() const override { return static_cast<int>(nodes_.size()); }
  const BusModel& bus() const override { return bus_; }

  // Faults.
  BusModel& bus_for_faults() { return bus_; }
  BusModel::Port gateway_port() const { return gateway_; }
  BusModel::Port node_port(int node) const;
  /// Another station on the bus, that nobody knows of.
  BusModel::Port add_stranger(int mailboxes) { return bus_.add_port(mailboxes); }
  void set_arrival_hook(ArrivalHook hook) { arrival_hook_ = std::move(hook); }
  void set_switch_hook(SwitchHook hook) { switch_hook_ = std::move(hook); }
  /// Off: the board is dead, its motors stand where they are. On again: it boots with its defaults.
  void set_power(int node, BusTime now, bool on);
  bool powered(int node) const;
  /// Its main loop hangs, while interrupts go on: motors follow the plan, frames queue up to `kStallQueue`.
  void set_stalled(int node, BusTime now, bool stalled);
  /// Over-current: the power stage of an axis is off until the cause has gone.
  void set_drive_fault(int node, BusTime now, int axis, bool present);
  /// Frames that a receiver has lost, as its controller tells.
  void count_overruns(int node, BusTime now, std::uint32_t times);
  /// A parameter that the node has from another machine. `size`: 1, 2 or 4 bytes.
  void write_parameter(int node, BusTime now, ObjectAddress address, int size, std::uint32_t value);
  /// The motor does not follow: the carriage is `counts` from where it should be, from now on.
  void lose_steps(int node, int axis, double counts);

  /// A raw level on an input that no axis drives (E-stop button).
  void set_input(int node, BusTime at, int input, bool level) override;

 private:
  struct VirtualNode;
  struct Pending {  // a delivered frame on its way through interrupt latency
    BusTime at{0};
    CanFrame frame;
    BusTime stamp{0};  // of the receive interrupt
  };
  void deliver(const BusModel::Delivery& delivery);
  void serve(VirtualNode& node, BusTime now);
  void check_switches(VirtualNode& node, BusTime now);
  void check_probe(BusTime now);
  BusTime next_besides_probe() const;

  static constexpr std::size_t kStallQueue = 64;

  void take_in(VirtualNode& node, Arrival arrival);
  static void put(std::vector<Pending>& pending, const Arrival& arrival);
  void take_in_at_gateway(const Arrival& arrival);

  BusModel bus_;
  BusModel::Port gateway_;
  std::vector<std::unique_ptr<VirtualNode>> nodes_;
  std::vector<Received> received_;
  std::size_t next_received_ = 0;
  std::vector<Arrival> gateway_pending_;
  ArrivalHook arrival_hook_;
  SwitchHook switch_hook_;
  std::optional<VirtualProbe> probe_;
  std::vector<std::array<double, 2>> probe_counts_;
  BusTime next_probe_check_{BusTime::max()};
  std::optional<bool> probe_touches_;
  std::mt19937_64 random_;
};

}  // namespace kinebus
