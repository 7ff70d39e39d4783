#pragma once
// The frame in which a piece is sliced and printed: z along its print direction, z = 0 on its base.

#include <Eigen/Geometry>

#include "tools/compose/overhang.hpp"

namespace kinebus::compose {

/// q = origin + axes * q'. The axes turn from the part's by the G68.2 angles (about Z, X', Z'').
struct PieceFrame {
  Vector origin{0, 0, 0};
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  double i_deg = 0, j_deg = 0, k_deg = 0;

  Vector to_piece(const Vector& q) const { return axes.transpose() * (q - origin); }
  Vector to_part(const Vector& q) const { return origin + axes * q; }
  Vector normal() const { return axes.col(2); }
};

/// The frame of a piece: its origin below the piece's middle, its x axis as near the part's as can be.
PieceFrame frame_of(const Solid& piece);
/// From G68.2's own numbers.
PieceFrame frame_from_angles(const Vector& origin_mm, double i_deg, double j_deg, double k_deg);

TriangleMesh in_frame(const TriangleMesh& mesh, const PieceFrame& frame);

}  // namespace kinebus::compose
