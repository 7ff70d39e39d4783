#pragma once
// What a machine has besides motion, and where each of it lives. Units in the names; temperatures in deg C.

#include <array>
#include <chrono>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// Where a device lives. Named in the machine file by `where`.
struct DevicePlace {
  enum class Where : std::uint8_t { kSimulated, kNode };
  Where where = Where::kSimulated;
  std::uint8_t node_id = 0;  ///< 1..126; of kNode
  std::uint8_t channel = 0;  ///< 1 ..: among the node's channels of this kind; of kNode
  bool on_node() const { return where == Where::kNode; }
  friend bool operator==(const DevicePlace&, const DevicePlace&) = default;
};

enum class HeaterKind : std::uint8_t { kHotend, kBed, kChamber };
inline constexpr std::size_t kHeaterKinds = 3;
inline constexpr std::uint8_t kMostOfAKind = 8;  ///< heaters of a kind; fans; outputs; inputs

/// Which heater: hot ends count as tools do (T0, T1, ...), beds and chambers among themselves.
struct HeaterId {
  HeaterKind kind = HeaterKind::kHotend;
  std::uint8_t index = 0;
  friend bool operator==(const HeaterId&, const HeaterId&) = default;
  friend bool operator<(const HeaterId& a, const HeaterId& b) {
    return a.kind != b.kind ? a.kind < b.kind : a.index < b.index;
  }
};
/// What is known of the targets of hot ends, by index, deg C; none: nothing.
using HotendTargets = std::array<std::optional<double>, kMostOfAKind>;
inline constexpr HeaterId kFirstHotend{HeaterKind::kHotend, 0}, kFirstBed{HeaterKind::kBed, 0};

/// What a heat node has, at most.
inline constexpr int kHeatNodeHeaters = 4, kHeatNodeSensors = 6, kHeatNodeOutputs = 6, kHeatNodeFilaments = 2;

/// A temperature sensor on a heat node, with the number that 6110h has for it.
enum class SensorElement : std::uint16_t {
  kPt100 = 30,
  kPt1000 = 33,
  kEpcos100k = 10001,
  kSemitec104Gt2 = 10002,
  kSemitec104Nt4 = 10003,
  kGeneric3950 = 10004,
  kSlice450 = 10005,
  kNtc100kMgb18 = 10006,
  kHoneywell100k = 10007,
  kTdkNtcg104 = 10008,
  kBeta = 10100,
  kPoints = 10101,
};
/// What it is made for, by its data sheet, deg C. Custom ones: unless the file says.
constexpr double made_for_c(SensorElement element) {
  switch (element) {
    case SensorElement::kPt100:
    case SensorElement::kPt1000:
      return 600;
    case SensorElement::kSlice450:
      return 450;
    case SensorElement::kTdkNtcg104:
      return 125;
    default:
      return 300;  // beads of glass
  }
}
struct SensorWiring {
  SensorElement element = SensorElement::kGeneric3950;
  bool max31865 = false;         ///< measured by that converter; else by a divider
  double reference_ohm = 4700;   ///< pull-up, or the converter's reference resistor
  int wires = 2;                 ///< of that converter, to the element: 2, 3 or 4
  double nominal_ohm = 100'000;  ///< of kBeta, at 25 C
  int beta_k = 3950;             ///< of kBeta
  /// Of kPoints: a thermistor by its resistance at three temperatures.
  std::array<double, 3> points_c{25, 150, 250}, points_ohm{100'000, 1770, 230};
  double highest_given_c = 0;  ///< what a custom one is made for; 0: as most are
  double highest_c() const { return highest_given_c > 0 ? highest_given_c : made_for_c(element); }
  bool is_thermistor() const { return element != SensorElement::kPt100 && element != SensorElement::kPt1000; }
  friend bool operator==(const SensorWiring&, const SensorWiring&) = default;
};

/// What a heat node is told of a heater, besides what it is for.
struct HeaterWiring {
  SensorWiring sensor{};  ///< on the input of the heater's number
  double limit_c = 0;     ///< hotter, the node takes its power; 0: kDefaultMargin_c above max_c
  double power_w = 40;    ///< at supply_v
  /// What filament takes up on its way through; 0: it is not heated ahead for.
  double filament_j_per_mm3_k = 0.0021;
  double supply_v = 24;               ///< 0: on a supply that the node does not measure
  bool relay = false;                 ///< switched in whole half waves of the mains
  std::chrono::seconds rise{20};      ///< gains 2 K in so long at full power, until the node has measured it
  double safe_c = 0;                  ///< what it falls to when the gateway is lost ...
  std::chrono::seconds safe_time{0};  ///< ... and stays at for so long
  std::uint8_t fan_channel = 0;       ///< of the fan that must turn while it is hot; 0: none
  std::uint8_t fan_pulses = 0;        ///< a turn, of its tacho; 0: it has none
  static constexpr double kDefaultMargin_c = 15, kLeastMargin_c = 10;
  double limit_for(double max_c) const { return limit_c > 0 ? limit_c : max_c + kDefaultMargin_c; }
  friend bool operator==(const HeaterWiring&, const HeaterWiring&) = default;
};

/// What people heat to for a filament, to be chosen by its name; no job reads it. 0: that kind stays as it
/// is.
struct MaterialDescription {
  std::string name;  ///< of its table
  double hotend_c = 0, bed_c = 0, chamber_c = 0;
  friend bool operator==(const MaterialDescription&, const MaterialDescription&) = default;
};

/// [camera.NAME]: what looks at the machine; another program sends its pictures. Addresses as
/// is_camera_address() has them.
struct CameraDescription {
  std::string name;      ///< of its table
  std::string stream;    ///< MJPEG
  std::string snapshot;  ///< one picture; empty: has none
  friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

/// Its limits, and the heat model that the simulated one uses.
struct HeaterDescription {
  std::string name;  ///< of its table
  HeaterKind kind = HeaterKind::kHotend;
  std::uint8_t index = 0;
  DevicePlace place{};
  double max_c = 300;
  double window_c = 2;             ///< reached: within the window ...
  std::chrono::seconds settle{3};  ///< ... for so long
  double sim_power_w = 40;
  double sim_heat_capacity_j_per_k = 10;
  double sim_loss_w_per_k = 0.12;
  HeaterWiring wiring{};  ///< on a node
  HeaterId id() const { return {kind, index}; }
  friend bool operator==(const HeaterDescription&, const HeaterDescription&) = default;
};

/// A fan of a print: M106 P.
struct FanDescription {
  std::string name;
  std::uint8_t index = 0;
  DevicePlace place{};
  std::chrono::milliseconds kick{200};  ///< on a node: full power so long when it starts
  int least_percent = 15;               ///< on a node: it turns from here on; less that is asked for is this
  friend bool operator==(const FanDescription&, const FanDescription&) = default;
};

/// Something that is switched or dimmed: M42 P.
struct OutputDescription {
  std::string name;
  std::uint8_t index = 0;
  DevicePlace place{};
  friend bool operator==(const OutputDescription&, const OutputDescription&) = default;
};

/// What M66 reads. On a node `channel` is a switch input without a function of its own.
struct InputDescription {
  std::string name;
  std::uint8_t index = 0;
  DevicePlace place{};
  bool sim_on = false;
  double sim_change_s = 0;  ///< the simulated one changes so often; 0: it stays as it is
  friend bool operator==(const InputDescription&, const InputDescription&) = default;
};

/// A temperature that is measured and not controlled.
struct SensorDescription {
  std::string name;
  DevicePlace place{};
  double sim_c = 23;
  SensorWiring wiring{};  ///< on a node
  friend bool operator==(const SensorDescription&, const SensorDescription&) = default;
};

/// With the number that 2250h has for it.
enum class FilamentSensorKind : std::uint8_t { kSwitch = 1, kMotion = 2 };

/// What tells whether filament is there, or whether it goes where the extruder turns. Its node judges it.
struct FilamentSensorDescription {
  std::string name;
  FilamentSensorKind kind = FilamentSensorKind::kSwitch;
  DevicePlace place{};
  bool inverted = false;      ///< of a switch: low with filament
  double mm_per_edge = 2.88;  ///< of a wheel, both edges of its signal counted
  double stands_mm = 7;       ///< fed without an edge: the filament stands
  double slips_mm = 30;       ///< over so much fed it moves less than least_share of it: it slips
  double least_share = 0.6;
  double sim_length_mm = 0;  ///< of the simulated spool, a switch at its end; 0: it never ends
  /// Nearer together the wheel's own steps would be taken for a fault.
  static constexpr double kLeastEdges = 2, kLeastSlipEdges = 5;
  friend bool operator==(const FilamentSensorDescription&, const FilamentSensorDescription&) = default;
};

/// What a mill cuts with.
struct SpindleDescription {
  bool present = false;
  DevicePlace place{};
  double min_rpm = 1000, max_rpm = 24000;
  bool reversible = false;  ///< M4
  /// Of an encoder on it, which lives where the spindle does, in a turn, with an index pulse; 0: there is
  /// none.
  int encoder_counts = 0;
  double tap_rpm_per_s = 0;  ///< how fast a tap turns it back (G33.1), less than it can; 0: no taps
  double sim_rpm_per_s = 6000;
  double sim_droop_percent = 0;  ///< so much slower under a load that comes and goes ...
  double sim_load_s = 0;         ///< ... once in this time, for half of it; 0: never
  friend bool operator==(const SpindleDescription&, const SpindleDescription&) = default;
};

/// What tells that the tool touches. On a node `channel` is the switch input that has the probe function.
struct ProbeDescription {
  bool present = false;
  DevicePlace place{};
  double speed_mm_per_s = 10;         ///< no probing is faster
  bool bltouch = false;               ///< a pin that the servo output of a heat node moves
  std::uint8_t servo_node = 0;        ///< that node
  std::array<double, 3> offset_mm{};  ///< where it touches, from the tool's tip, with A and C at 0
  /// What virtual nodes let it touch: a plane, in the part's frame.
  double sim_z_mm = 0;                ///< at X0 Y0
  std::array<double, 2> sim_slope{};  ///< mm of Z for each mm along X and Y
  double sim_bend_per_m = 0;          ///< curvature of a bowl, > 0, or a dome
  /// What the probe touches there, mm.
  double sim_surface_mm(double x_mm, double y_mm) const {
    return sim_z_mm + sim_slope[0] * x_mm + sim_slope[1] * y_mm +
           0.5e-3 * sim_bend_per_m * (x_mm * x_mm + y_mm * y_mm);
  }
  friend bool operator==(const ProbeDescription&, const ProbeDescription&) = default;
};

/// On the tool, on a heat node. Its directions: of the chip's, which lies along X, Y and Z; which way does
/// not matter.
struct AccelerometerDescription {
  bool present = false;
  std::uint8_t node = 0;
  enum class Axes : std::uint8_t { kXyz, kXzy, kYxz, kYzx, kZxy, kZyx } axes = Axes::kXyz;
  std::array<std::uint8_t, 3> directions() const {
    constexpr std::array<std::array<std::uint8_t, 3>, 6> kAll{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    return kAll[static_cast<std::size_t>(axes)];
  }
  friend bool operator==(const AccelerometerDescription&, const AccelerometerDescription&) = default;
};

/// Levelling of the bed: where G29 probes, and what a mesh may be like. In table coordinates.
struct MeshDescription {
  int points_x = 5, points_y = 5;
  Interval x_mm{}, y_mm{};  ///< not limited: the square within the machine's reach
  double lift_mm = 5;       ///< between two points
  double depth_mm = 2;      ///< so far below the table the probe looks for the bed
  double fade_mm = 10;      ///< the correction is gone from this height on; 0: never
  double limit_mm = 2;      ///< a bed that is farther from the table than this is refused
  friend bool operator==(const MeshDescription&, const MeshDescription&) = default;
};

/// What holds for all heat of the machine.
struct ThermalDescription {
  double ambient_c = 23;
  double min_extrude_c = 170;  ///< E does not move forward below it
  int mains_hz = 50;           ///< whose hum converters of resistance thermometers take away: 50 or 60
  /// Without a heartbeat of the gateway for so long heat nodes fall back to what is safe.
  std::chrono::milliseconds gateway_lost{5000};
  enum class After : std::uint8_t { kKeep, kOff };
  After on_stop = After::kOff;          ///< what heaters do at STOP; M112 and an E-stop input switch them off
  After on_cancel = After::kKeep;       ///< and when a job is cancelled
  std::chrono::seconds idle_off{1800};  ///< nothing moves for so long: off
  double lift_mm = 5;  ///< a job held by a heater's fault: the tool rises so far off the part; 0: not at all
  friend bool operator==(const ThermalDescription&, const ThermalDescription&) = default;
};

/// The functions that a node carries. Nothing is asked of a node that it does not have.
struct NodeFunctions {
  std::uint8_t axis_pairs = 1;  ///< CiA 402 axes A and B with their stream: 0 or 1
  std::uint8_t inputs = 7;      ///< switch inputs
  std::uint8_t heaters = 0;     ///< channels, each with its sensor
  std::uint8_t sensors = 0;     ///< channels that only measure
  std::uint8_t outputs = 0;     ///< channels for fans, outputs and a spindle
  std::uint8_t filament_sensors = 0;
  bool has_axes() const { return axis_pairs > 0; }
  friend bool operator==(const NodeFunctions&, const NodeFunctions&) = default;
};

}  // namespace kinebus
