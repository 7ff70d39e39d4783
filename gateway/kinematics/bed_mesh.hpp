#pragma once
// The shape of a bed as it was probed: heights over a grid in table coordinates, between them a bicubic
// spline with continuous second derivatives, so that no joint's acceleration jumps where the path crosses a
// line of the grid. (Bilinear, the speed of Z itself would jump there.)

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace kinebus {

/// Heights of the bed's surface, mm, row by row from Y's least, each from X's least.
struct MeshGrid {
  static constexpr int kMostPoints = 20;  ///< along one axis
  std::array<int, 2> points{};            ///< along X and Y, 2 to kMostPoints
  std::array<double, 2> from_mm{}, to_mm{};
  /// The correction fades with the height above the bed and is gone from here on, mm; 0: never.
  double fade_mm = 0;
  std::vector<float> height_mm;
  friend bool operator==(const MeshGrid&, const MeshGrid&) = default;

  /// Of height_mm.
  std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(points[0]) +
           static_cast<std::size_t>(column);
  }
  double at_mm(int column, int row) const { return double{height_mm[place(column, row)]}; }
  bool complete() const;  ///< sizes agree, all numbers are finite
  double lowest_mm() const;
  double highest_mm() const;
};

class BedMesh {
 public:
  /// By how much a point above the bed is moved up, and the derivatives of that by x, y and z.
  struct Lift {
    double v = 0, x = 0, y = 0, z = 0, xx = 0, xy = 0, yy = 0, xz = 0, yz = 0, zz = 0;
  };

  /// `grid` must be complete().
  explicit BedMesh(MeshGrid grid);

  const MeshGrid& grid() const { return grid_; }
  /// At a point of the table's coordinates, mm. Outside the grid the heights at its border count, reached
  /// without a kink within half a step of the grid. Cost: 60 ns.
  Lift lift(double x_mm, double y_mm, double z_mm) const;
  bool acts_at(double z_mm) const { return !(grid_.fade_mm > 0) || z_mm < grid_.fade_mm; }
  /// z for which z + lift = `above_mm`: what a tool that stands there calls its height.
  double height_below(double x_mm, double y_mm, double above_mm) const;

  /// A correction that fades over less than so many times the greatest height would change too steeply with
  /// the height to be undone.
  static constexpr double kLeastFade = 4;

 private:
  struct Place;
  Place place(int axis, double at_mm) const;

  MeshGrid grid_;
  std::array<double, 2> step_mm_{};
  struct Knot {
    double f = 0, fx = 0, fy = 0, fxy = 0;  ///< slopes by the grid's steps
  };
  std::vector<Knot> knots_;
};

}  // namespace kinebus
