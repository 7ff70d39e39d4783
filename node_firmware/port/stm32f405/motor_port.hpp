#pragma once
// Both motors: the control interrupt, and what the main loop has to do with it: power, currents and
// parameters from the node to the control; faults, troubles and measurements from the control to the node.

#include <array>
#include <atomic>
#include <cstdint>

#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/motor/axis_control.hpp"
#include "node_firmware/port/stm32f405/power_stage.hpp"

namespace kinebus::stm32 {

class MotorPort {
 public:
  struct Cycles {
    std::uint32_t last = 0, worst = 0;
  };

  explicit constexpr MotorPort(const MotionPlanExchange& plan) : plan_(plan) {}

  /// Starts the power stage, and takes the zero of the current amplifiers. False: an amplifier is not where
  /// it should be, or no conversions come. Interrupts must be on. Takes 4 ms.
  bool start();

  /// Main loop, each pass. True: the node was told something.
  bool serve(Node& node, LocalTime now);
  /// Control interrupts so far; the watchdog wants to see it move.
  std::uint32_t ticks() const { return ticks_.load(std::memory_order_relaxed); }
  Cycles cycles() const { return cycles_; }
  const motor::AxisControl& control(int axis) const { return control_[static_cast<std::size_t>(axis)]; }
  const PowerStage& stage() const { return stage_; }

  // Interrupts.
  void on_control();
  void on_break(int axis);

 private:
  bool serve_power(Node& node, LocalTime now, int axis);
  bool serve_troubles(Node& node, LocalTime now, int axis);
  void serve_slowly(Node& node, int axis);

  const MotionPlanExchange& plan_;
  PowerStage stage_;
  std::array<motor::AxisControl, 2> control_{motor::AxisControl(0), motor::AxisControl(1)};
  std::atomic<std::uint32_t> ticks_{0};
  std::array<std::atomic<bool>, 2> broken_{};
  Cycles cycles_;

  struct Served {
    bool fault_told = false;
    LocalTime fault_at{0};
    std::uint8_t troubles = 0;
    motor::AutoTune::State tune = motor::AutoTune::State::kIdle;
  };
  std::array<Served, 2> served_{};
  LocalTime due_{0}, slow_due_{0};
};

}  // namespace kinebus::stm32
