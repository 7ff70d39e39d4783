#pragma once
// Nodes with motors and switches behind them, joined by a bus in virtual time, as the gateway's side sees
// them: virtual nodes (VirtualMachine), or firmware images on emulated boards.

#include <optional>

#include "protocol/can/frame.hpp"
#include "protocol/time.hpp"
#include "tools/simulation/bus/bus_model.hpp"

namespace kinebus::heat {
class HeatPlant;
}

namespace kinebus {

class NodeMachine {
 public:
  struct Received {
    BusTime when{0};
    bool own = false;  ///< the gateway's frame, now sent
    CanFrame frame;
    BusModel::Port from = 0;
  };
  NodeMachine() = default;
  NodeMachine(const NodeMachine&) = delete;
  NodeMachine& operator=(const NodeMachine&) = delete;
  virtual ~NodeMachine() = default;

  virtual bool can_send() const = 0;
  virtual void send(BusTime now, const CanFrame& frame) = 0;
  virtual std::optional<Received> receive() = 0;

  /// When advance() has something to do next.
  virtual BusTime next_event() const = 0;
  /// Does everything that falls due up to `now`, in order. Stops early, right after a delivery to the
  /// gateway, so that the gateway can react in time: call again until it returns true.
  virtual bool advance(BusTime now) = 0;

  /// True position, counts, of an axis now. `at` at or after the last advance().
  virtual double true_counts(int node, int axis, BusTime at) = 0;
  /// The node's own idea of path time at true time `at`; of one without axes, that of the first that has
  /// them.
  virtual PathTime path_time(int node, BusTime at) = 0;
  virtual int node_count() const = 0;
  virtual const BusModel& bus() const = 0;
  /// A raw level on an input that no axis drives (E-stop button).
  virtual void set_input(int node, BusTime at, int input, bool level) = 0;
  /// What the heaters of this node heat; nullptr: it has none that is modelled.
  virtual heat::HeatPlant* heated(int) { return nullptr; }
};

}  // namespace kinebus
