#include "gateway/description/machine_rules.hpp"

#include <bit>
#include <cmath>
#include <cstdio>
#include <set>

#include "gateway/calibration/joint_map.hpp"
#include "gateway/description/bodies_rules.hpp"
#include "gateway/description/device_rules.hpp"
#include "gateway/description/load_homing_rules.hpp"
#include "gateway/description/machine_homing.hpp"
#include "gateway/gcode/letters.hpp"
#include "gateway/kinematics/tool_placement.hpp"

namespace kinebus {
namespace {

class Rules {
 public:
  explicit Rules(const MachineDescription& description) : d_(description) {}

  std::vector<BrokenRule> take() {
    for (std::size_t i = 0; i < d_.joints.size(); ++i) joint(d_.joints[i]);
    nodes();
    times();
    speeds();
    vibration();
    pressure_advance();
    judge_devices(d_, broken_);
    if (const auto kinematics = make_kinematics(d_); !kinematics) {
      broken_.push_back({geometry_keys(), say("a machine that cannot work"), kinematics.error().what});
    } else {
      judge_reach(d_, **kinematics, broken_);
      judge_bodies(d_, **kinematics, broken_);
    }
    // A machine with something else wrong has no ways worth looking at.
    if (broken_.empty()) judge_homing(d_, broken_);
    return std::move(broken_);
  }

 private:
  void require(bool holds, std::vector<std::string> keys, Sentence found, Sentence expected) {
    if (!holds) broken_.push_back({std::move(keys), std::move(found), std::move(expected)});
  }

  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
  }

  void joint(const JointDescription& j) {
    const std::string key = "joint." + j.name + ".";
    const std::string u = j.rotary ? "deg" : "mm";
    const double unit = j.rotary ? kRadPerDeg : 1;
    const auto shown = [&](double value) { return number(value / unit); };
    require(std::has_single_bit(j.drive.microsteps), {key + "microsteps"},
            Sentence::verbatim(std::to_string(j.drive.microsteps)), say("a power of two"));
    require(j.hold_current_ma <= j.run_current_ma, {key + "hold_current_ma", key + "run_current_ma"},
            Sentence::verbatim(std::to_string(j.hold_current_ma)),
            say("at most run_current_ma, %1", j.run_current_ma));
    const std::uint32_t most = j.max_current_ma.value_or(j.run_current_ma);
    require(most >= j.run_current_ma && most <= 5000, {key + "max_current_ma", key + "run_current_ma"},
            Sentence::verbatim(std::to_string(most)), say("run_current_ma, %1, to 5000", j.run_current_ma));
    const auto address = std::pair{j.node_id, j.axis};
    require(addresses_.insert(address).second, {key + "axis", key + "node"},
            say("node %1 axis %2", j.node_id, j.axis == 0 ? 'A' : 'B'),
            say("a node's axis that no other joint has"));
    // While the rate ramps down the path's own deceleration goes on: both together must stay below the stated
    // stop.
    const double ramp_s = static_cast<double>(d_.stop.ramp.count()) * 1e-3;
    const double needed = j.accel_per_s2 + j.speed_per_s / ramp_s;
    constexpr double kRounding = 1 + 1e-9;
    require(needed <= j.stop_accel_per_s2 * kRounding,
            {key + "stop_accel_" + u + "_per_s2", key + "accel_" + u + "_per_s2",
             key + "speed_" + u + "_per_s", "stop.ramp_ms"},
            Sentence::verbatim(shown(j.stop_accel_per_s2)),
            say("at least acceleration + speed / stop ramp = %1, or a longer stop.ramp_ms", shown(needed)));
    // Joint travel of a belt pair follows from X and Y and is no end stop to be found.
    const bool belt = std::holds_alternative<CoreXyGeometry>(d_.kinematics) && j.name.starts_with("belt");
    require(j.homing.has_value() || !j.travel.limited() || belt, {key + "homing", key + "travel_" + u},
            say("no table"), say("[%1homing]: a joint with limited travel must find its position", key));
    if (j.driver) driver(j, *j.driver, key);
    if (j.scale) {
      require(!j.rotary, {key + "scale.pulses_per_mm"}, say("a scale on a joint that turns"),
              say("a joint that moves along a rail"));
      // The edge of the switch is where scale and axis are known to be at the same place.
      require(j.homing && j.homing->at_switch(), {key + "scale.pulses_per_mm", key + "homing.method"},
              say("a scale on a joint that does not home at a switch"),
              say("[%1homing] with a method of 17..22: the switch's edge is where the scale begins", key));
      // These are commanded on purpose, and the scale would take them for drift.
      require(j.scale->correction_mm == 0 || j.calibration.linear(),
              {key + "scale.correction_mm", key + "calibration.backlash_mm", key + "calibration.table_mm",
               key + "calibration.pitch_mm"},
              say("a joint that is led by its scale and has an error that is not linear"),
              say("correction_mm = 0, or scale and offset alone in the calibration"));
    }
    if (j.scale) absolute_scale(j, *j.scale, key);
    if (j.homing) homing(j, *j.homing, key + "homing.");
    calibration(j, key + "calibration.");
  }

  void driver(const JointDescription& j, const DriverDescription& driver, const std::string& key) {
    const std::uint32_t sense = driver.sense_resistor_mohm.value_or(100);
    require(sense >= 10 && sense <= 1000, {key + "driver.sense_resistor_mohm"},
            Sentence::verbatim(std::to_string(sense)),
            say("10 to 1000: 110 on most modules, 75 with a TMC5160"));
    require(!driver.stands_alone || !j.homing || !j.homing->by_load(),
            {key + "driver.stands_alone", key + "homing.method"},
            say("homing by the load of a driver that nobody speaks to"),
            say("a method of 17..22 or 37, or no stands_alone"));
    const std::string u = j.rotary ? "deg" : "mm";
    require(!driver.stands_alone || (!driver.sense_resistor_mohm && driver.stealthchop_below_per_s == 0),
            {key + "driver.stands_alone", key + "driver.sense_resistor_mohm",
             key + "driver.stealthchop_below_" + u + "_per_s"},
            say("settings for a driver that nobody speaks to"), say("stands_alone alone, or without it"));
    require(!j.motor, {key + "driver", key + "motor"},
            say("a driver behind step and direction, and a motor that the node drives itself"),
            say("one of the two tables"));
  }

  void absolute_scale(const JointDescription& j, const ScaleDescription& scale, const std::string& key) {
    require(!scale.gray_code || scale.absolute_bits, {key + "scale.gray_code"},
            say("a code of a scale that tells no place"), say("absolute_bits, or no gray_code"));
    if (!scale.absolute_bits) return;
    const std::uint32_t bits = *scale.absolute_bits;
    require(bits >= 8 && bits <= 30, {key + "scale.absolute_bits"}, Sentence::verbatim(std::to_string(bits)),
            say("8 to 30 bits"));
    require(!j.has_encoder(), {key + "motor.encoder", key + "scale.absolute_bits"},
            say("an encoder and an absolute scale on one port"),
            say("encoder = \"none\", or a scale of pulses"));
    // A node that was busy for so long still knows which way round the scale has gone.
    constexpr double kUnread_s = 0.05;
    const double half_mm = std::exp2(static_cast<double>(bits)) / 2 / scale.pulses_per_mm;
    require(half_mm >= j.speed_per_s * kUnread_s, {key + "scale.absolute_bits", key + "speed_mm_per_s"},
            say("a scale that begins anew every %1 mm", number(2 * half_mm)),
            say("one that is at least %1 mm long at this speed", number(2 * j.speed_per_s * kUnread_s)));
  }

  void calibration(const JointDescription& j, const std::string& key) {
    const JointCalibration& c = j.calibration;
    const std::string u = j.rotary ? "deg" : "mm";
    require(c.pitch > 0 || (c.periodic_sine == 0 && c.periodic_cosine == 0),
            {key + "pitch_" + u, key + "periodic_sine_" + u, key + "periodic_cosine_" + u}, say("no pitch"),
            say("the pitch that the periodic error repeats with"));
    require(c.table.empty() || c.table.size() >= 2, {key + "table_" + u}, say("one number"),
            say("two or more"));
    require(c.table.empty() || c.table_step > 0, {key + "table_step_" + u, key + "table_" + u},
            Sentence::verbatim(number(c.table_step)), say("the distance of the table's places, above 0"));
    // A steeper error would be a joint that goes backwards, or nearly: no measurement of a machine says that.
    constexpr double kSteepest = 0.05;
    const double slope = JointMap(c).largest_slope();
    require(slope <= kSteepest, {key + "table_" + u, key + "table_step_" + u, key + "pitch_" + u},
            say("an error with a slope of %1", number(slope)), say("at most %1", number(kSteepest)));
    const JointReserve reserve = reserve_for(c, j.speed_per_s, j.accel_per_s2);
    require(reserve.accel_per_s2 > 0.1 * j.accel_per_s2 && reserve.speed_per_s > 0.1 * j.speed_per_s,
            {key + "table_" + u, key + "pitch_" + u, key + "backlash_" + u},
            say("a correction that needs nearly all of the joint's speed or acceleration"),
            say("smaller errors, or higher limits of the joint"));
  }

  void homing(const JointDescription& j, const HomingDescription& h, const std::string& key) {
    const std::string u = j.rotary ? "deg" : "mm";
    const double unit = j.rotary ? kRadPerDeg : 1;
    const auto shown = [&](double value) { return number(value / unit); };
    require(h.at_switch() || h.method == 37 || h.by_load(), {key + "method"},
            Sentence::verbatim(std::to_string(h.method)), say("17..22, 37, -3 or -4"));
    judge_load_keys(j, h, key, broken_);
    require(h.slow_per_s <= h.fast_per_s, {key + "slow_" + u + "_per_s", key + "fast_" + u + "_per_s"},
            Sentence::verbatim(shown(h.slow_per_s)), say("at most the fast speed, %1", shown(h.fast_per_s)));
    require(h.fast_per_s <= j.speed_per_s,
            {key + "fast_" + u + "_per_s", "joint." + j.name + ".speed_" + u + "_per_s"},
            Sentence::verbatim(shown(h.fast_per_s)),
            say("at most the joint's speed, %1", shown(j.speed_per_s)));
    require(h.accel_per_s2 <= j.accel_per_s2,
            {key + "accel_" + u + "_per_s2", "joint." + j.name + ".accel_" + u + "_per_s2"},
            Sentence::verbatim(shown(h.accel_per_s2)),
            say("at most the joint's acceleration, %1", shown(j.accel_per_s2)));
    require(!j.travel.limited() || (h.switch_position >= j.travel.min && h.switch_position <= j.travel.max),
            {key + "switch_position_" + u, "joint." + j.name + ".travel_" + u},
            Sentence::verbatim(shown(h.switch_position)),
            say("within the joint's travel, %1 .. %2", shown(j.travel.min), shown(j.travel.max)));
    if (h.method == 37) return;
    away_from_nozzle(j, h, key + "method");
    const NodeDescription* node = d_.node(j.node_id);
    if (node == nullptr) return;
    const InputFunction wanted = h.method == 17   ? InputFunction::kNegativeLimit
                                 : h.method == 18 ? InputFunction::kPositiveLimit
                                                  : InputFunction::kHome;
    const SwitchInput& input = node->inputs[h.switch_input - 1u];
    const char axis = j.axis == 0 ? 'A' : 'B';
    const std::string input_key =
        "node." + std::to_string(j.node_id) + ".input" + std::to_string(h.switch_input);
    require(input.function == wanted && input.axis == j.axis,
            {key + "switch_input", input_key + ".function", input_key + ".axis"},
            Sentence::verbatim(std::to_string(h.switch_input)),
            wanted == InputFunction::kHome
                ? say("an input of node %1 that has the home function for axis %2", j.node_id, axis)
                : say("an input of node %1 that has the limit function for axis %2", j.node_id, axis));
    require(!h.by_load() || !input.active_low, {input_key + ".active_low", key + "method"},
            say("an input that is active when it is low"),
            say("active_low = false: DIAG of a driver is high when it tells a stop"));
  }

  /// M1 and M5: a platform that homes towards the tool, or the tool towards the table, runs into it.
  void away_from_nozzle(const JointDescription& j, const HomingDescription& h, const std::string& key) {
    const auto* m1 = std::get_if<M1Geometry>(&d_.kinematics);
    const auto* m5 = std::get_if<M5Geometry>(&d_.kinematics);
    const M1Geometry* g = m5 != nullptr ? m5 : m1;
    const auto leg = static_cast<std::size_t>(&j - d_.joints.data());
    if (g == nullptr || leg >= g->legs.size()) return;
    const Vector3& rail = g->legs[leg].rail;
    const double length = std::hypot(rail[0], rail[1], rail[2]);
    if (!(length > 0)) return;
    // A rail nearer to level than 60 deg from upright carries the platform past the nozzle more than towards
    // it.
    constexpr double kTowards = 0.5;
    const double towards = approach_direction(*g) * (h.towards_positive() ? 1 : -1) * rail[2] / length;
    const int other = h.by_load()      ? -7 - h.method
                      : h.method <= 18 ? 35 - h.method
                      : h.method <= 20 ? h.method + 2
                                       : h.method - 2;
    require(towards <= kTowards,
            {key, "kinematics.leg" + std::to_string(leg + 1) + ".rail", "kinematics.tool"},
            say("%1, which homes towards the nozzle", static_cast<int>(h.method)),
            say("homing away from the nozzle: method %1, with the switch at the rail's other end", other));
  }

  void nodes() {
    for (const JointDescription& j : d_.joints)
      require(d_.node(j.node_id) != nullptr, {"joint." + j.name + ".node"},
              Sentence::verbatim(std::to_string(j.node_id)),
              say("a node that has its table, [node.%1]", j.node_id));
  }

  void times() {
    const auto even = [&](const char* key, std::chrono::milliseconds ramp) {
      require(ramp.count() % 2 == 0, {key}, Sentence::verbatim(std::to_string(ramp.count())),
              say("an even number: ramps travel in 2 ms"));
    };
    even("stop.ramp_ms", d_.stop.ramp);
    even("stop.hold_ramp_ms", d_.stop.hold_ramp);
    require(d_.stop.hold_ramp >= d_.stop.ramp, {"stop.hold_ramp_ms", "stop.ramp_ms"},
            Sentence::verbatim(std::to_string(d_.stop.hold_ramp.count())),
            say("at least stop.ramp_ms, %1", d_.stop.ramp.count()));
    const BusDescription& b = d_.bus;
    require(b.sync_timeout >= 2 * b.sync_period, {"bus.sync_timeout_ms", "bus.sync_period_ms"},
            Sentence::verbatim(std::to_string(b.sync_timeout.count())),
            say("at least two SYNC periods, %1", 2 * b.sync_period.count()));
    require(b.heartbeat_timeout >= 2 * b.heartbeat_period,
            {"bus.heartbeat_timeout_ms", "bus.heartbeat_period_ms"},
            Sentence::verbatim(std::to_string(b.heartbeat_timeout.count())),
            say("at least two heartbeats, %1", 2 * b.heartbeat_period.count()));
    require(!b.interface.empty() && b.interface.size() < 16, {"bus.interface"},
            Sentence::verbatim(b.interface), say("a network interface's name of 1 .. 15 characters"));
  }

  void speeds() {
    require(d_.gcode.traverse_mm_per_s <= d_.path.tool_speed_mm_per_s,
            {"gcode.traverse_mm_per_s", "path.tool_speed_mm_per_s"},
            Sentence::verbatim(number(d_.gcode.traverse_mm_per_s)),
            say("at most the tool's speed, %1", number(d_.path.tool_speed_mm_per_s)));
    for (const double side : d_.gcode.tool_orientation)
      require(side == std::floor(side), {"gcode.tool_orientation"}, Sentence::verbatim(number(side)),
              say("a whole number in %1 .. %2", 0, 9));
    for (const MacroDescription& macro : d_.macros)
      for (const MacroDescription* other = d_.macros.data(); other != &macro; ++other)
        require(gcode::in_lower_case(other->name) != gcode::in_lower_case(macro.name),
                {"macro." + macro.name, "macro." + other->name}, Sentence::verbatim(macro.name),
                say("another name than %1: upper and lower case are the same", other->name));
    require(!d_.name.empty(), {"name"}, say("an empty name"), say("a name"));
    require(!d_.jobs_directory.empty(), {"jobs_directory"}, say("an empty path"), say("a directory"));
  }

  void vibration() {
    const VibrationDescription& v = d_.vibration;
    const auto has_frequency = [&](const AxisVibration& a, const std::string& key) {
      require(a.shaper == ShaperKind::kNone || a.frequency_hz > 0, {key + "frequency_hz", key + "shaper"},
              say("no frequency"), say("the frequency of the vibration that the shaper is for"));
    };
    has_frequency(v.every, "vibration.");
    const std::pair<const std::optional<AxisVibration>*, const char*> axes[] = {
        {&v.x, "vibration.x."}, {&v.y, "vibration.y."}, {&v.z, "vibration.z."}};
    for (const auto& [axis, key] : axes)
      if (*axis) has_frequency(**axis, key);
    require(v.deviation_mm == 0 || v.shapes(), {"vibration.deviation_um", "vibration.shaper"},
            say("a deviation without a shaper"), say("a shaper: without one nothing is moved off its path"));
    // X of the part is not X of the frame when the table has turned.
    require(v.axis(0) == v.axis(1) && v.axis(1) == v.axis(2) ? true : !turns(),
            {"vibration.x", "vibration.y", "vibration.z", "vibration.shaper"},
            say("different shapers on a machine that turns or tilts the part"),
            say("one shaper for X, Y and Z, in [vibration] itself"));
  }

  void pressure_advance() {
    const AdvanceModel& a = d_.pressure_advance;
    require((a.kind == AdvanceKind::kLinear) == (a.nonlinear_mm == 0),
            {"pressure_advance.nonlinear_mm", "pressure_advance.model"},
            Sentence::verbatim(number(a.nonlinear_mm)),
            a.kind == AdvanceKind::kLinear ? say("no such key with a linear model")
                                           : say("the filament that this model presses together at most"));
  }

  bool turns() const {
    const auto kinematics = make_kinematics(d_);
    return kinematics && turns_part(**kinematics);
  }

  /// A geometry may fail through any of its keys or the joints' travel: only judged when all of them could be
  /// read.
  std::vector<std::string> geometry_keys() const {
    std::vector<std::string> keys{"kinematics"};
    for (const JointDescription& j : d_.joints)
      keys.push_back("joint." + j.name + ".travel_" + (j.rotary ? "deg" : "mm"));
    return keys;
  }

  const MachineDescription& d_;
  std::vector<BrokenRule> broken_;
  std::set<std::pair<std::uint8_t, std::uint8_t>> addresses_;
};

}  // namespace

std::vector<BrokenRule> broken_rules(const MachineDescription& description) {
  return Rules(description).take();
}

}  // namespace kinebus
