#pragma once
// The keys of devices in a machine file: what there is, and where it lives. A table is one device; no table,
// no device.

#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/description/schema_words.hpp"
#include "gateway/kinematics/bed_mesh.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::machine_schema {

inline constexpr Choice kWheres[] = {{"simulated", static_cast<int>(DevicePlace::Where::kSimulated)},
                                     {"node", static_cast<int>(DevicePlace::Where::kNode)}};
inline constexpr Choice kHeaterKinds[] = {{"hotend", static_cast<int>(HeaterKind::kHotend)},
                                          {"bed", static_cast<int>(HeaterKind::kBed)},
                                          {"chamber", static_cast<int>(HeaterKind::kChamber)}};

inline constexpr Choice kAfters[] = {{"keep", static_cast<int>(ThermalDescription::After::kKeep)},
                                     {"off", static_cast<int>(ThermalDescription::After::kOff)}};

/// Stated in every device's table: a heater that only seems to be there must be no oversight.
template <class V>
void visit_place(V& v, DevicePlace& place) {
  if (!v.choice("where", place.where, kWheres, Need::kRequired)) return v.leave_unjudged();
  if (!place.on_node()) return;
  v.integer("node", place.node_id, 1, 126, Need::kRequired);
  v.integer("channel", place.channel, 1, 16, Need::kRequired);
}

inline constexpr Choice kSensorElements[] = {
    {"pt100", static_cast<int>(SensorElement::kPt100)},
    {"pt1000", static_cast<int>(SensorElement::kPt1000)},
    {"epcos_100k", static_cast<int>(SensorElement::kEpcos100k)},
    {"semitec_104gt2", static_cast<int>(SensorElement::kSemitec104Gt2)},
    {"semitec_104nt4", static_cast<int>(SensorElement::kSemitec104Nt4)},
    {"generic_3950", static_cast<int>(SensorElement::kGeneric3950)},
    {"slice_450", static_cast<int>(SensorElement::kSlice450)},
    {"ntc100k_mgb18", static_cast<int>(SensorElement::kNtc100kMgb18)},
    {"honeywell_100k", static_cast<int>(SensorElement::kHoneywell100k)},
    {"tdk_ntcg104", static_cast<int>(SensorElement::kTdkNtcg104)},
    {"beta", static_cast<int>(SensorElement::kBeta)},
    {"points", static_cast<int>(SensorElement::kPoints)}};

template <class V>
void visit_sensor(V& v, SensorWiring& s) {
  // The wrong sensor is the wrong temperature: stated, always.
  if (!v.choice("sensor", s.element, kSensorElements, Need::kRequired)) return;
  v.flag("sensor_max31865", s.max31865, Need::kOptional);
  // A pull-up is usually 4700 Ohm; what the converter has, 430 or 4300, is on its board.
  v.number("sensor_reference_ohm", s.reference_ohm, {10, 2e6},
           s.max31865 ? Need::kRequired : Need::kOptional);
  if (s.max31865) v.integer("sensor_wires", s.wires, 2, 4, Need::kOptional);
  if (s.element != SensorElement::kBeta && s.element != SensorElement::kPoints) return;
  v.unless_zero("sensor_highest_c", s.highest_given_c, {30, 600}, 1);
  if (s.element == SensorElement::kPoints) {
    v.vector3("sensor_points_c", s.points_c, {-50, 600}, Need::kRequired);
    v.vector3("sensor_points_ohm", s.points_ohm, {0.001, 2e6}, Need::kRequired);
    return;
  }
  v.number("sensor_25c_ohm", s.nominal_ohm, {1, 2e6}, Need::kOptional);
  v.integer("sensor_beta_k", s.beta_k, 1000, 10'000, Need::kOptional);
}

template <class V>
void visit_wiring(V& v, HeaterWiring& w) {
  visit_sensor(v, w.sensor);
  v.unless_zero("limit_c", w.limit_c, {30, 550}, 1);
  v.number("power_w", w.power_w, {0.1, 5000}, Need::kOptional);
  v.number("filament_j_per_mm3_k", w.filament_j_per_mm3_k, {0, 0.02}, Need::kOptional);
  v.number("supply_v", w.supply_v, {0, 60}, Need::kOptional);
  v.flag("relay", w.relay, Need::kOptional);
  v.duration("rise_s", w.rise, 5, 300, Need::kOptional);
  v.number("safe_c", w.safe_c, {0, 530}, Need::kOptional);
  v.duration("safe_time_s", w.safe_time, 0, 7200, Need::kOptional);
  v.integer("fan_channel", w.fan_channel, 0, kHeatNodeOutputs, Need::kOptional);
  v.integer("fan_pulses_per_turn", w.fan_pulses, 0, 20, Need::kOptional);
}

template <class V>
void visit_device(V& v, HeaterDescription& h) {
  v.choice("kind", h.kind, kHeaterKinds, Need::kRequired);
  v.integer("index", h.index, 0, kMostOfAKind - 1, Need::kOptional);
  v.retired("present", say("no such key: a heater that is not there has no table"));
  v.number("max_c", h.max_c, {20, 600}, Need::kOptional);
  v.number("window_c", h.window_c, {0.1, 50}, Need::kOptional);
  v.duration("settle_s", h.settle, 0, 600, Need::kOptional);
  v.number("sim_power_w", h.sim_power_w, {0.1, 10000}, Need::kOptional);
  v.number("sim_heat_capacity_j_per_k", h.sim_heat_capacity_j_per_k, {0.1, 100000}, Need::kOptional);
  v.number("sim_loss_w_per_k", h.sim_loss_w_per_k, {0.0001, 1000}, Need::kOptional);
  visit_place(v, h.place);
  if (h.place.on_node()) visit_wiring(v, h.wiring);
}

template <class V>
void visit_device(V& v, FanDescription& f) {
  v.integer("index", f.index, 0, kMostOfAKind - 1, Need::kOptional);
  visit_place(v, f.place);
  if (!f.place.on_node()) return;
  v.duration("kick_ms", f.kick, 0, 5000, Need::kOptional);
  v.integer("least_percent", f.least_percent, 0, 100, Need::kOptional);
}

template <class V>
void visit_device(V& v, OutputDescription& o) {
  v.integer("index", o.index, 0, kMostOfAKind - 1, Need::kOptional);
  visit_place(v, o.place);
}

template <class V>
void visit_device(V& v, InputDescription& i) {
  v.integer("index", i.index, 0, kMostOfAKind - 1, Need::kOptional);
  v.flag("sim_on", i.sim_on, Need::kOptional);
  v.unless_zero("sim_change_s", i.sim_change_s, {0.01, 3600}, 1);
  visit_place(v, i.place);
}

template <class V>
void visit_device(V& v, SensorDescription& s) {
  v.number("sim_c", s.sim_c, {-50, 600}, Need::kOptional);
  visit_place(v, s.place);
  if (s.place.on_node()) visit_sensor(v, s.wiring);
}

inline constexpr Choice kFilamentSensorKinds[] = {{"switch", static_cast<int>(FilamentSensorKind::kSwitch)},
                                                  {"motion", static_cast<int>(FilamentSensorKind::kMotion)}};

template <class V>
void visit_device(V& v, FilamentSensorDescription& f) {
  const bool known = v.choice("kind", f.kind, kFilamentSensorKinds, Need::kRequired);
  visit_place(v, f.place);
  if (!known) return v.leave_unjudged();
  v.unless_zero("sim_length_mm", f.sim_length_mm, {1, 1e6}, 1);
  if (f.kind == FilamentSensorKind::kSwitch) return v.flag("inverted", f.inverted, Need::kOptional);
  v.number("mm_per_edge", f.mm_per_edge, {0.01, 20}, Need::kOptional);
  v.number("stands_mm", f.stands_mm, {0.5, 200}, Need::kOptional);
  v.number("slips_mm", f.slips_mm, {2, 1000}, Need::kOptional);
  v.number("least_share", f.least_share, {0.1, 0.95}, Need::kOptional);
}

inline constexpr Choice kAccelerometerAxes[] = {{"xyz", 0}, {"xzy", 1}, {"yxz", 2},
                                                {"yzx", 3}, {"zxy", 4}, {"zyx", 5}};

template <class V>
void visit_devices(V& v, MachineDescription& d) {
  v.table("thermal", Need::kOptional, [&] {
    v.number("ambient_c", d.thermal.ambient_c, {-20, 60}, Need::kOptional);
    v.number("min_extrude_c", d.thermal.min_extrude_c, {0, 500}, Need::kOptional);
    v.integer("mains_hz", d.thermal.mains_hz, 50, 60, Need::kOptional);
    v.duration("gateway_lost_ms", d.thermal.gateway_lost, 500, 60'000, Need::kOptional);
    v.choice("on_stop", d.thermal.on_stop, kAfters, Need::kOptional);
    v.choice("on_cancel", d.thermal.on_cancel, kAfters, Need::kOptional);
    v.duration("idle_off_s", d.thermal.idle_off, 60, 86'400, Need::kOptional);
    v.number("lift_mm", d.thermal.lift_mm, {0, 100}, Need::kOptional);
    v.retired("hotend",
              say("[heater.hotend] with kind = \"hotend\", where = \"simulated\" and the same keys; "
                  "a machine without hot end has no such table"));
    v.retired("bed",
              say("[heater.bed] with kind = \"bed\", where = \"simulated\" and the same keys; a machine "
                  "without heated bed has no such table"));
  });
  v.named_tables("heater", d.heaters, [&](HeaterDescription& h) { visit_device(v, h); });
  v.named_tables("material", d.materials, [&](MaterialDescription& m) {
    v.number("hotend_c", m.hotend_c, {0, 600}, Need::kOptional);
    v.number("bed_c", m.bed_c, {0, 600}, Need::kOptional);
    v.number("chamber_c", m.chamber_c, {0, 600}, Need::kOptional);
  });
  v.named_tables("camera", d.cameras, [&](CameraDescription& c) {
    v.text("stream", c.stream, Need::kRequired);
    v.text("snapshot", c.snapshot, Need::kOptional);
  });
  v.named_tables("fan", d.fans, [&](FanDescription& f) { visit_device(v, f); });
  v.named_tables("output", d.outputs, [&](OutputDescription& o) { visit_device(v, o); });
  v.named_tables("input", d.inputs, [&](InputDescription& i) { visit_device(v, i); });
  v.named_tables("sensor", d.sensors, [&](SensorDescription& s) { visit_device(v, s); });
  v.named_tables("filament_sensor", d.filament_sensors,
                 [&](FilamentSensorDescription& f) { visit_device(v, f); });
  v.present("spindle", d.spindle.present, [&] {
    v.retired("present", say("no such key: a machine without spindle has no table [spindle]"));
    v.number("min_rpm", d.spindle.min_rpm, {0, 100000}, Need::kOptional);
    v.number("max_rpm", d.spindle.max_rpm, {1, 200000}, Need::kOptional);
    v.flag("reversible", d.spindle.reversible, Need::kOptional);
    v.integer("encoder_counts", d.spindle.encoder_counts, 0, 1'000'000, Need::kOptional);
    v.number("tap_rpm_per_s", d.spindle.tap_rpm_per_s, {0, 1000000}, Need::kOptional);
    v.number("sim_rpm_per_s", d.spindle.sim_rpm_per_s, {10, 1000000}, Need::kOptional);
    v.number("sim_droop_percent", d.spindle.sim_droop_percent, {0, 50}, Need::kOptional);
    v.number("sim_load_s", d.spindle.sim_load_s, {0, 3600}, Need::kOptional);
    visit_place(v, d.spindle.place);
  });
  v.present("probe", d.probe.present, [&] {
    v.number("speed_mm_per_s", d.probe.speed_mm_per_s, {0.01, 50}, Need::kOptional);
    v.vector3("offset_mm", d.probe.offset_mm, {-500, 500}, Need::kOptional);
    v.number("sim_z_mm", d.probe.sim_z_mm, {-1000, 1000}, Need::kOptional);
    v.number("sim_slope_x", d.probe.sim_slope[0], {-0.2, 0.2}, Need::kOptional);
    v.number("sim_slope_y", d.probe.sim_slope[1], {-0.2, 0.2}, Need::kOptional);
    v.number("sim_bend_per_m", d.probe.sim_bend_per_m, {-2, 2}, Need::kOptional);
    visit_place(v, d.probe.place);
  });
  v.present("bltouch", d.probe.bltouch,
            [&] { v.integer("node", d.probe.servo_node, 1, 126, Need::kRequired); });
  v.present("accelerometer", d.accelerometer.present, [&] {
    v.integer("node", d.accelerometer.node, 1, 126, Need::kRequired);
    v.choice("axes", d.accelerometer.axes, kAccelerometerAxes, Need::kOptional);
  });
  v.table("mesh", Need::kOptional, [&] {
    v.integer("points_x", d.mesh.points_x, 2, MeshGrid::kMostPoints, Need::kOptional);
    v.integer("points_y", d.mesh.points_y, 2, MeshGrid::kMostPoints, Need::kOptional);
    v.interval("x_mm", d.mesh.x_mm, {-5000, 5000}, Need::kOptional);
    v.interval("y_mm", d.mesh.y_mm, {-5000, 5000}, Need::kOptional);
    v.number("lift_mm", d.mesh.lift_mm, {0.1, 100}, Need::kOptional);
    v.number("depth_mm", d.mesh.depth_mm, {0.01, 50}, Need::kOptional);
    v.number("fade_mm", d.mesh.fade_mm, {0, 1000}, Need::kOptional);
    v.number("limit_mm", d.mesh.limit_mm, {0.01, 50}, Need::kOptional);
  });
}

}  // namespace kinebus::machine_schema
