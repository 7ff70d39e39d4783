#include "tools/compose/piece_frame.hpp"

#include <cmath>
#include <numbers>

namespace kinebus::compose {

namespace {
constexpr double kDeg = 180 / std::numbers::pi;
}

PieceFrame frame_from_angles(const Vector& origin_mm, double i_deg, double j_deg, double k_deg) {
  PieceFrame frame{origin_mm, Eigen::Matrix3d::Identity(), i_deg, j_deg, k_deg};
  frame.axes =
      (Eigen::AngleAxisd(i_deg / kDeg, Vector::UnitZ()) * Eigen::AngleAxisd(j_deg / kDeg, Vector::UnitX()) *
       Eigen::AngleAxisd(k_deg / kDeg, Vector::UnitZ()))
          .toRotationMatrix();
  return frame;
}

PieceFrame frame_of(const Solid& piece) {
  const Box box = bounds(piece.mesh);
  const Vector middle = (box.low + box.high) / 2;
  const Vector n = piece.base.normal;
  const Vector origin = middle - piece.base.over(middle) * n;
  const double lean = std::atan2(std::hypot(n[0], n[1]), n[2]);
  if (lean < 1e-9) return frame_from_angles({origin[0], origin[1], piece.base.height}, 0, 0, 0);
  // Turning about Z by I and about the new X by J sends z to (sin I sin J, -cos I sin J, cos J).
  const double i = std::atan2(n[0], -n[1]);
  return frame_from_angles(origin, i * kDeg, lean * kDeg, -i * kDeg);
}

TriangleMesh in_frame(const TriangleMesh& mesh, const PieceFrame& frame) {
  TriangleMesh out = mesh;
  for (Vector& p : out.points) p = frame.to_piece(p);
  return out;
}

}  // namespace kinebus::compose
