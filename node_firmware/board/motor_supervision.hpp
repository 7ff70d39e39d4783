#pragma once
// What the main loop has to do with two motors whose currents the board controls: power, currents and
// parameters from the node to the control; faults, troubles and measurements from the control to the node.

#include <array>
#include <cstdint>

#include "node_firmware/core/node.hpp"
#include "node_firmware/motor/axis_control.hpp"

namespace kinebus {

/// Of the half-bridges that drive the motors.
struct BridgeFacts {
  float dead_time_share = 0;  ///< of the supply, that a phase's two half-bridges lose to dead time
  int control_hz = 0;
};
struct BridgeReadings {
  float supply_v = 0;
  std::array<float, 2> temperature_c{};
};

class MotorSupervision {
 public:
  explicit constexpr MotorSupervision(const BridgeFacts& bridges) : bridges_(bridges) {}

  /// Each pass. True: the node was told something.
  bool serve(Node& node, LocalTime now, const BridgeReadings& readings);

  motor::AxisControl& control(int axis) { return control_[static_cast<std::size_t>(axis)]; }
  const motor::AxisControl& control(int axis) const { return control_[static_cast<std::size_t>(axis)]; }
  /// Of the last look.
  const BridgeReadings& readings() const { return readings_; }

 private:
  bool serve_power(Node& node, LocalTime now, int axis);
  bool serve_troubles(Node& node, LocalTime now, int axis);
  void serve_slowly(Node& node, int axis);

  BridgeFacts bridges_;
  BridgeReadings readings_;
  std::array<motor::AxisControl, 2> control_{motor::AxisControl(0), motor::AxisControl(1)};

  struct Served {
    bool fault_told = false;
    LocalTime fault_at{0};
    std::uint8_t troubles = 0;
    motor::AutoTune::State tune = motor::AutoTune::State::kIdle;
  };
  std::array<Served, 2> served_{};
  LocalTime due_{0}, slow_due_{0};
};

}  // namespace kinebus
