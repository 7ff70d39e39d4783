#pragma once
// Both motors' half-bridges and what is measured with them: PWM of TIM1 and TIM8, the injected conversions
// that TIM1 triggers, the slow conversions, break inputs, and the encoders. Set up once; then the control
// interrupt reads and writes words.

#include <array>
#include <atomic>
#include <cstdint>

#include "node_firmware/board/bridge_motors.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"
#include "node_firmware/port/stm32f405/board.hpp"

namespace kinebus::stm32 {

class PowerStage {
 public:
  static constexpr BridgeFacts kBridges{2 * board::kDeadTimeS * static_cast<float>(board::kPwmHz),
                                        static_cast<int>(board::kControlHz)};
  static constexpr float kCurrentZero = board::kCurrentZero;
  static constexpr float kMostZeroError = 100;  // 0.4 A

  /// Starts timers and converters; outputs stay off, and the control interrupt begins.
  void start();

  void wait_for_control() const {}
  static std::uint32_t cycles() { return dwt().CYCCNT; }
  static PlanCounts counts() { return local_counts(); }

  // Control interrupt.
  static void acknowledge_control() { adc(1).SR = ~Adc::kInjectedEnd; }
  /// Phase currents of the sampling that has just ended, in amperes.
  motor::Vector currents(int axis) const;
  /// Once for a break; from the break until then apply() gives no power.
  bool take_break(int axis) {
    std::atomic<bool>& broken = broken_[static_cast<std::size_t>(axis)];
    if (!broken.load(std::memory_order_relaxed)) return false;
    broken.store(false, std::memory_order_relaxed);  // a second break in between is told by the first
    return true;
  }
  /// Duty -1..1 of the supply for phases A and B; power on or off at once.
  void apply(int axis, const motor::AxisOutputs& outputs);
  /// Collects one slow conversion and begins the next.
  void serve_slow();
  const BridgeReadings& readings() const { return readings_; }
  /// The encoder's last answer; 0xFFFF, which is none, when there is none. Ends that frame.
  static std::uint16_t take_encoder(int axis);
  /// The next reading; at least 350 ns after take_encoder(), ready 3 us later.
  static void begin_encoder(int axis);
  /// Main loop: an axis' encoder port is an absolute scale's from now on; there is no encoder then.
  static void lend_encoder_port(int axis);
  static void return_encoder_port(int axis);

  /// Break interrupt: the hardware has switched the outputs off; the drivers are disabled too.
  void on_break(int axis);

  /// Main loop: no bridge is on.
  bool dark() const {
    return !on_[0].load(std::memory_order_relaxed) && !on_[1].load(std::memory_order_relaxed);
  }
  /// Main loop: the shunt amplifiers' zero, averaged while nothing flows. `steps`: sums of a conversion each.
  void set_zero(int axis, float phase_a_steps, float phase_b_steps) {
    zero_[static_cast<std::size_t>(axis)] = {phase_a_steps, phase_b_steps};
  }
  static std::array<std::uint32_t, 2> raw(int axis);

 private:
  std::array<motor::Vector, 2> zero_{motor::Vector{board::kCurrentZero, board::kCurrentZero},
                                     motor::Vector{board::kCurrentZero, board::kCurrentZero}};
  static inline constinit std::array<std::atomic<bool>, 2> lent_{};
  std::array<std::atomic<bool>, 2> on_{};
  std::array<std::atomic<bool>, 2> broken_{};
  BridgeReadings readings_{.supply_v = 0, .temperature_c = {25, 25}};
  std::size_t slow_ = 0, turn_ = 0;  // place in board::kSlowChannels, and in the order of conversions
};
static_assert(BridgeStage<PowerStage>);

}  // namespace kinebus::stm32
