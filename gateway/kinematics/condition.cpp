// Conditioning of small Jacobians.

#include <Eigen/Dense>
#include <array>
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
  // Beyond, rounding of the determinant counts, and the powers below overflow.
  constexpr double kDetermined = 1e6;
  if (!(most < kDetermined)) return false;
  // Of the squared singular values, the elementary symmetric functions: sums of the squares of all minors
  // (Cauchy and Binet), those of two rows through the square's trace.
  const double *r0 = matrix, *r1 = matrix + 4, *r2 = matrix + 8, *r3 = matrix + 12;
  const auto minors = [](const double* p, const double* q) {
    return std::array<double, 6>{p[0] * q[1] - p[1] * q[0], p[0] * q[2] - p[2] * q[0],
                                 p[0] * q[3] - p[3] * q[0], p[1] * q[2] - p[2] * q[1],
                                 p[1] * q[3] - p[3] * q[1], p[2] * q[3] - p[3] * q[2]};
  };
  // Squares of the four 3 x 3 minors that a row makes with the 2 x 2 minors of two others.
  const auto three = [](const double* r, const std::array<double, 6>& m) {
    const double a = r[1] * m[5] - r[2] * m[4] + r[3] * m[3], b = r[0] * m[5] - r[2] * m[2] + r[3] * m[1];
    const double c = r[0] * m[4] - r[1] * m[2] + r[3] * m[0], d = r[0] * m[3] - r[1] * m[1] + r[2] * m[0];
    return a * a + b * b + c * c + d * d;
  };
  const auto dot = [](const double* p, const double* q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3];
  };
  const auto upper = minors(r0, r1), lower = minors(r2, r3);
  const double determinant = upper[0] * lower[5] - upper[1] * lower[4] + upper[2] * lower[3] +
                             upper[3] * lower[2] - upper[4] * lower[1] + upper[5] * lower[0];
  const double g00 = dot(r0, r0), g11 = dot(r1, r1), g22 = dot(r2, r2), g33 = dot(r3, r3);
  const double trace = g00 + g11 + g22 + g33;
  // Most matrices are nowhere near: 2 / |det| times the squared quarter of the trace is never below the
  // number (Guggenheimer).
  if (trace * trace <= 8 * most * std::abs(determinant)) return true;
  const double g01 = dot(r0, r1), g02 = dot(r0, r2), g03 = dot(r0, r3), g12 = dot(r1, r2);
  const double g13 = dot(r1, r3), g23 = dot(r2, r3);
  const double per_trace = 1 / trace, per_trace2 = per_trace * per_trace;
  double e2 = (g00 * g11 + g00 * g22 + g00 * g33 + g11 * g22 + g11 * g33 + g22 * g33 - g01 * g01 - g02 * g02 -
               g03 * g03 - g12 * g12 - g13 * g13 - g23 * g23) *
              per_trace2;
  double e3 =
      (three(r0, lower) + three(r1, lower) + three(r2, upper) + three(r3, upper)) * per_trace * per_trace2;
  double e4 = determinant * determinant * per_trace2 * per_trace2;
  double e1 = 1, ratio = most * most;
  // The largest is at most e1, and one over the smallest at most e3 / e4; both by a factor of four at most,
  // of which a root is left whenever all are squared (Dandelin and Graeffe).
  for (int squared = 0; squared < 5; ++squared) {
    if (e1 * e3 <= ratio * e4) return true;
    const double f1 = e1 * e1 - 2 * e2, f2 = e2 * e2 - 2 * e1 * e3 + 2 * e4, f3 = e3 * e3 - 2 * e2 * e4;
    e1 = f1, e2 = f2, e3 = f3, e4 *= e4, ratio *= ratio;
  }
  return false;
}

}  // namespace kinebus
