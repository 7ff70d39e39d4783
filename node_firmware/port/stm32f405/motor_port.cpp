#include "node_firmware/port/stm32f405/motor_port.hpp"

#include <cmath>

#include "node_firmware/port/stm32f405/local_time.hpp"
#include "node_firmware/port/stm32f405/registers.hpp"

namespace kinebus::stm32 {
namespace {

constexpr LocalTime kServe = std::chrono::microseconds{250};
constexpr LocalTime kSlowly = std::chrono::milliseconds{5};
// What a fault has left in windings and comparators has gone by then.
constexpr LocalTime kFaultRest = std::chrono::milliseconds{100};
constexpr int kZeroSamples = 64;
constexpr float kMostZeroError = 100;  // steps: 0.4 A

// A winding that nobody has measured: gains that are stable with anything from 0.5 mH on.
constexpr motor::MotorModel kUnknownMotor{1.0F, 0.8e-3F, 0};
constexpr float kUnknownBandwidthHz = 500;
constexpr float kDeadTimeShare = 2 * board::kDeadTimeS * static_cast<float>(board::kPwmHz);

struct Trouble {
  std::uint8_t bit;
  std::uint16_t code;
};
constexpr std::array<Trouble, 5> kTroubles{{{motor::Surroundings::kUnder, motor::fault::kUnderVoltage},
                                            {motor::Surroundings::kOver, motor::fault::kOverVoltage},
                                            {motor::Surroundings::kHot, motor::fault::kTemperature},
                                            {motor::Surroundings::kEncoder, motor::fault::kEncoder},
                                            {motor::Surroundings::kFollowing, motor::fault::kFollowing}}};

motor::AxisConfig config_of(const Node& node, int axis) {
  const auto value = [&](AxisSlots slots) {
    return static_cast<std::int32_t>(node.axis_parameter(slots, axis));
  };
  const auto milli = [&](AxisSlots slots) { return static_cast<float>(value(slots)) * 1e-3F; };
  motor::AxisConfig config;
  config.motor_measured = value(slot_of_axes(object::kPhaseResistance)) != 0 &&
                          value(slot_of_axes(object::kPhaseInductance)) != 0;
  config.motor = kUnknownMotor;
  config.bandwidth_hz = kUnknownBandwidthHz;
  if (config.motor_measured) {
    config.motor.resistance_ohm = milli(slot_of_axes(object::kPhaseResistance));
    config.motor.inductance_h = static_cast<float>(value(slot_of_axes(object::kPhaseInductance))) * 1e-6F;
    config.bandwidth_hz = static_cast<float>(value(slot_of_axes(object::kCurrentBandwidth)));
  }
  config.motor.flux_vs = static_cast<float>(value(slot_of_axes(object::kFluxLinkage))) * 1e-6F;
  config.dead_time_share = kDeadTimeShare;
  config.run_a = milli(slot_of_axes(object::kRunCurrent));
  config.hold_a = milli(slot_of_axes(object::kHoldCurrent));
  config.boost_a = milli(slot_of_axes(object::kBoostCurrent));
  config.inverted = node.drive(axis).inverted;
  const std::int32_t encoder = value(slot_of_axes(object::kEncoderMode));
  config.encoder = static_cast<motor::EncoderMode>((encoder & 3) % 3);
  config.encoder_reversed = (encoder & 4) != 0;
  config.encoder_offset = value(slot_of_axes(object::kEncoderOffset));
  config.following_window = value(slot_of_axes(object::kFollowingErrorWindow));
  config.following_periods =
      1 + value(slot_of_axes(object::kFollowingErrorTimeout)) * static_cast<int>(board::kControlHz / 1000);
  return config;
}

}  // namespace

bool MotorPort::start() {
  debug_control() = debug_control() | bit(24);
  dwt().CTRL = dwt().CTRL | bit(0);
  stage_.start();
  std::array<motor::Vector, 2> sum{};
  for (int i = 0; i < kZeroSamples; ++i) {
    const std::uint32_t before = ticks();
    if (!wait_until([&] { return ticks() != before; }, 100'000)) return false;
    for (int axis = 0; axis < 2; ++axis) {
      const auto [a, b] = PowerStage::raw(axis);
      sum[static_cast<std::size_t>(axis)].x += static_cast<float>(a);
      sum[static_cast<std::size_t>(axis)].y += static_cast<float>(b);
    }
  }
  bool good = true;
  for (int axis = 0; axis < 2; ++axis) {
    const motor::Vector zero{sum[static_cast<std::size_t>(axis)].x / kZeroSamples,
                             sum[static_cast<std::size_t>(axis)].y / kZeroSamples};
    good = good && std::fabs(zero.x - board::kCurrentZero) < kMostZeroError &&
           std::fabs(zero.y - board::kCurrentZero) < kMostZeroError;
    if (good) stage_.set_zero(axis, zero.x, zero.y);
  }
  return good;
}

void MotorPort::on_control() {
  const std::uint32_t began = dwt().CYCCNT;
  const std::uint32_t counts = local_counts();
  adc(1).SR = ~Adc::kInjectedEnd;
  stage_.serve_slow();
  const std::array<std::uint16_t, 2> frames{PowerStage::take_encoder(0), PowerStage::take_encoder(1)};
  const MotionPlan& plan = plan_.current();
  for (int axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const MotionPlan::Point point = plan.at(axis, counts);
    motor::AxisInputs in;
    in.current_a = stage_.currents(axis);
    in.supply_v = stage_.supply_v();
    in.temperature_c = stage_.temperature_c(axis);
    in.position = point.position;
    // Of 2^-32 counts in 512 us: 20 bits fewer fit a word.
    constexpr float kPerSecond = 1.0F / (4096.0F * 512e-6F);
    in.velocity = static_cast<float>(static_cast<std::int32_t>(point.velocity >> 20)) * kPerSecond;
    in.encoder_frame = frames[i];
    in.break_seen = broken_[i].load(std::memory_order_relaxed);
    if (in.break_seen) broken_[i].store(false, std::memory_order_relaxed);
    stage_.apply(axis, control_[i].step(in));
  }
  PowerStage::begin_encoder(0);
  PowerStage::begin_encoder(1);
  ticks_.store(ticks_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  cycles_.last = dwt().CYCCNT - began;
  if (cycles_.last > cycles_.worst) cycles_.worst = cycles_.last;
}

void MotorPort::on_break(int axis) {
  broken_[static_cast<std::size_t>(axis)].store(true, std::memory_order_relaxed);
  stage_.after_break(axis);
}

bool MotorPort::serve(Node& node, LocalTime now) {
  const bool tripped = (control_[0].tripped() != motor::fault::kNone && !served_[0].fault_told) ||
                       (control_[1].tripped() != motor::fault::kNone && !served_[1].fault_told);
  if (now < due_ && !tripped) return false;
  due_ = now + kServe;
  const bool slow = now >= slow_due_;
  if (slow) slow_due_ = now + kSlowly;
  bool told = false;
  for (int axis = 0; axis < 2; ++axis) {
    told = serve_power(node, now, axis) || told;
    told = serve_troubles(node, now, axis) || told;
    if (slow) serve_slowly(node, axis);
  }
  return told;
}

bool MotorPort::serve_power(Node& node, LocalTime now, int axis) {
  motor::AxisControl& control = control_[static_cast<std::size_t>(axis)];
  Served& served = served_[static_cast<std::size_t>(axis)];
  const std::uint16_t code = control.tripped();
  if (code != motor::fault::kNone && !served.fault_told) {
    served.fault_told = true;
    served.fault_at = now;
    control.set_power(false);
    node.on_drive_fault(now, axis, code);
    return true;
  }
  const DriveOutput drive = node.drive(axis);
  if (served.fault_told) {
    const bool calm = now - served.fault_at >= kFaultRest &&
                      stage_.supply_v() < motor::Surroundings::kDeadlyV &&
                      !motor::Surroundings::deadly_heat(stage_.temperature_c(axis));
    if (!calm || drive.power) return false;
    control.acknowledge();
    served.fault_told = false;
    node.on_drive_fault_gone(now, axis);
    return true;
  }
  control.set_resting(drive.holding);
  control.set_power(drive.power);
  return false;
}

bool MotorPort::serve_troubles(Node& node, LocalTime now, int axis) {
  Served& served = served_[static_cast<std::size_t>(axis)];
  const std::uint8_t other = served_[static_cast<std::size_t>(1 - axis)].troubles;
  // Without power a low supply or a warm board is nobody's trouble.
  const std::uint8_t present =
      node.drive(axis).power ? control_[static_cast<std::size_t>(axis)].troubles() : std::uint8_t{0};
  if (present == served.troubles) return false;
  for (const Trouble& trouble : kTroubles) {
    const bool is = (present & trouble.bit) != 0, was = (served.troubles & trouble.bit) != 0;
    if (is && !was) node.on_axis_trouble(now, axis, trouble.code);
    if (!is && was && (other & trouble.bit) == 0) node.on_axis_trouble_gone(trouble.code);
  }
  served.troubles = present;
  return true;
}

void MotorPort::serve_slowly(Node& node, int axis) {
  motor::AxisControl& control = control_[static_cast<std::size_t>(axis)];
  Served& served = served_[static_cast<std::size_t>(axis)];
  static_cast<void>(control.configure(config_of(node, axis)));
  if (node.take_tune_request(axis)) control.request_tune();
  const motor::AutoTune::State tune = control.tune_state();
  if (tune == motor::AutoTune::State::kDone && served.tune == motor::AutoTune::State::kRuns) {
    const motor::AutoTune::Result result = control.tune_result();
    node.set_motor(axis, static_cast<std::uint32_t>(result.resistance_ohm * 1e3F + 0.5F),
                   static_cast<std::uint32_t>(result.inductance_h * 1e6F + 0.5F),
                   control.tuned_encoder_offset());
  }
  served.tune = tune;
  node.set_feedback(axis, {.following_error = control.following_error(),
                           .supply_mv = static_cast<std::uint16_t>(stage_.supply_v() * 1e3F),
                           .temperature_dc = static_cast<std::int16_t>(stage_.temperature_c(axis) * 10),
                           .current_ma = static_cast<std::int16_t>(control.amplitude_a() * 1e3F),
                           .tune_state = static_cast<std::uint8_t>(tune)});
}

}  // namespace kinebus::stm32
