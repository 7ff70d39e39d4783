#pragma once
// Motors behind step and direction inputs, two for each node of a board: the control interrupt, from the plan
// to the words that a timer puts out, and power and faults between the drivers and the nodes. The stage is
// the board's: registers and pins.
//
// A frame is filled while the one before it is put out: what is planned anew shows 64 to 128 us later.

#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>

#include "node_firmware/board/board_node.hpp"
#include "node_firmware/board/bridge_motors.hpp"
#include "node_firmware/board/driver_supervision.hpp"
#include "node_firmware/core/motion_plan.hpp"
#include "node_firmware/core/node.hpp"
#include "node_firmware/step/step_axis.hpp"
#include "node_firmware/step/step_frame.hpp"

namespace kinebus {

/// Of an axis, as the words of the stage's frames have them. No step: the board has only the first axis.
struct StepPins {
  std::size_t step_port = 0, direction_port = 0;  ///< as the stage numbers its ports
  std::uint32_t step = 0, direction = 0;
};

template <typename T>
concept StepStage = requires(T& stage, typename T::Frames& frames, int axis, bool on) {
  { T::kPins.size() } -> std::convertible_to<std::size_t>;  // of StepPins: by node, and by its axis
  requires T::kPins.size() % kAxesPerNode == 0;
  { T::kStepBits } -> std::convertible_to<int>;  // log2 of counts a step
  { T::kQuickDivision } -> std::convertible_to<bool>;
  { T::kPlan } -> std::convertible_to<PlanSize>;  // by how long a pass of the main loop takes
  // Puts frames out from now on, the two halves in turn, a word each kSlotCounts of the same clock, and calls
  // the control interrupt at the last word of each. When the first has begun.
  { stage.start(frames) } -> std::same_as<PlanCounts>;
  { T::counts() } -> std::same_as<PlanCounts>;
  T::acknowledge_control();
  stage.enable(axis, on);  // of the driver
};

/// `Drivers`: what speaks to them, if anything does.
template <StepStage Stage, typename Drivers = NoDrivers>
class StepMotors {
 public:
  using Frames = typename Stage::Frames;  // step::StepFrames
  static constexpr std::size_t kAxes = Stage::kPins.size(), kNodes = kAxes / kAxesPerNode;
  using Plans = std::array<MotionPlanExchange, kNodes>;

  explicit constexpr StepMotors(const Plans& plans) : plans_(plans) {}
  constexpr StepMotors(const Plans& plans, Drivers& drivers) : plans_(plans), drivers_(drivers) {}

  /// Frames begin; no driver is enabled.
  void start() { start_ = stage_.start(frames_); }

  /// After start(): where plans are to begin.
  PlanGrid plan_grid() const {
    return {start_ + step::kSetUp * step::kSlotCounts, step::kFrameCounts, Stage::kPlan};
  }

  /// Main loop, each pass. True: the node was told something.
  bool serve(std::size_t number, Node& node, LocalTime now);
  /// Control interrupts so far; the watchdog wants to see it move.
  std::uint32_t ticks() const { return ticks_.load(std::memory_order_relaxed); }
  /// No driver is enabled: control interrupts may be missed.
  bool dark() const { return !powered(0, kAxes); }
  /// A driver of another node than this one is enabled.
  bool others_powered(std::size_t number) const {
    return powered(0, kAxesPerNode * number) || powered(kAxesPerNode * (number + 1), kAxes);
  }
  /// Something else of the board has power that must not be held up by flash that is written, as if another
  /// node's driver were enabled.
  void set_other_power(bool on) { other_power_ = on; }
  /// The node is gone: its drivers are disabled.
  void release(std::size_t number) {
    for (int axis = 0; axis < kAxesPerNode; ++axis) set_power(axis_of(number, axis), false);
  }
  /// From power-up to the end of what is planned, where the motor had power.
  std::int32_t steps(int axis) const { return axes_[static_cast<std::size_t>(axis)].steps.steps(); }

  // Interrupt.
  void on_control();

 private:
  static constexpr LocalTime kServe = std::chrono::microseconds{250};
  static constexpr LocalTime kDrivers = std::chrono::milliseconds{4};
  static constexpr bool has_driver(std::size_t axis) { return Stage::kPins[axis].step != 0; }
  // What a fault has left has gone by then.
  static constexpr LocalTime kFaultRest = std::chrono::milliseconds{100};

  struct Axis {
    step::StepAxis<Stage::kStepBits, Stage::kQuickDivision> steps;
    std::atomic<bool> power{false}, inverted{false};
    std::atomic<bool> lost{false};  ///< steps were asked for that cannot be made, or made twice
    bool steps_inverted = false;    ///< as the direction pin was set last
    bool moved = false;             ///< in the last two frames
    bool moved_before = false;
    bool fault_told = false;
    LocalTime fault_at{0};
  };

  static constexpr std::size_t axis_of(std::size_t number, int axis) {
    return kAxesPerNode * number + static_cast<std::size_t>(axis);
  }
  bool powered(std::size_t from, std::size_t to) const {
    for (std::size_t i = from; i < to; ++i)
      if (axes_[i].power.load(std::memory_order_relaxed)) return true;
    return false;
  }
  bool serve_axis(std::size_t number, Node& node, LocalTime now, int axis);
  std::uint16_t fault_of(std::size_t place, bool power_wanted);
  void set_power(std::size_t axis, bool on);
  void fill(Axis& axis, const step::PlannedWay& way, const StepPins& pins);

  const Plans& plans_;
  Stage stage_;
  Frames frames_;
  std::array<Axis, kAxes> axes_{};
  std::array<LocalTime, kNodes> due_{}, drivers_due_{};
  bool other_power_ = false;
  PlanCounts start_ = 0;     ///< when the first frame began
  std::uint32_t frame_ = 0;  ///< the number of the one that is put out
  std::atomic<std::uint32_t> ticks_{0};
  DriverSupervision<Drivers> drivers_;
};

template <StepStage Stage, typename Drivers>
bool StepMotors<Stage, Drivers>::serve(std::size_t number, Node& node, LocalTime now) {
  if (now < due_[number]) return false;
  due_[number] = now + kServe;
  node.set_neighbours_powered(other_power_ || others_powered(number));
  const bool asks_drivers = now >= drivers_due_[number];
  if (asks_drivers) drivers_due_[number] = now + kDrivers;
  bool told = false;
  for (int axis = 0; axis < kAxesPerNode; ++axis) {
    const std::size_t place = axis_of(number, axis);
    if (has_driver(place)) {
      if (asks_drivers) told = drivers_.serve(node, now, place, axis, powered(place, place + 1)) || told;
      told = serve_axis(number, node, now, axis) || told;
    } else if (node.drive(axis).power) {
      node.on_drive_fault(now, axis, emcy::kNoMotor);
      told = true;
    }
  }
  return told;
}

template <StepStage Stage, typename Drivers>
bool StepMotors<Stage, Drivers>::serve_axis(std::size_t number, Node& node, LocalTime now, int index) {
  const std::size_t place = axis_of(number, index);
  Axis& axis = axes_[place];
  const DriveOutput drive = node.drive(index);
  const std::uint16_t fault = axis.fault_told ? emcy::kNoError : fault_of(place, drive.power);
  if (fault != emcy::kNoError) {
    axis.fault_told = true;
    axis.fault_at = now;
    set_power(place, false);
    node.on_drive_fault(now, index, fault);
    return true;
  }
  if (axis.fault_told) {
    if (drive.power || now - axis.fault_at < kFaultRest) return false;
    drivers_.forget(place);
    if (drivers_.refusal(place) != emcy::kNoError) return false;
    axis.fault_told = false;
    axis.lost.store(false, std::memory_order_relaxed);
    node.on_drive_fault_gone(now, index);
    return true;
  }
  axis.inverted.store(drive.inverted, std::memory_order_relaxed);
  if (drive.power != axis.power.load(std::memory_order_relaxed)) set_power(place, drive.power);
  return false;
}

template <StepStage Stage, typename Drivers>
std::uint16_t StepMotors<Stage, Drivers>::fault_of(std::size_t place, bool power_wanted) {
  const Axis& axis = axes_[place];
  if (axis.lost.load(std::memory_order_relaxed)) return emcy::kSoftware;
  if (axis.power.load(std::memory_order_relaxed)) return drivers_.fault(place);
  if (!power_wanted) return emcy::kNoError;
  drivers_.forget(place);
  return drivers_.refusal(place);
}

template <StepStage Stage, typename Drivers>
void StepMotors<Stage, Drivers>::set_power(std::size_t axis, bool on) {
  stage_.enable(static_cast<int>(axis), on);
  axes_[axis].power.store(on, std::memory_order_relaxed);
}

template <StepStage Stage, typename Drivers>
void StepMotors<Stage, Drivers>::fill(Axis& axis, const step::PlannedWay& way, const StepPins& pins) {
  axis.moved_before = axis.moved;
  if (!axis.power.load(std::memory_order_relaxed)) {
    // Frames that were put out twice may have left the pin either way.
    axis.moved = false;
    axis.steps.forget_direction();
    axis.steps.follow(way);
    return;
  }
  const bool inverted = axis.inverted.load(std::memory_order_relaxed);
  if (inverted != axis.steps_inverted) {
    axis.steps_inverted = inverted;
    axis.steps.forget_direction();
  }
  struct {
    typename Frames::Lane lane;
    std::uint32_t pin;
    Frames& frames;
    const StepPins& pins;
    bool inverted;
    [[gnu::always_inline]] void step(int slot) { lane.pulse(slot, pin); }
    [[gnu::always_inline]] void early_step(int slot) { lane.early_pulse(slot, pin); }
    void turn(int slot, bool up) {
      using Words = typename Frames::Words;
      frames.put(pins.direction_port, slot,
                 up != inverted ? Words::high(pins.direction) : Words::low(pins.direction));
    }
  } put{frames_.lane(pins.step_port), pins.step, frames_, pins, inverted};
  const bool good = axis.steps.fill(way, put);
  axis.moved = axis.steps.moved();
  if (axis.moved) frames_.mark(pins.step_port);
  if (!good) axis.lost.store(true, std::memory_order_relaxed);
}

template <StepStage Stage, typename Drivers>
void StepMotors<Stage, Drivers>::on_control() {
  Stage::acknowledge_control();
  // It comes with the last word of the frame before: a slot early, and half a slot for how start() may round.
  const PlanCounts elapsed = Stage::counts() + 2 * step::kSlotCounts - start_;
  const std::uint32_t frame = elapsed / step::kFrameCounts;
  if (frame == frame_) return;
  // Frames were put out again, as when flash is written, which holds the processor up; then nothing moves.
  if (frame - frame_ != 1)
    for (Axis& axis : axes_)
      if (axis.moved || axis.moved_before) axis.lost.store(true, std::memory_order_relaxed);
  frame_ = frame;
  frames_.begin((frame + 1) % 2);
  const PlanCounts next = start_ + (frame + 1) * step::kFrameCounts;
  for (std::size_t number = 0; number < kNodes; ++number) {
    const MotionPlan& plan = plans_[number].current();
    for (int axis = 0; axis < kAxesPerNode; ++axis) {
      const std::size_t i = axis_of(number, axis);
      if (has_driver(i)) fill(axes_[i], step::planned_way(plan, axis, next), Stage::kPins[i]);
    }
  }
  std::atomic_signal_fence(std::memory_order_release);  // the words are there before the half's turn comes
  ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace kinebus
