#pragma once
// The set of tool positions that a machine can take, by tilt: scanned plane by plane, in each plane along
// rays.

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/kinematics/geometry.hpp"

namespace kinebus::workspace {

struct ScanOptions {
  double step_mm = 2;      ///< between planes, and along a ray
  double ray_step_mm = 2;  ///< between rays at the largest radius
  double tilt_step_rad = 2 * kRadPerDeg;
  int threads = 2;
  double dexterous_condition = 8;  ///< tilts with a condition number up to this count for the dexterity map
};

/// What a scan covers: a cylinder around the table's centre.
struct Room {
  double radius_mm = 150, z_min_mm = 0, z_max_mm = 250;
  double tilt_min_rad = 0, tilt_max_rad = 0;
};

/// Two bodies that came nearer than they may.
struct Meeting {
  bodies::Clearance worst;  ///< smallest clearance of these two
  Pose pose{};              ///< and where
  std::uint64_t poses = 0;  ///< refused because these two are the nearest
};

/// Cells in cylindrical order: plane (z), ray (angle), place on the ray (radius). Of every cell the tilts
/// that are allowed: reach, travel, leg angle, both clearances, conditioning, and bodies.
struct Scan {
  Room room;
  ScanOptions options;
  int planes = 0, rays = 0, radii = 0, tilts = 0;
  std::vector<std::uint64_t> allowed;  ///< bit t: tilt t is allowed
  /// Over the allowed tilts, looked at in every fourth plane, ray and radius; 0: none allowed. (That no pose
  /// is beyond the machine's own limit is checked at every pose.)
  std::vector<float> worst_condition;
  std::array<std::uint64_t, 8> refused{};  ///< poses by PoseError::Kind
  std::vector<Meeting> meetings;           ///< poses that all rules but bodies allow; most poses first
  std::uint64_t poses = 0;
  double seconds = 0;      ///< of the clock on the wall
  double cpu_seconds = 0;  ///< of all threads

  std::size_t cell(int plane, int ray, int radius) const {
    return (static_cast<std::size_t>(plane) * static_cast<std::size_t>(rays) +
            static_cast<std::size_t>(ray)) *
               static_cast<std::size_t>(radii) +
           static_cast<std::size_t>(radius);
  }
  double z_mm(int plane) const { return room.z_min_mm + (plane + 0.5) * options.step_mm; }
  double angle_rad(int ray) const;
  double radius_mm(int radius) const { return (radius + 0.5) * options.step_mm; }
  double tilt_rad(int tilt) const;
  /// Towards the axis rays come nearer than they need: so many neighbours share the answer of their first.
  int stride(int radius) const;
  bool is_allowed(std::size_t cell, int tilt) const { return (allowed[cell] >> tilt & 1) != 0; }
  /// Volume of a cell at this place on the ray, mm^3.
  double cell_volume_mm3(int radius) const;
};

/// At most 64 tilts: the tilt step is widened if it must be. Positions are those of the tool at C = 0.
/// `model`: bodies that must keep their clearance; nullptr: none. `progress`: share done so far, now and
/// then, from a thread of the scan.
Scan scan(const Kinematics& kinematics, const Room& room, const ScanOptions& options,
          const bodies::CollisionModel* model = nullptr,
          const std::function<void(double share)>& progress = {});

/// Reachable at this tilt, mm^3; tilt < 0: at every tilt of the scan.
double volume_mm3(const Scan& scan, int tilt);

/// Largest upright cylinder around the table's axis (the table turns) in which every cell is allowed at this
/// tilt; tilt < 0: at every tilt. By volume.
struct Cylinder {
  double radius_mm = 0, z_min_mm = 0, z_max_mm = 0;
  double volume_mm3() const;
};
Cylinder largest_cylinder(const Scan& scan, int tilt);
/// The largest that stands on the table, at every tilt: from z = 0, or the lowest plane above, and no wider
/// than the table.
Cylinder standing_cylinder(const Scan& scan, double table_radius_mm);

}  // namespace kinebus::workspace
