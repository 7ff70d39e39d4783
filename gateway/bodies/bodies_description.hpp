#pragma once
// What of a machine is solid, beyond what its kinematics says: thicknesses and lengths, mm. Which of them a
// kind of machine has: gateway/description/bodies_schema.hpp.

#include <string>
#include <vector>

#include "gateway/kinematics/geometry.hpp"

namespace kinebus {

/// Something that stands in the way and does not move, as the machine's frame does: a box along the machine's
/// axes, or a rod with round ends from one point to another.
struct FixedBody {
  std::string name;  ///< of its table
  Vector3 from_mm{}, to_mm{};
  double radius_mm = 0;  ///< of a rod; 0: a box
  friend bool operator==(const FixedBody&, const FixedBody&) = default;
};

struct BodiesDescription {
  /// How near two bodies may come. Poses are checked so densely that what keeps it never touches in between.
  double clearance_mm = 2;
  double rod_radius_mm = 5;
  double rod_spacing_mm = 40;  ///< between the two rods of a leg; M4's legs are single rods
  double carriage_length_mm = 60, carriage_width_mm = 50;  ///< along the rail, and across
  double rail_radius_mm = 10;
  double rail_offset_mm = 0;  ///< from the legs' joints outwards to the rail's middle; 0: room for the rods
  double platform_radius_mm = 10;  ///< of the platform's arms to the legs
  double table_radius_mm = 0;      ///< 0: the workspace's
  double table_thickness_mm = 8;
  double tool_radius_mm = 4, tool_length_mm = 40;  ///< the nozzle, or the mill's tool
  double holder_radius_mm = 25, holder_length_mm = 60;
  double floor_mm = 50;  ///< below the lowest end of a rail, or below the table
  /// The greatest thing that stands on the table, around its axis; 0: the table is empty.
  double part_radius_mm = 0, part_height_mm = 0;
  bool printed_part = true;      ///< what a job prints becomes a body that all others keep out of
  std::vector<FixedBody> fixed;  ///< in the order of their names
  friend bool operator==(const BodiesDescription&, const BodiesDescription&) = default;
};

}  // namespace kinebus
