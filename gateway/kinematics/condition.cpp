// Conditioning of small Jacobians.

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "gateway/kinematics/pose_limits.hpp"

namespace kinebus {
namespace {
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 4, 4>;
}

double condition_number(const double* matrix, int n) {
  const Eigen::Map<const RowMajor> m(matrix, n, n);
  if (!m.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::JacobiSVD<RowMajor> svd(m);
  const auto& s = svd.singularValues();
  // Below this a singular value is rounding of the largest one.
  constexpr double kZero = 1e-14;
  if (!(s(n - 1) > kZero * s(0))) return std::numeric_limits<double>::infinity();
  return s(0) / s(n - 1);
}

bool condition_is_within_4(const double* matrix, double most) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(matrix);
  const Eigen::Matrix4d square = m.transpose() * m;
  const double trace = square.trace();
  if (!(trace > 0) || !std::isfinite(trace)) return false;
  const Eigen::Matrix4d g = square / trace;
  // (sum of the eigenvalues' 16th powers)^(1/16) is above the largest of four by 9 % at most.
  const Eigen::Matrix4d g2 = g * g, g4 = g2 * g2, g8 = g4 * g4;
  const double largest = std::sqrt(std::sqrt(std::sqrt(std::sqrt(g8.squaredNorm()))));
  // Every eigenvalue is above that / most^2 when what is left without it is positive definite.
  const Eigen::Matrix4d left = g - largest / (most * most) * Eigen::Matrix4d::Identity();
  const Eigen::LLT<Eigen::Matrix4d> cholesky(left);
  return cholesky.info() == Eigen::Success;
}

}  // namespace kinebus
