#pragma once
// Two motors on half-bridges: the control interrupt, from the plan and the measured currents to duty cycles.
// The stage is the board's: registers, and what they mean in volts and amperes.

#include <array>
#include <atomic>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "node_firmware/board/motor_supervision.hpp"
#include "node_firmware/core/motion_plan.hpp"

namespace kinebus {

template <typename T>
concept BridgeStage = requires(T& stage, const T& seen, int axis, const motor::AxisOutputs& outputs,
                               float zero) {
  { T::kBridges } -> std::convertible_to<BridgeFacts>;
  { T::kCurrentZero } -> std::convertible_to<float>;    // of the current amplifiers, in steps
  { T::kMostZeroError } -> std::convertible_to<float>;  // and how far off it may be
  stage.start();
  stage.wait_for_control();                        // main loop: a moment
  { T::cycles() } -> std::same_as<std::uint32_t>;  // of the processor, for measuring
  { T::counts() } -> std::same_as<PlanCounts>;
  T::acknowledge_control();
  { T::raw(axis) } -> std::same_as<std::array<std::uint32_t, 2>>;
  { seen.currents(axis) } -> std::same_as<motor::Vector>;
  stage.set_zero(axis, zero, zero);
  stage.serve_slow();
  { seen.readings() } -> std::same_as<const BridgeReadings&>;
  { T::take_encoder(axis) } -> std::same_as<std::uint16_t>;
  T::begin_encoder(axis);
  stage.apply(axis, outputs);
  stage.on_break(axis);
  { seen.dark() } -> std::same_as<bool>;  // no bridge is on
  // Once for a break. From the break until then apply() gives no power, whatever it is told.
  { stage.take_break(axis) } -> std::same_as<bool>;
};

/// The processor's cycles in a control interrupt.
struct ControlCycles {
  std::uint32_t last = 0, worst = 0;
};

template <BridgeStage Stage>
class BridgeMotors {
 public:
  explicit constexpr BridgeMotors(const MotionPlanExchange& plan) : plan_(plan) {}

  /// Starts the power stage, and takes the zero of the current amplifiers. False: an amplifier is not where
  /// it should be, or no conversions come. Interrupts must be on. Takes 4 ms.
  bool start();

  /// Main loop, each pass. True: the node was told something.
  bool serve(Node& node, LocalTime now) { return supervision_.serve(node, now, stage_.readings()); }
  /// Control interrupts so far; the watchdog wants to see it move.
  std::uint32_t ticks() const { return ticks_.load(std::memory_order_relaxed); }
  ControlCycles cycles() const { return cycles_; }
  /// No bridge is on: a control interrupt may be missed.
  bool dark() const { return stage_.dark(); }
  const MotorSupervision& supervision() const { return supervision_; }

  // Interrupts.
  void on_control();
  void on_break(int axis) { stage_.on_break(axis); }

 private:
  static constexpr int kZeroSamples = 64;
  static constexpr int kMostWaits = 100'000;

  const MotionPlanExchange& plan_;
  Stage stage_;
  MotorSupervision supervision_{Stage::kBridges};
  std::atomic<std::uint32_t> ticks_{0};
  ControlCycles cycles_;
};

template <BridgeStage Stage>
bool BridgeMotors<Stage>::start() {
  stage_.start();
  std::array<motor::Vector, 2> sum{};
  for (int i = 0; i < kZeroSamples; ++i) {
    const std::uint32_t before = ticks();
    for (int waits = 0; ticks() == before; ++waits) {
      if (waits == kMostWaits) return false;
      stage_.wait_for_control();
    }
    for (int axis = 0; axis < 2; ++axis) {
      const auto [a, b] = Stage::raw(axis);
      sum[static_cast<std::size_t>(axis)].x += static_cast<float>(a);
      sum[static_cast<std::size_t>(axis)].y += static_cast<float>(b);
    }
  }
  bool good = true;
  for (int axis = 0; axis < 2; ++axis) {
    const motor::Vector zero{sum[static_cast<std::size_t>(axis)].x / kZeroSamples,
                             sum[static_cast<std::size_t>(axis)].y / kZeroSamples};
    good = good && std::fabs(zero.x - Stage::kCurrentZero) < Stage::kMostZeroError &&
           std::fabs(zero.y - Stage::kCurrentZero) < Stage::kMostZeroError;
    if (good) stage_.set_zero(axis, zero.x, zero.y);
  }
  return good;
}

template <BridgeStage Stage>
void BridgeMotors<Stage>::on_control() {
  const std::uint32_t began = Stage::cycles();
  const PlanCounts counts = Stage::counts();
  Stage::acknowledge_control();
  stage_.serve_slow();
  const std::array<std::uint16_t, 2> frames{Stage::take_encoder(0), Stage::take_encoder(1)};
  const MotionPlan& plan = plan_.current();
  const BridgeReadings& readings = stage_.readings();
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const MotionPlan::Point point = plan.at(axis, counts);
    motor::AxisInputs in;
    in.current_a = stage_.currents(axis);
    in.supply_v = readings.supply_v;
    in.temperature_c = readings.temperature_c[i];
    in.position = point.position;
    // Of 2^-32 counts in 512 us: 20 bits fewer fit a word.
    constexpr float kPerSecond = 1.0F / (4096.0F * 512e-6F);
    in.velocity = static_cast<float>(static_cast<std::int32_t>(point.velocity >> 20)) * kPerSecond;
    in.encoder_frame = frames[i];
    in.break_seen = stage_.take_break(axis);
    stage_.apply(axis, supervision_.control(axis).step(in));
  }
  Stage::begin_encoder(0);
  Stage::begin_encoder(1);
  ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  cycles_.last = Stage::cycles() - began;
  if (cycles_.last > cycles_.worst) cycles_.worst = cycles_.last;
}

}  // namespace kinebus
