#include "node_firmware/board/motor_supervision.hpp"

#include <cmath>

namespace kinebus {
namespace {

constexpr LocalTime kServe = std::chrono::microseconds{250};
constexpr LocalTime kSlowly = std::chrono::milliseconds{5};
// What a fault has left in windings and comparators has gone by then.
constexpr LocalTime kFaultRest = std::chrono::milliseconds{100};

// A winding that nobody has measured: gains that are stable with anything from 0.5 mH on.
constexpr motor::MotorModel kUnknownMotor{1.0F, 0.8e-3F, 0};
constexpr float kUnknownBandwidthHz = 500;

struct Trouble {
  std::uint8_t bit;
  std::uint16_t code;
};
constexpr std::array<Trouble, 5> kTroubles{{{motor::Surroundings::kUnder, motor::fault::kUnderVoltage},
                                            {motor::Surroundings::kOver, motor::fault::kOverVoltage},
                                            {motor::Surroundings::kHot, motor::fault::kTemperature},
                                            {motor::Surroundings::kEncoder, motor::fault::kEncoder},
                                            {motor::Surroundings::kFollowing, motor::fault::kFollowing}}};

motor::AxisConfig config_of(const Node& node, int axis, const BridgeFacts& bridges) {
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
  config.dead_time_share = bridges.dead_time_share;
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
      1 + value(slot_of_axes(object::kFollowingErrorTimeout)) * bridges.control_hz / 1000;
  return config;
}

}  // namespace

bool MotorSupervision::serve(Node& node, LocalTime now, const BridgeReadings& readings) {
  const bool tripped = (control_[0].tripped() != motor::fault::kNone && !served_[0].fault_told) ||
                       (control_[1].tripped() != motor::fault::kNone && !served_[1].fault_told);
  if (now < due_ && !tripped) return false;
  due_ = now + kServe;
  readings_ = readings;
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

bool MotorSupervision::serve_power(Node& node, LocalTime now, int axis) {
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
    const bool calm =
        now - served.fault_at >= kFaultRest && motor::Surroundings::is_supply(readings_.supply_v) &&
        readings_.supply_v < motor::Surroundings::kDeadlyV &&
        !motor::Surroundings::deadly_heat(readings_.temperature_c[static_cast<std::size_t>(axis)]);
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

bool MotorSupervision::serve_troubles(Node& node, LocalTime now, int axis) {
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

void MotorSupervision::serve_slowly(Node& node, int axis) {
  motor::AxisControl& control = control_[static_cast<std::size_t>(axis)];
  Served& served = served_[static_cast<std::size_t>(axis)];
  static_cast<void>(control.configure(config_of(node, axis, bridges_)));
  if (node.take_tune_request(axis)) control.request_tune();
  const motor::AutoTune::State tune = control.tune_state();
  if (tune == motor::AutoTune::State::kDone && served.tune == motor::AutoTune::State::kRuns) {
    const motor::AutoTune::Result result = control.tune_result();
    node.set_motor(axis, static_cast<std::uint32_t>(std::lround(result.resistance_ohm * 1e3F)),
                   static_cast<std::uint32_t>(std::lround(result.inductance_h * 1e6F)),
                   control.tuned_encoder_offset());
  }
  served.tune = tune;
  node.set_feedback(axis, {.following_error = control.following_error(),
                           .supply_mv = static_cast<std::uint16_t>(readings_.supply_v * 1e3F),
                           .temperature_dc = static_cast<std::int16_t>(
                               readings_.temperature_c[static_cast<std::size_t>(axis)] * 10),
                           .current_ma = static_cast<std::int16_t>(control.measured_a() * 1e3F),
                           .tune_state = static_cast<std::uint8_t>(tune)});
}

}  // namespace kinebus
