#pragma once
// The path of M4's table 4 in the paper's own terms, and the shipped machine driving it.

#include <optional>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/kinematics/m4.hpp"

namespace kinebus::papers {

inline constexpr double kM4PathEnd_s = 3;

/// How the mechanism is put together: blocks above (+1) or below (-1) the tool, the triangle turned against
/// the tool, rad.
struct M4Build {
  double side1 = 1, side2 = 1, turned_rad = 0;
};

/// The triangle along the paper's path, 0 <= t <= kM4PathEnd_s.
PlanarPose m4_path_at(double t_s, const M4Build& build = {});

/// The paper's closures: blocks for a pose, mm. nullopt: a rod is too short.
std::optional<Vector3> m4_blocks(const M4Geometry& geometry, const PlanarPose& pose, const M4Build& build);

/// The path as G-code for a machine of this geometry, at the paper's speed (G93).
std::string m4_path_job(const M4Geometry& geometry);

struct BlocksAt {
  double t_s = 0;  ///< since the path's beginning, on the machine's clock
  Vector3 y_mm{};
};
struct M4Drive {
  std::string refusal;  ///< pre-flight of the paper's own assembly, for the first line where it is singular
  std::string outcome;
  double duration_s = 0;
  double off_um =
      0;  ///< blocks from the closures, at the nearest time of the path; infinite: it did not end there
  double speed_ratio = 0;  ///< the largest of all joints
  std::vector<BlocksAt> blocks_driven;
};

/// Pre-flight, then the whole simulated machine: planner, bus, nodes, motors.
M4Drive drive_m4_path(const MachineDescription& machine);

/// Blocks over time, the paper's assembly above, as driven below.
std::string draw_figure10(const M4Geometry& geometry, const std::vector<double>& crossings_s,
                          const M4Build& other, const std::vector<BlocksAt>& driven);

}  // namespace kinebus::papers
