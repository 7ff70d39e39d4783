#pragma once
// The node's core on the board: feeds it frames, edges and time in their order, and carries out what it says.
// One pass of the main loop; interrupts come through the ports.

#include <optional>

#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/port/stm32f405/can_port.hpp"
#include "node_firmware/port/stm32f405/local_time.hpp"
#include "node_firmware/port/stm32f405/switch_port.hpp"

namespace kinebus::stm32 {

class NodeProgram {
 public:
  NodeProgram(const NodeOptions& options, std::span<const std::uint8_t> stored, CanPort& can,
              SwitchPort& switches, MotionPlanExchange& plan);

  /// Everything that has come since the last pass. Call at least every millisecond.
  void pass();
  /// The power stage does not measure: an axis that is switched on has a fault. True: so it was.
  bool refuse_power();
  /// Something was told to the node elsewhere: the next pass looks what follows from it.
  void touch() { touched_ = true; }
  Node& node() { return node_; }
  LocalTime now() const { return now_; }
  /// now(), read afresh: a pass may have taken a while.
  LocalTime read_time() { return now_ = clock_.now(); }
  /// Hands what the node has to say to the bus, as far as there is room.
  void send();
  PathTime path_time(std::uint32_t counts) const { return node_.path_time(clock_.at(counts)); }

 private:
  bool take_inputs();
  void filter();
  void report_bus();

  CanPort& can_;
  SwitchPort& switches_;
  MotionPlanExchange& plan_;
  LocalClock clock_;
  LocalTime now_;
  Node node_;
  LocalTime due_{0}, plan_due_{0}, filter_due_{0};
  bool touched_ = true;
  std::array<CanPort::Accept, CanPort::kFilters> filters_{};
  CanPort::Events told_;
  bool was_off_ = false;
};

}  // namespace kinebus::stm32
