#pragma once
// What the machine file says of one joint: where its motor is, how that turns the joint, how fast it may be,
// how it finds its zero, and what is known of motor and scale.

#include <cstdint>
#include <optional>
#include <string>

#include "gateway/calibration/joint_calibration.hpp"
#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// From motor to joint. A unit is mm for a linear joint, rad for a rotary one.
struct DriveTrain {
  std::uint32_t full_steps_per_turn = 200;
  std::uint32_t microsteps = 256;  ///< a full step
  double travel_per_turn = 40;     ///< mm or rad of the joint for one turn of the motor
  bool inverted = false;           ///< positive counts move the joint in the negative direction

  /// Signed: negative when inverted. Calibration is not in it.
  double counts_per_unit() const {
    const double counts = static_cast<double>(full_steps_per_turn) * static_cast<double>(microsteps);
    return (inverted ? -counts : counts) / travel_per_turn;
  }
  friend bool operator==(const DriveTrain&, const DriveTrain&) = default;
};

/// How a joint finds its zero. Directions are those of the joint; an inverted drive runs the mirrored CiA
/// method.
struct HomingDescription {
  /// CiA 402 method in joint directions: 19/20 home switch near the positive end, 21/22 near the negative
  /// end, 17/18 negative/positive limit switch, 37 take the present position; -3/-4 the mechanical stop at
  /// the positive/negative end, found by the load that the motor's driver sees.
  std::int8_t method = 22;
  std::uint8_t switch_input = 1;  ///< 1..7, on the joint's own node
  double fast_per_s = 40;         ///< mm/s or rad/s
  double slow_per_s = 4;
  double accel_per_s2 = 500;
  double back_off = 5;          ///< mm or rad off the switch before the slow approach
  double switch_position = 40;  ///< joint position at the switch's edge: the home position
  double max_search = 600;      ///< mm or rad travelled without finding the switch: alarm
  /// Joints of one order home together, order 1 first; 0: it follows from the kinematics (homing/plan.hpp).
  std::uint8_t order = 0;
  /// By load: 1 .. 255, at what load the driver says stop, 255 the lightest; none: at a switch.
  std::optional<std::uint32_t> stall_threshold{};
  double stall_above_per_s = 0;  ///< mm/s or rad/s: slower, the driver's load says nothing

  static constexpr std::int8_t kPositiveStop = -3, kNegativeStop = -4;
  bool by_load() const { return method == kPositiveStop || method == kNegativeStop; }
  bool at_switch() const { return method >= 17 && method <= 22; }
  bool towards_positive() const {
    return method == 18 || method == 19 || method == 20 || method == kPositiveStop;
  }
  /// +1: the edge is taken moving in positive direction, which leaves the joint on that side of its gap.
  double edge_direction() const {
    return method == 18 || method == 19 || method == 22 || method == kNegativeStop ? -1 : 1;
  }
  /// The method to write to the node (0x6098): the mirrored one for an inverted drive train.
  std::int8_t node_method(const DriveTrain& drive) const {
    if (!drive.inverted) return method;
    switch (method) {
      case 17:
        return 18;
      case 18:
        return 17;
      case 19:
        return 21;
      case 20:
        return 22;
      case 21:
        return 19;
      case 22:
        return 20;
      case kPositiveStop:
        return kNegativeStop;
      case kNegativeStop:
        return kPositiveStop;
      default:
        return method;
    }
  }
  friend bool operator==(const HomingDescription&, const HomingDescription&) = default;
};

/// What the node's control has to know of the motor, from its data sheet or measured (2150h).
struct MotorDescription {
  enum class Encoder : std::uint8_t { kNone, kWatch, kClosedLoop };  ///< as 2150h:6 counts them
  double resistance_ohm = 0;  ///< of a phase; 0, or without inductance: the node's cautious guess
  double inductance_mh = 0;
  double torque_nm_per_a = 0;  ///< holding torque / rated current / sqrt 2; 0: no back-EMF is fed forward
  Encoder encoder = Encoder::kNone;
  bool encoder_reversed = false;
  std::int32_t encoder_offset_counts = -1;  ///< where the motor's angle is 0, found by auto-tune; -1: unknown
  friend bool operator==(const MotorDescription&, const MotorDescription&) = default;
};

/// A linear scale beside the rail, that measures the carriage itself and not its motor.
struct ScaleDescription {
  double pulses_per_mm = 0;  ///< counts a millimetre: every edge of a quadrature, steps of an absolute one
  bool inverted = false;     ///< it counts down when the joint's value grows
  /// The motor is led to where the scale has the joint, slowly: drift, not dynamics. By so much at most, mm;
  /// 0: it is not. More, or a scale that stands while the joint moves, stops the machine on the path.
  double correction_mm = 0;
  double correction_mm_per_s = 0.05;
  /// It tells where it is, by SSI on the motor's encoder port, in so many bits; none: pulses (quadrature).
  std::optional<std::uint32_t> absolute_bits{};
  bool gray_code = false;  ///< of an absolute one; else binary
  friend bool operator==(const ScaleDescription&, const ScaleDescription&) = default;
};

/// The stepper driver behind a board's step and direction pins (2170h), where it is a chip of its own.
struct DriverDescription {
  bool stands_alone = false;  ///< nobody is to speak to it: another chip than a TMC, or its jumpers say so
  /// Of its module; none: as most modules of the chip have it. Currents follow from it.
  std::optional<std::uint32_t> sense_resistor_mohm{};
  double stealthchop_below_per_s = 0;  ///< mm/s or rad/s: quiet up to there; 0: SpreadCycle at all speeds
  friend bool operator==(const DriverDescription&, const DriverDescription&) = default;
};

struct JointDescription {
  std::string name;          ///< as Kinematics::joint_info names it: "tower1", "C", "E"
  bool rotary = false;       ///< units are rad instead of mm
  std::uint8_t node_id = 1;  ///< 1..126
  std::uint8_t axis = 0;     ///< 0 or 1 on that node (A or B)
  DriveTrain drive;
  Interval travel;  ///< min == max: endless
  double speed_per_s = 450;
  double accel_per_s2 = 5000;
  double jerk_per_s3 = 0;            ///< 0: in proportion to the tool's; counts where that is limited
  double stop_accel_per_s2 = 10000;  ///< path deceleration and stop ramp together stay below it
  std::uint16_t run_current_ma = 2000;
  std::uint16_t hold_current_ma = 1500;
  std::optional<std::uint32_t> max_current_ma{};  ///< what M906 may ask for at most; none: run_current_ma
  std::optional<DriverDescription> driver;        ///< none: spoken to, as most of its kind
  std::optional<MotorDescription> motor;          ///< none: the node's cautious guess, no encoder
  std::optional<ScaleDescription> scale;          ///< none: nobody but the motor knows where the joint is
  std::optional<HomingDescription> homing;        ///< none: the position at power-up is zero (E, endless C)
  JointCalibration calibration;
  /// Its position is measured.
  bool has_encoder() const { return motor && motor->encoder != MotorDescription::Encoder::kNone; }
  friend bool operator==(const JointDescription&, const JointDescription&) = default;
};

}  // namespace kinebus
