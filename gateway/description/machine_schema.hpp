#pragma once
// The keys of a machine file, each listed once with its unit, range and whether it may be left out. Reader
// and writer are visitors that walk this one list.
//
// `unit` turns the file's number into the inside one (degrees into radians). A table's own keys come before
// the tables in it.

#include <span>
#include <string>
#include <string_view>

#include "gateway/description/bodies_schema.hpp"
#include "gateway/description/device_schema.hpp"
#include "gateway/description/geometry_schema.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/description/schema_words.hpp"

namespace kinebus::machine_schema {

inline constexpr Choice kKinds[] = {{"m1", 0},           {"cartesian", 1}, {"corexy", 2},
                                    {"linear_delta", 3}, {"m4", 4},        {"m5", 5}};
inline constexpr Choice kAxes[] = {{"A", 0}, {"B", 1}};
inline constexpr Choice kAfterStall[] = {{"ask", static_cast<int>(StopDescription::AfterStall::kAsk)},
                                         {"go_on", static_cast<int>(StopDescription::AfterStall::kGoOn)}};
inline constexpr Choice kResumeThen[] = {{"ask", static_cast<int>(ResumeDescription::Then::kAsk)},
                                         {"go_on", static_cast<int>(ResumeDescription::Then::kGoOn)}};
inline constexpr Choice kBusTrust[] = {{"open", static_cast<int>(BusTrust::kOpen)},
                                       {"session", static_cast<int>(BusTrust::kSession)}};
inline constexpr Choice kDwellUnits[] = {
    {"dialect", static_cast<int>(GcodeDescription::DwellUnit::kByDialect)},
    {"ms", static_cast<int>(GcodeDescription::DwellUnit::kMilliseconds)},
    {"s", static_cast<int>(GcodeDescription::DwellUnit::kSeconds)}};
inline std::span<const Choice> dialect_choices() {
  static const std::vector<Choice> choices = [] {
    std::vector<Choice> all;
    for (const gcode::DialectRules& rules : gcode::dialects())
      all.push_back({rules.key, static_cast<int>(rules.dialect)});
    return all;
  }();
  return choices;
}
inline constexpr Choice kShapers[] = {
    {"none", static_cast<int>(ShaperKind::kNone)},       {"ZV", static_cast<int>(ShaperKind::kZv)},
    {"MZV", static_cast<int>(ShaperKind::kMzv)},         {"ZVD", static_cast<int>(ShaperKind::kZvd)},
    {"EI", static_cast<int>(ShaperKind::kEi)},           {"2HUMP", static_cast<int>(ShaperKind::kTwoHump)},
    {"3HUMP", static_cast<int>(ShaperKind::kThreeHump)}, {"ZVDD", static_cast<int>(ShaperKind::kZvdd)},
    {"ZVDDD", static_cast<int>(ShaperKind::kZvddd)}};
inline constexpr Choice kAdvanceKinds[] = {{"linear", static_cast<int>(AdvanceKind::kLinear)},
                                           {"tanh", static_cast<int>(AdvanceKind::kTanh)},
                                           {"reciprocal", static_cast<int>(AdvanceKind::kReciprocal)}};
inline constexpr Choice kEncoders[] = {
    {"none", static_cast<int>(MotorDescription::Encoder::kNone)},
    {"watch", static_cast<int>(MotorDescription::Encoder::kWatch)},
    {"closed_loop", static_cast<int>(MotorDescription::Encoder::kClosedLoop)}};
inline constexpr Choice kInputFunctions[] = {
    {"none", static_cast<int>(InputFunction::kNone)},
    {"home", static_cast<int>(InputFunction::kHome)},
    {"positive_limit", static_cast<int>(InputFunction::kPositiveLimit)},
    {"negative_limit", static_cast<int>(InputFunction::kNegativeLimit)},
    {"emergency_stop", static_cast<int>(InputFunction::kEmergencyStop)},
    {"probe", static_cast<int>(InputFunction::kProbe)}};

/// Empties the geometry of everything that a file may leave out, so that left out means "no limit", and sets
/// up the joints that this kinematics has. Does nothing when the description already is of this kind.
void prepare_kinematics(MachineDescription& d, int kind);
/// Which keys of [bodies] this kind of machine has.
BodyKeys body_keys(const KinematicsGeometry& geometry);
/// Gives the joints the names of the kinematics; keeps what already fits.
void prepare_joints(MachineDescription& d);
/// CoreXY's belts have no travel of their own: X and Y have.
bool has_own_travel(const MachineDescription& d, std::size_t joint);
/// Copies the joints' travel into the geometry, or, for belts, the geometry's into the joints.
void connect_travel(MachineDescription& d);

template <class V>
void visit_joint(V& v, JointDescription& j, bool own_travel) {
  const std::string u = j.rotary ? "deg" : "mm";
  const double unit = j.rotary ? kRadPerDeg : 1;
  v.integer("node", j.node_id, 1, 126, Need::kRequired);
  v.choice("axis", j.axis, kAxes, Need::kRequired);
  v.integer("full_steps_per_turn", j.drive.full_steps_per_turn, 4, 10000, Need::kOptional);
  v.integer("microsteps", j.drive.microsteps, 1, 256, Need::kOptional);
  v.number(u + "_per_turn", j.drive.travel_per_turn, {0.001, 100000}, Need::kRequired, unit);
  v.flag("inverted", j.drive.inverted, Need::kOptional);
  if (own_travel) v.interval("travel_" + u, j.travel, {-100000, 100000}, Need::kOptional, unit);
  v.number("speed_" + u + "_per_s", j.speed_per_s, {0.001, 100000}, Need::kRequired, unit);
  v.number("accel_" + u + "_per_s2", j.accel_per_s2, {0.1, 1e6}, Need::kRequired, unit);
  v.number("jerk_" + u + "_per_s3", j.jerk_per_s3, {0, 1e9}, Need::kOptional, unit);
  v.number("stop_accel_" + u + "_per_s2", j.stop_accel_per_s2, {0.1, 1e7}, Need::kRequired, unit);
  v.integer("run_current_ma", j.run_current_ma, 50, 5000, Need::kRequired);
  v.integer("hold_current_ma", j.hold_current_ma, 0, 5000, Need::kRequired);
  v.optional_integer("max_current_ma", j.max_current_ma);
  v.optional_table("driver", j.driver, [&](DriverDescription& d) {
    v.flag("stands_alone", d.stands_alone, Need::kOptional);
    v.optional_integer("sense_resistor_mohm", d.sense_resistor_mohm);
    v.unless_zero("stealthchop_below_" + u + "_per_s", d.stealthchop_below_per_s, {0.01, 10000}, unit);
  });
  v.optional_table("motor", j.motor, [&](MotorDescription& m) {
    v.number("resistance_ohm", m.resistance_ohm, {0, 60}, Need::kOptional);
    v.number("inductance_mh", m.inductance_mh, {0, 60}, Need::kOptional);
    v.number("torque_nm_per_a", m.torque_nm_per_a, {0, 3}, Need::kOptional);
    v.choice("encoder", m.encoder, kEncoders, Need::kOptional);
    v.flag("encoder_reversed", m.encoder_reversed, Need::kOptional);
    v.integer("encoder_offset_counts", m.encoder_offset_counts, -1, 1023, Need::kOptional);
  });
  v.optional_table("scale", j.scale, [&](ScaleDescription& s) {
    v.number("pulses_per_mm", s.pulses_per_mm, {1, 100000}, Need::kRequired);
    v.flag("inverted", s.inverted, Need::kOptional);
    v.number("correction_mm", s.correction_mm, {0, 5}, Need::kOptional);
    v.number("correction_mm_per_s", s.correction_mm_per_s, {0.001, 1}, Need::kOptional);
    v.optional_integer("absolute_bits", s.absolute_bits);
    v.flag("gray_code", s.gray_code, Need::kOptional);
  });
  v.optional_table("homing", j.homing, [&](HomingDescription& h) {
    v.integer("method", h.method, -4, 37, Need::kRequired);
    v.integer("switch_input", h.switch_input, 1, 7, Need::kOptional);
    v.number("fast_" + u + "_per_s", h.fast_per_s, {0.01, 10000}, Need::kRequired, unit);
    v.number("slow_" + u + "_per_s", h.slow_per_s, {0.001, 1000}, Need::kRequired, unit);
    v.number("accel_" + u + "_per_s2", h.accel_per_s2, {0.1, 1e6}, Need::kRequired, unit);
    v.number("back_off_" + u, h.back_off, {0, 1000}, Need::kRequired, unit);
    v.number("switch_position_" + u, h.switch_position, {-100000, 100000}, Need::kRequired, unit);
    v.number("max_search_" + u, h.max_search, {0.1, 100000}, Need::kRequired, unit);
    v.integer("order", h.order, 0, 8, Need::kOptional);
    v.optional_integer("stall_threshold", h.stall_threshold);
    v.unless_zero("stall_above_" + u + "_per_s", h.stall_above_per_s, {0.01, 10000}, unit);
  });
  v.table("calibration", Need::kOptional, [&] {
    v.number("scale", j.calibration.scale, {-0.05, 0.05}, Need::kOptional);
    v.number("offset_" + u, j.calibration.offset, {-50, 50}, Need::kOptional, unit);
    // What most machines never measure stays out of their files.
    v.unless_zero("backlash_" + u, j.calibration.backlash, {0, 5}, unit);
    v.unless_zero("pitch_" + u, j.calibration.pitch, {0, 1000}, unit);
    v.unless_zero("periodic_sine_" + u, j.calibration.periodic_sine, {-5, 5}, unit);
    v.unless_zero("periodic_cosine_" + u, j.calibration.periodic_cosine, {-5, 5}, unit);
    v.unless_zero("table_start_" + u, j.calibration.table_start, {-100000, 100000}, unit);
    v.unless_zero("table_step_" + u, j.calibration.table_step, {0, 10000}, unit);
    v.numbers("table_" + u, j.calibration.table, {-5, 5}, 1000, unit);
  });
}

template <class V>
void visit_node(V& v, NodeDescription& n) {
  v.integer("axis_pairs", n.functions.axis_pairs, 0, 1, Need::kOptional);
  v.integer("inputs", n.functions.inputs, 0, kNodeInputs, Need::kOptional);
  v.integer("heaters", n.functions.heaters, 0, 8, Need::kOptional);
  v.integer("sensors", n.functions.sensors, 0, 8, Need::kOptional);
  v.integer("outputs", n.functions.outputs, 0, 16, Need::kOptional);
  v.integer("filament_sensors", n.functions.filament_sensors, 0, 8, Need::kOptional);
  v.optional_integer("vendor", n.vendor);
  v.optional_integer("product", n.product);
  v.optional_integer("serial", n.serial);
  for (std::size_t i = 0; i < kNodeInputs; ++i)
    v.table_unless_default("input" + std::to_string(i + 1), n.inputs[i], [&](SwitchInput& s) {
      v.choice("function", s.function, kInputFunctions, Need::kRequired);
      v.choice("axis", s.axis, kAxes, Need::kOptional);
      v.flag("active_low", s.active_low, Need::kOptional);
      v.duration("debounce_us", s.debounce, 0, 100000, Need::kOptional);
    });
}

template <class V>
void visit_axis_vibration(V& v, AxisVibration& a) {
  v.choice("shaper", a.shaper, kShapers, Need::kOptional);
  v.unless_zero("frequency_hz", a.frequency_hz, {1, 500}, 1);
  v.number("damping_ratio", a.damping_ratio, {0, 0.5}, Need::kOptional);
}

template <class V>
void visit_vibration(V& v, VibrationDescription& d) {
  visit_axis_vibration(v, d.every);
  v.unless_zero("deviation_um", d.deviation_mm, {1, 10000}, 1e-3);
  v.unless_zero("override_from_percent", d.slowest_rate, {30, 100}, 0.01);
  v.optional_table("x", d.x, [&](AxisVibration& a) { visit_axis_vibration(v, a); });
  v.optional_table("y", d.y, [&](AxisVibration& a) { visit_axis_vibration(v, a); });
  v.optional_table("z", d.z, [&](AxisVibration& a) { visit_axis_vibration(v, a); });
}

template <class V>
void visit_pressure_advance(V& v, AdvanceModel& a) {
  v.choice("model", a.kind, kAdvanceKinds, Need::kOptional);
  v.number("advance_s", a.advance_s, {0, AdvanceModel::kMost_s}, Need::kOptional);
  v.unless_zero("nonlinear_mm", a.nonlinear_mm, {0.001, 5}, 1);
  v.number("nonlinear_mm_per_s", a.nonlinear_mm_per_s, {0.01, 100}, Need::kOptional);
  v.unless_zero("melt_ms", a.melt_s, {0.1, 1e3 * AdvanceModel::kMostMelt_s}, 1e-3);
  v.number("smooth_ms", a.smooth_s, {1e3 * AdvanceModel::kLeastSmooth_s, 1e3 * AdvanceModel::kMostSmooth_s},
           Need::kOptional, 1e-3);
}

template <class V>
void visit_path(V& v, MachineDescription& d) {
  v.table("path", Need::kRequired, [&] {
    v.number("tool_speed_mm_per_s", d.path.tool_speed_mm_per_s, {0.1, 10000}, Need::kRequired);
    v.number("tool_accel_mm_per_s2", d.path.tool_accel_mm_per_s2, {1, 1e6}, Need::kRequired);
    v.number("tool_jerk_mm_per_s3", d.path.tool_jerk_mm_per_s3, {0, 1e9}, Need::kOptional);
    struct Keys {
      const char *speed, *accel;
      double unit;
    };
    constexpr Keys kKeys[kPoseAxes] = {{"x_speed_mm_per_s", "x_accel_mm_per_s2", 1},
                                       {"y_speed_mm_per_s", "y_accel_mm_per_s2", 1},
                                       {"z_speed_mm_per_s", "z_accel_mm_per_s2", 1},
                                       {"a_speed_deg_per_s", "a_accel_deg_per_s2", kRadPerDeg},
                                       {"c_speed_deg_per_s", "c_accel_deg_per_s2", kRadPerDeg},
                                       {"e_speed_mm_per_s", "e_accel_mm_per_s2", 1}};
    for (std::size_t k = 0; k < kPoseAxes; ++k) {
      v.number(kKeys[k].speed, d.path.axis_speed_per_s[k], {0, 100000}, Need::kOptional, kKeys[k].unit);
      v.number(kKeys[k].accel, d.path.axis_accel_per_s2[k], {0, 1e6}, Need::kOptional, kKeys[k].unit);
    }
  });
  v.table_unless_default("vibration", d.vibration, [&](VibrationDescription& s) { visit_vibration(v, s); });
  v.table_unless_default("pressure_advance", d.pressure_advance,
                         [&](AdvanceModel& a) { visit_pressure_advance(v, a); });
  v.table("tolerance", Need::kOptional, [&] {
    v.number("blend_mm", d.tolerances.blend_mm, {0, 1}, Need::kOptional);
    v.number("merge_mm", d.tolerances.merge_mm, {0, 1}, Need::kOptional);
    v.number("segment_counts", d.tolerances.segment_counts, {0.05, 100}, Need::kOptional);
  });
  v.table("stop", Need::kOptional, [&] {
    v.duration("ramp_ms", d.stop.ramp, 2, 510, Need::kOptional);
    v.duration("hold_ramp_ms", d.stop.hold_ramp, 2, 510, Need::kOptional);
    v.choice("after_stall", d.stop.after_stall, kAfterStall, Need::kOptional);
  });
  v.table("resume", Need::kOptional, [&] {
    v.choice("after_restart", d.resume.after_restart, kResumeThen, Need::kOptional);
    v.choice("after_power_loss", d.resume.after_power_loss, kResumeThen, Need::kOptional);
    v.number("lift_mm", d.resume.lift_mm, {0, 200}, Need::kOptional);
    v.number("approach_mm_per_s", d.resume.approach_mm_per_s, {0.1, 1000}, Need::kOptional);
    v.number("prime_mm", d.resume.prime_mm, {0, 100}, Need::kOptional);
  });
  v.table_unless_default("pause", d.pause, [&](PauseDescription& p) {
    v.number("lift_mm", p.lift_mm, {0, 500}, Need::kOptional);
    v.flag("park", p.park, Need::kOptional);
    v.number("park_x_mm", p.park_x_mm, {-2000, 2000}, Need::kOptional);
    v.number("park_y_mm", p.park_y_mm, {-2000, 2000}, Need::kOptional);
    v.number("standby_c", p.standby_c, {0, 300}, Need::kOptional);
    v.duration("standby_after_s", p.standby_after, 10, 86'400, Need::kOptional);
    v.number("unload_mm", p.unload_mm, {0, 2000}, Need::kOptional);
    v.number("load_mm", p.load_mm, {0, 2000}, Need::kOptional);
    v.number("purge_mm", p.purge_mm, {0, 500}, Need::kOptional);
    v.number("unload_mm_per_s", p.unload_mm_per_s, {0.1, 200}, Need::kOptional);
    v.number("load_mm_per_s", p.load_mm_per_s, {0.1, 200}, Need::kOptional);
    v.number("purge_mm_per_s", p.purge_mm_per_s, {0.1, 50}, Need::kOptional);
  });
}

template <class V>
void visit_bus(V& v, BusDescription& b) {
  v.table("bus", Need::kOptional, [&] {
    v.text("interface", b.interface, Need::kOptional);
    v.removed("bitrate",
              phrase("this line taken out: every node speaks 1 Mbit/s, which is set on the interface "
                     "(ip link set can0 type can bitrate 1000000)"));
    v.number("budget", b.budget, {0.05, 0.95}, Need::kOptional);
    v.duration("sync_period_ms", b.sync_period, 5, 1000, Need::kOptional);
    v.duration("sync_timeout_ms", b.sync_timeout, 10, 10000, Need::kOptional);
    v.duration("heartbeat_period_ms", b.heartbeat_period, 10, 10000, Need::kOptional);
    v.duration("heartbeat_timeout_ms", b.heartbeat_timeout, 20, 60000, Need::kOptional);
    v.choice("trust", b.trust, kBusTrust, Need::kOptional);
  });
}

template <class V>
void visit_gcode(V& v, GcodeDescription& g) {
  v.table("gcode", Need::kOptional, [&] {
    v.number("initial_feed_mm_per_min", g.initial_feed_mm_per_min, {1, 100000}, Need::kOptional);
    v.unless_zero("traverse_mm_per_s", g.traverse_mm_per_s, {0.1, 10000}, 1);
    v.number("filament_diameter_mm", g.filament_diameter_mm, {0.1, 10}, Need::kOptional);
    v.number("arc_radius_tolerance_mm", g.arc_radius_tolerance_mm, {0, 1}, Need::kOptional);
    v.number("retract_mm", g.retract_mm, {0, 100}, Need::kOptional);
    v.number("retract_mm_per_s", g.retract_mm_per_s, {0.1, 1000}, Need::kOptional);
    v.number("retract_lift_mm", g.retract_lift_mm, {0, 50}, Need::kOptional);
    v.choice("dialect", g.dialect, dialect_choices(), Need::kOptional);
    v.choice("dwell_p_unit", g.dwell_p_unit, kDwellUnits, Need::kOptional);
    v.numbers("tool_length_mm", g.tool_length_mm, {-1000, 1000}, 99, 1);
    v.numbers("tool_diameter_mm", g.tool_diameter_mm, {0, 500}, 99, 1);
    v.numbers("tool_orientation", g.tool_orientation, {0, 9}, 99, 1);
    v.flag("optional_stop", g.optional_stop, Need::kOptional);
    v.flag("block_delete", g.block_delete, Need::kOptional);
  });
}

template <class V>
void visit_serial(V& v, SerialDescription& s) {
  // A second holds the reserve in which a planned stop reaches the nodes, and braking from any speed.
  v.table("serial", Need::kOptional, [&] { v.number("lead_s", s.lead_s, {1, 600}, Need::kOptional); });
}

template <class V>
void visit_correction(V& v, std::optional<M1Correction>& correction) {
  v.optional_table("calibration", correction, [&](M1Correction& c) {
    for (std::size_t i = 0; i < c.legs.size(); ++i)
      v.table_unless_default("leg" + std::to_string(i + 1), c.legs[i], [&](M1LegCorrection& leg) {
        v.vector3("foot_mm", leg.foot_mm, {-50, 50}, Need::kOptional);
        v.vector3("rail", leg.rail, {-0.2, 0.2}, Need::kOptional);
        v.vector3("attachment_mm", leg.attachment_mm, {-50, 50}, Need::kOptional);
        v.number("length_mm", leg.length_mm, {-50, 50}, Need::kOptional);
      });
  });
}

template <class V>
void visit_machine(V& v, MachineDescription& d) {
  v.text("name", d.name, Need::kRequired);
  v.text("jobs_directory", d.jobs_directory, Need::kOptional);
  bool known_kind = false;
  v.table("kinematics", Need::kRequired, [&] {
    auto kind = static_cast<int>(d.kinematics.index());
    known_kind = v.choice("type", kind, kKinds, Need::kRequired);
    if (!known_kind) return v.leave_unjudged();
    prepare_kinematics(d, kind);
    std::visit([&](auto& geometry) { visit_geometry(v, geometry); }, d.kinematics);
    prepare_joints(d);
  });
  visit_path(v, d);
  visit_bus(v, d.bus);
  v.table("homing", Need::kOptional, [&] {
    v.number("max_spread_mm", d.homing.max_spread_mm, {0.01, 1000}, Need::kOptional);
    v.number("spared_part_mm", d.homing.spared_part_mm, {0, 10000}, Need::kOptional);
    v.duration("timeout_s", d.homing.timeout, 1, 3600, Need::kOptional);
  });
  v.table("joint", Need::kRequired, [&] {
    if (!known_kind) return v.leave_unjudged();
    for (std::size_t i = 0; i < d.joints.size(); ++i)
      v.table(d.joints[i].name, Need::kRequired, [&] { visit_joint(v, d.joints[i], has_own_travel(d, i)); });
  });
  v.table("node", Need::kRequired, [&] {
    v.node_ids(d.nodes);
    for (NodeDescription& n : d.nodes)
      v.table(std::to_string(n.id), Need::kRequired, [&] { visit_node(v, n); });
  });
  visit_devices(v, d);
  visit_gcode(v, d.gcode);
  v.named_tables("macro", d.macros, [&](MacroDescription& m) { v.program("gcode", m.gcode); });
  v.optional_table("bodies", d.bodies, [&](BodiesDescription& b) {
    if (!known_kind) return v.leave_unjudged();
    visit_bodies(v, b, body_keys(d.kinematics));
  });
  visit_serial(v, d.serial);
  if (!known_kind || d.kinematics.index() == 0 || d.kinematics.index() == 5)
    visit_correction(v, d.geometry_calibration);
}

}  // namespace kinebus::machine_schema
