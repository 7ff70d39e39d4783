#pragma once
// The keys of [bodies] in a machine file. Each kind of machine has those of its own bodies.

#include "gateway/bodies/bodies_description.hpp"
#include "gateway/description/schema_words.hpp"

namespace kinebus::machine_schema {

/// What a kind of machine has.
struct BodyKeys {
  bool legs = false;      ///< rods, carriages, rails
  bool pairs = false;     ///< a leg is two rods
  bool platform = false;  ///< that the legs carry
};

template <class V>
void visit_bodies(V& v, BodiesDescription& b, BodyKeys has) {
  constexpr Range kSize{0.1, 10000}, kSizeOrNone{0, 10000}, kPlace{-10000, 10000};
  // Not 0: between two poses that are checked, bodies move.
  v.number("clearance_mm", b.clearance_mm, {0.1, 100}, Need::kOptional);
  if (has.legs) {
    v.number("rod_radius_mm", b.rod_radius_mm, kSize, Need::kOptional);
    if (has.pairs) v.number("rod_spacing_mm", b.rod_spacing_mm, kSize, Need::kOptional);
    v.number("carriage_length_mm", b.carriage_length_mm, kSize, Need::kOptional);
    v.number("carriage_width_mm", b.carriage_width_mm, kSize, Need::kOptional);
    v.number("rail_radius_mm", b.rail_radius_mm, kSize, Need::kOptional);
    v.unless_zero("rail_offset_mm", b.rail_offset_mm, kSizeOrNone, 1);
  }
  if (has.platform) v.number("platform_radius_mm", b.platform_radius_mm, kSize, Need::kOptional);
  v.unless_zero("table_radius_mm", b.table_radius_mm, kSizeOrNone, 1);
  v.number("table_thickness_mm", b.table_thickness_mm, kSize, Need::kOptional);
  v.number("tool_radius_mm", b.tool_radius_mm, kSize, Need::kOptional);
  v.number("tool_length_mm", b.tool_length_mm, kSize, Need::kOptional);
  v.number("holder_radius_mm", b.holder_radius_mm, kSize, Need::kOptional);
  v.number("holder_length_mm", b.holder_length_mm, kSize, Need::kOptional);
  v.number("floor_mm", b.floor_mm, kSizeOrNone, Need::kOptional);
  v.unless_zero("part_radius_mm", b.part_radius_mm, kSizeOrNone, 1);
  v.unless_zero("part_height_mm", b.part_height_mm, kSizeOrNone, 1);
  v.flag("printed_part", b.printed_part, Need::kOptional);
  v.named_tables("fixed", b.fixed, [&](FixedBody& body) {
    v.vector3("from_mm", body.from_mm, kPlace, Need::kRequired);
    v.vector3("to_mm", body.to_mm, kPlace, Need::kRequired);
    v.unless_zero("radius_mm", body.radius_mm, kSizeOrNone, 1);
  });
}

}  // namespace kinebus::machine_schema
