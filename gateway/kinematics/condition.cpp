// Conditioning of small Jacobians.

#include <Eigen/Dense>
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

double condition_bound_4(const double* matrix) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(matrix);
  const double mean_square = m.squaredNorm() / 4;
  return 2 * mean_square * mean_square / std::abs(m.determinant());
}

}  // namespace kinebus
