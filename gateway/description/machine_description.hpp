#pragma once
// Everything that one machine file says: one plain struct, units in the names, defaults where a default is
// safe. Inside: mm, s, rad. The file itself has degrees; machine_file.hpp reads and writes it.

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "gateway/bodies/bodies_description.hpp"
#include "gateway/description/device_description.hpp"
#include "gateway/description/joint_description.hpp"
#include "gateway/gcode/dialects.hpp"
#include "gateway/kinematics/geometry.hpp"
#include "gateway/shaping/advance_model.hpp"
#include "gateway/shaping/input_shaper.hpp"

namespace kinebus {

using KinematicsGeometry =
    std::variant<M1Geometry, CartesianGeometry, CoreXyGeometry, LinearDeltaGeometry, M4Geometry, M5Geometry>;

/// Where the tool may be, for kinematics that state it; nullptr: by the joints' travel alone.
const PoseLimits* pose_limits(const KinematicsGeometry& geometry);

/// Limits of the tool tip relative to the part, and of the pose axes that are no joints of their own.
struct PathDescription {
  double tool_speed_mm_per_s = 300;
  double tool_accel_mm_per_s2 = 3000;
  double tool_jerk_mm_per_s3 = 0;  ///< 0: no limit
  /// Of pose axes, by PoseAxis: mm or rad. 0: no limit of its own (the tool's, and the joints', still hold).
  Pose axis_speed_per_s{0, 0, 0, 90 * kRadPerDeg, 360 * kRadPerDeg, 60};
  Pose axis_accel_per_s2{0, 0, 0, 900 * kRadPerDeg, 3600 * kRadPerDeg, 3000};
  friend bool operator==(const PathDescription&, const PathDescription&) = default;
};

/// How one direction of the tool swings on its frame, and what is done about it.
struct AxisVibration {
  ShaperKind shaper = ShaperKind::kNone;
  double frequency_hz = 0;
  double damping_ratio = 0.1;
  friend bool operator==(const AxisVibration&, const AxisVibration&) = default;
};

struct VibrationDescription {
  AxisVibration every;                   ///< X, Y and Z
  std::optional<AxisVibration> x, y, z;  ///< in the place of that
  /// Shaping may move the tool so far off its path, mm; 0: as far as the tool's acceleration makes it.
  double deviation_mm = 0;
  /// Shapers are made for all rates of path time from here to 1; 0: for 1.
  double slowest_rate = 0;

  const AxisVibration& axis(std::size_t pose_axis) const;
  /// Motion is shaped at all.
  bool shapes() const;
  friend bool operator==(const VibrationDescription&, const VibrationDescription&) = default;
};

struct PathTolerances {
  double blend_mm = 0.005;      ///< corners (G64 without P)
  double merge_mm = 0.005;      ///< runs of short lines against the smooth curve put through them; 0: none is
  double segment_counts = 0.5;  ///< streamed segments against q(tau), in microsteps of each joint
  friend bool operator==(const PathTolerances&, const PathTolerances&) = default;
};

struct StopDescription {
  /// Path-time ramp for a full change of rate; whole 2 ms, 2..510 ms.
  std::chrono::milliseconds ramp{100};
  /// A gentler ramp for feed hold, resume and override.
  std::chrono::milliseconds hold_ramp{200};
  /// The gateway was not run for a while, and the nodes have stopped the job on its path.
  enum class AfterStall : std::uint8_t {
    kAsk,   ///< clear and resume are a person's
    kGoOn,  ///< by itself, where nothing else is wrong
  };
  AfterStall after_stall = AfterStall::kAsk;
  friend bool operator==(const StopDescription&, const StopDescription&) = default;
};

/// How an interrupted job goes on.
struct ResumeDescription {
  enum class Then : std::uint8_t {
    kAsk,   ///< on command
    kGoOn,  ///< by itself
  };
  Then after_restart = Then::kAsk;     ///< of the gateway, with nodes that know where they stand
  Then after_power_loss = Then::kAsk;  ///< of nodes: they have to home first
  /// The tool comes back to its place from so far above, where it has left it.
  double lift_mm = 5;
  double approach_mm_per_s = 10;  ///< down to the place
  double prime_mm = 0;            ///< filament pushed there, when the filament's position was lost
  friend bool operator==(const ResumeDescription&, const ResumeDescription&) = default;
};

/// A job that is set aside in its middle: by its operator, for a change of filament (M600), or because
/// nobody has gone on with it for long.
struct PauseDescription {
  double lift_mm = 10;                  ///< up from the part
  bool park = false;                    ///< and then over to:
  double park_x_mm = 0, park_y_mm = 0;  ///< machine coordinates
  double standby_c = 0;                 ///< a hot end that waits; 0: stays as hot as it is
  std::chrono::seconds standby_after{300};
  double unload_mm = 0, load_mm = 0;  ///< filament between the hot end and the hand that changes it
  double purge_mm = 20;
  double unload_mm_per_s = 20, load_mm_per_s = 5, purge_mm_per_s = 2.5;
  friend bool operator==(const PauseDescription&, const PauseDescription&) = default;
};

/// Whose orders nodes obey (protocol/README.md, "Trust on the bus").
enum class BusTrust : std::uint8_t {
  kOpen,     ///< everybody's: any CANopen master may speak beside the gateway
  kSession,  ///< in motion only what carries the session's check value
};

struct BusDescription {
  std::string interface = "can0";
  double budget = 0.60;  ///< share of the bus that streaming may use
  std::chrono::milliseconds sync_period{50};
  std::chrono::milliseconds sync_timeout{175};  ///< without SYNC for so long a node stops on the path
  std::chrono::milliseconds heartbeat_period{500};
  std::chrono::milliseconds heartbeat_timeout{1500};
  BusTrust trust = BusTrust::kOpen;
  friend bool operator==(const BusDescription&, const BusDescription&) = default;
};

// Named apart from the object table's SwitchFunction and kSwitchInputs (protocol/canopen/node_objects.hpp),
// which code of the gateway sees too.
enum class InputFunction : std::uint8_t {
  kNone,
  kHome,
  kPositiveLimit,
  kNegativeLimit,
  kEmergencyStop,
  kProbe
};

/// One of a node's seven switch inputs.
struct SwitchInput {
  InputFunction function = InputFunction::kNone;
  std::uint8_t axis = 0;  ///< 0 or 1: whose home or limit switch it is
  bool active_low = false;
  std::chrono::microseconds debounce{160};
  friend bool operator==(const SwitchInput&, const SwitchInput&) = default;
};
inline constexpr std::size_t kNodeInputs = 7;

struct NodeDescription {
  std::uint8_t id = 1;  ///< 1..126
  /// Identity expected in 0x1018; absent: anything is accepted.
  std::optional<std::uint32_t> vendor, product, serial;
  NodeFunctions functions{};
  std::array<SwitchInput, kNodeInputs> inputs{};  ///< input n is inputs[n - 1]
  friend bool operator==(const NodeDescription&, const NodeDescription&) = default;
};

struct HomingRun {
  /// Largest difference between the travels of carriages that home together. All stop beyond it: one of them
  /// has passed its switch. From the poses of M1's workspace (any tilt) the carriages' ways to their switches
  /// differ by up to 197 mm, and on the way down all rules of the workspace hold: leg angle, distances of the
  /// legs, condition number. With one carriage on its switch already, moved by hand, they differ by up to
  /// 248 mm.
  double max_spread_mm = 260;
  /// Height of the tallest part on the table that homing leaves alone wherever it begins; 0: not stated.
  double spared_part_mm = 0;
  std::chrono::seconds timeout{120};
  friend bool operator==(const HomingRun&, const HomingRun&) = default;
};

/// [macro.START_PRINT]: G-code that START_PRINT BED=60, M98 P"start_print" or o<start_print> call carries
/// out.
struct MacroDescription {
  std::string name;  ///< of its table; upper and lower case are the same
  std::string gcode;
  friend bool operator==(const MacroDescription&, const MacroDescription&) = default;
};

struct GcodeDescription {
  double initial_feed_mm_per_min = 1500;  ///< until the job states its first F
  /// What G4 P counts: milliseconds in printer firmware, seconds in RS274/NGC and on machines with a spindle.
  enum class DwellUnit : std::uint8_t { kByDialect, kMilliseconds, kSeconds };
  gcode::Dialect dialect = gcode::Dialect::kGeneral;  ///< kGeneral ("auto"): as the header of a job says
  double traverse_mm_per_s = 0;                       ///< tool speed of G0; 0: the tool's own limit
  double filament_diameter_mm = 1.75;
  double arc_radius_tolerance_mm = 0.01;  ///< start and end radius of G2/G3 may differ by it
  double retract_mm = 0.8;                ///< G10/G11 without words, or M207
  double retract_mm_per_s = 35;
  double retract_lift_mm = 0;
  DwellUnit dwell_p_unit = DwellUnit::kByDialect;
  std::vector<double> tool_length_mm;    ///< of T1, T2 ...: G43 takes it by H, or by T without H
  std::vector<double> tool_diameter_mm;  ///< of T1, T2 ...: G41 and G42 take half of it by D, or by the tool
                                         ///< in use; 0: not known
  std::vector<double> tool_orientation;  ///< of T1, T2 ...: where a lathe's tool has its tip, 1 to 8; 0: none
  bool optional_stop = false;            ///< M1 stops
  bool block_delete = false;             ///< lines that begin with / are left out
  friend bool operator==(const GcodeDescription&, const GcodeDescription&) = default;
};

/// Lines of a print host.
struct SerialDescription {
  /// Motion taken ahead: a host's pause, cancel or end brings the machine to rest within it.
  double lead_s = 2;
  friend bool operator==(const SerialDescription&, const SerialDescription&) = default;
};

struct MachineDescription {
  std::string name = "machine";
  KinematicsGeometry kinematics;         ///< travel and limits of joints and poses already filled in
  std::vector<JointDescription> joints;  ///< in the order of the kinematics' joints
  std::vector<NodeDescription> nodes;    ///< ascending ids; every node that a joint or device names
  PathDescription path;
  VibrationDescription vibration;
  AdvanceModel pressure_advance;  ///< until a job says another
  PathTolerances tolerances;
  StopDescription stop;
  ResumeDescription resume;
  PauseDescription pause;
  BusDescription bus;
  HomingRun homing;
  ThermalDescription thermal;
  // Devices, each in the order of its name.
  std::vector<HeaterDescription> heaters;
  std::vector<MaterialDescription> materials;
  std::vector<CameraDescription> cameras;
  std::vector<FanDescription> fans;
  std::vector<OutputDescription> outputs;
  std::vector<InputDescription> inputs;
  std::vector<SensorDescription> sensors;
  std::vector<FilamentSensorDescription> filament_sensors;
  SpindleDescription spindle;
  ProbeDescription probe;
  AccelerometerDescription accelerometer;
  MeshDescription mesh;
  GcodeDescription gcode;
  std::vector<MacroDescription> macros;     ///< called by name from jobs and lines
  std::optional<BodiesDescription> bodies;  ///< none: nobody knows what is solid, and nothing is checked
  SerialDescription serial;
  /// M1 and M5: how the machine's geometry was measured to differ from the one above it in the file.
  std::optional<M1Correction> geometry_calibration;
  std::string jobs_directory = "/var/lib/kinebus/jobs";
  friend bool operator==(const MachineDescription&, const MachineDescription&) = default;

  const NodeDescription* node(std::uint8_t id) const {
    for (const NodeDescription& n : nodes)
      if (n.id == id) return &n;
    return nullptr;
  }
  /// A heat node: heaters, fans, outputs or sensors, those of filament too, the servo of a probe or an
  /// accelerometer live on it.
  bool carries_heat(std::uint8_t id) const {
    const auto there = [id](const auto& devices) {
      for (const auto& device : devices)
        if (device.place.on_node() && device.place.node_id == id) return true;
      return false;
    };
    return there(heaters) || there(fans) || there(outputs) || there(sensors) || there(filament_sensors) ||
           (probe.bltouch && probe.servo_node == id) || (accelerometer.present && accelerometer.node == id);
  }
  const HeaterDescription* heater(HeaterId id) const {
    for (const HeaterDescription& h : heaters)
      if (h.id() == id) return &h;
    return nullptr;
  }
  /// The tools T0 .. T(n - 1) that a job may name: hot ends, and always one.
  int tools() const;
  /// Hot ends whose heaters are channels of this node.
  int hotends_on(std::uint8_t node_id) const;
};

/// The default machine: M1, 4 towers on nodes 1 and 2, table C and extruder E on node 3. Equal to
/// machines/m1.toml.
MachineDescription default_m1();

/// What is kept for a machine over restarts is found by this: its name and its joints' names. A file whose
/// limits or currents were changed is still the same machine.
std::string identity(const MachineDescription& description);

/// Of the geometry alone, calibration included: what was measured in the machine's coordinates means
/// something else when this is another.
std::uint64_t geometry_mark(const MachineDescription& description);

/// The names of the joints that this kind of kinematics has, in their order, and which of them turn.
struct JointName {
  std::string name;
  bool rotary = false;
};
std::vector<JointName> joint_names(const KinematicsGeometry& geometry);

/// The kinematics that the description states, calibration of the geometry included. Error: see geometry.hpp.
Result<std::unique_ptr<Kinematics>, GeometryError> make_kinematics(const MachineDescription& description);
/// A pose's A or C moves a joint: X of the part is not always X of the machine.
bool turns_part(const Kinematics& kinematics);

namespace bodies {
class CollisionModel;
}
/// What is solid of the machine, calibration of the geometry included; nullptr: the description has no
/// bodies. The description must be one that has kinematics.
std::unique_ptr<const bodies::CollisionModel> make_collision_model(const MachineDescription& description);

}  // namespace kinebus
