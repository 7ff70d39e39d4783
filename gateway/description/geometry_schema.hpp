#pragma once
// The keys of [kinematics] in a machine file. Each kind of machine has its own.

#include <string>

#include "gateway/description/machine_description.hpp"
#include "gateway/description/schema_words.hpp"

namespace kinebus::machine_schema {

inline constexpr Range kAnywhere_mm{-10000, 10000};
inline constexpr Range kAngle_deg{-360, 360};
inline constexpr Range kAngleLimit_deg{0, 90};

inline constexpr Choice kToolPlacements[] = {{"frame", static_cast<int>(ToolPlacement::kFrame)},
                                             {"platform", static_cast<int>(ToolPlacement::kPlatform)}};
inline constexpr Choice kCarriage[] = {{"below", 0}, {"above", 1}};

template <class V>
void visit_workspace(V& v, PoseLimits& limits, bool tilts) {
  v.table("workspace", Need::kRequired, [&] {
    v.interval("x_mm", limits.x_mm, kAnywhere_mm, Need::kOptional);
    v.interval("y_mm", limits.y_mm, kAnywhere_mm, Need::kOptional);
    v.interval("z_mm", limits.z_mm, kAnywhere_mm, Need::kRequired);
    v.number("radius_mm", limits.radius_mm, {0, 10000}, Need::kOptional);
    if (tilts) v.interval("a_deg", limits.a_rad, {-90, 90}, Need::kRequired, kRadPerDeg);
  });
}

template <class V>
void visit_geometry(V& v, M1Geometry& g) {
  const bool known = v.choice("tool", g.tool, kToolPlacements, Need::kOptional);
  v.vector3("nozzle_mm", g.nozzle_mm, kAnywhere_mm, Need::kRequired);
  if (!known || g.tool == ToolPlacement::kPlatform)
    v.vector3("table_mm", g.table_mm, kAnywhere_mm, known ? Need::kRequired : Need::kOptional);
  else
    v.retired("table_mm",
              say("no such key with the tool in the frame: the table's centre is the platform's zero"));
  v.number("bed_reference_mm", g.bed_reference_mm, kAnywhere_mm, Need::kOptional);
  v.number("max_leg_angle_deg", g.max_leg_angle_rad, {1, 90}, Need::kRequired, kRadPerDeg);
  v.number("min_rail_clearance_deg", g.min_rail_clearance_rad, kAngleLimit_deg, Need::kOptional, kRadPerDeg);
  v.number("min_platform_clearance_deg", g.min_platform_clearance_rad, kAngleLimit_deg, Need::kOptional,
           kRadPerDeg);
  v.number("max_condition", g.max_condition, {1, 1000}, Need::kOptional);
  v.number("rotation_scale_mm", g.rotation_scale_mm, {1, 10000}, Need::kOptional);
  for (std::size_t i = 0; i < g.legs.size(); ++i)
    v.table("leg" + std::to_string(i + 1), Need::kRequired, [&] {
      M1Leg& leg = g.legs[i];
      v.vector3("foot_mm", leg.foot_mm, kAnywhere_mm, Need::kRequired);
      v.vector3("rail", leg.rail, {-10, 10}, Need::kOptional);
      v.vector3("attachment_mm", leg.attachment_mm, kAnywhere_mm, Need::kRequired);
      v.number("length_mm", leg.length_mm, {1, 10000}, Need::kRequired);
      v.number("connector_mm", leg.connector_mm, {-1000, 1000}, Need::kOptional);
      v.choice("carriage", leg.carriage_above, kCarriage, Need::kOptional);
    });
  visit_workspace(v, g.limits, true);
}

template <class V>
void visit_geometry(V& v, CartesianGeometry& g) {
  v.number("bed_reference_mm", g.bed_reference_mm, kAnywhere_mm, Need::kOptional);
  v.present("rotary_table", g.has_table,
            [&] { v.vector3("pivot_mm", g.table.pivot_mm, kAnywhere_mm, Need::kRequired); });
}

template <class V>
void visit_geometry(V& v, CoreXyGeometry& g) {
  v.interval("x_mm", g.x_mm, kAnywhere_mm, Need::kRequired);
  v.interval("y_mm", g.y_mm, kAnywhere_mm, Need::kRequired);
  v.number("bed_reference_mm", g.bed_reference_mm, kAnywhere_mm, Need::kOptional);
}

template <class V>
void visit_geometry(V& v, LinearDeltaGeometry& g) {
  v.number("radius_mm", g.radius_mm, {1, 10000}, Need::kRequired);
  v.number("arm_length_mm", g.arm_length_mm, {1, 10000}, Need::kRequired);
  v.vector3("tower_angles_deg", g.tower_angle_rad, kAngle_deg, Need::kOptional, kRadPerDeg);
  v.number("max_arm_angle_deg", g.max_arm_angle_rad, {1, 90}, Need::kRequired, kRadPerDeg);
  v.number("bed_reference_mm", g.bed_reference_mm, kAnywhere_mm, Need::kOptional);
  visit_workspace(v, g.limits, false);
}

template <class V>
void visit_geometry(V& v, M4Geometry& g) {
  v.number("rod_mm", g.rod_mm, {1, 10000}, Need::kRequired);
  v.number("triangle_mm", g.triangle_mm, {1, 10000}, Need::kRequired);
  v.number("rails_mm", g.rails_mm, {1, 10000}, Need::kRequired);
  v.number("spindle_deg", g.spindle_rad, kAngle_deg, Need::kRequired, kRadPerDeg);
  v.number("tool_mm", g.tool_mm, {0, 1000}, Need::kRequired);
  v.number("table_y_mm", g.table_y_mm, kAnywhere_mm, Need::kOptional);
  v.number("table_z_mm", g.table_z_mm, kAnywhere_mm, Need::kRequired);
  v.number("bed_reference_mm", g.bed_reference_mm, kAnywhere_mm, Need::kOptional);
  v.number("max_leg_angle_deg", g.max_leg_angle_rad, {1, 90}, Need::kRequired, kRadPerDeg);
  v.number("max_condition", g.max_condition, {1, 1000}, Need::kOptional);
  v.number("rotation_scale_mm", g.rotation_scale_mm, {1, 10000}, Need::kOptional);
  visit_workspace(v, g.limits, true);
}

}  // namespace kinebus::machine_schema
