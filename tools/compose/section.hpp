#pragma once
// One connected part of a plane's section through a closed mesh, and the smallest section through a point.

#include <optional>
#include <vector>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

struct Section {
  double area_mm2 = 0;     ///< holes taken out
  Vector centre{0, 0, 0};  ///< of that area
  double extent_mm = 0;    ///< twice the way from the centre to its farthest corner
  int parts = 0;           ///< into how many the plane cuts the whole mesh: 1 when this is all of it
};

/// Sections of one mesh. Keeps a reference to it; not for several threads at once.
class Sections {
 public:
  explicit Sections(const TriangleMesh& mesh);

  /// The part of the section of `plane` that `inside`, a point of the plane, lies in. nullopt: in none.
  std::optional<Section> at(const Plane& plane, const Vector& inside) const;

  struct Smallest {
    Vector normal{0, 0, 1};
    Section section;
  };
  /// The smallest section through a point: its normal is the axis of whatever arm the point lies in. Searched
  /// over all directions, to 0.1 deg.
  std::optional<Smallest> smallest(const Vector& inside) const;
  /// The same, from a direction that is known about; it turns away from it by `within_rad` at most.
  std::optional<Smallest> smallest_near(const Vector& inside, const Vector& normal, double within_rad) const;

 private:
  struct Corner {
    double x = 0, y = 0;
  };
  struct Loop {
    std::size_t first = 0, count = 0;  ///< of loop_points_
    double area = 0, moment_x = 0, moment_y = 0;
  };
  void collect(const Plane& plane, const Vector& across, const Vector& along, const Vector& middle) const;
  bool holds(const Loop& loop, const Corner& p) const;

  const TriangleMesh& mesh_;
  std::vector<std::array<std::uint32_t, 3>> face_edges_;  ///< edge k goes from corner k to the next
  std::vector<std::array<std::uint32_t, 2>> edges_;       ///< its two points
  // Scratch of one section.
  mutable std::vector<double> over_;
  mutable std::vector<std::int64_t> next_;  ///< of an edge on the section: the one after it on its loop; -1
  mutable std::vector<std::uint32_t> crossed_;
  mutable std::vector<Corner> loop_points_;
  mutable std::vector<Loop> loops_;
};

}  // namespace kinebus::compose
