#include "tools/kinematics/m1_assemblies.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>

namespace kinebus {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Complex = std::complex<double>;

constexpr int kDegree = 6;
/// A leg closes to this. Rounding leaves about 1e-12 at 2 m.
constexpr double kClosed_mm = 1e-9;

struct Legs {
  std::array<Vector3d, 4> attachment, carriage, rail;  // b; a + (q + c) d^; d^
  std::array<double, 4> length{};
  std::array<double, 4> side{};

  Legs(const M1Geometry& g, const JointVector& joints) {
    for (std::size_t i = 0; i < 4; ++i) {
      const M1Leg& leg = g.legs[i];
      rail[i] = Vector3d(leg.rail[0], leg.rail[1], leg.rail[2]).normalized();
      attachment[i] = Vector3d(leg.attachment_mm[0], leg.attachment_mm[1], leg.attachment_mm[2]);
      carriage[i] =
          Vector3d(leg.foot_mm[0], leg.foot_mm[1], leg.foot_mm[2]) + (joints[i] + leg.connector_mm) * rail[i];
      length[i] = leg.length_mm;
      side[i] = leg.carriage_above ? 1 : -1;
    }
  }
  Vector3d turned(std::size_t i, double a) const {
    const double c = std::cos(a), s = std::sin(a);
    const Vector3d& b = attachment[i];
    return {b.x(), c * b.y() - s * b.z(), s * b.y() + c * b.z()};
  }
};

/// With A given: p + e_i is leg i, and the differences of |p + e_i|^2 = l_i^2 say m p = w.
struct AtTilt {
  std::array<Vector3d, 4> e;
  Matrix3d m;
  Vector3d w;

  AtTilt(const Legs& legs, double a) {
    for (std::size_t i = 0; i < 4; ++i) e[i] = legs.turned(i, a) - legs.carriage[i];
    const auto constant = [&](std::size_t i) { return e[i].squaredNorm() - legs.length[i] * legs.length[i]; };
    for (std::size_t i = 1; i < 4; ++i) {
      m.row(static_cast<Eigen::Index>(i - 1)) = e[i] - e[0];
      w(static_cast<Eigen::Index>(i - 1)) = 0.5 * (constant(0) - constant(i));
    }
  }
};

/// |p + e_1|^2 - l_1^2 times det(m)^2, lengths in units of the first leg's: a polynomial of degree 6 in A.
double eliminated(const Legs& legs, double a) {
  const AtTilt at(legs, a);
  const double unit = legs.length[0];
  const Matrix3d m = at.m / unit;
  const Vector3d w = at.w / (unit * unit), e = at.e[0] / unit;
  // The adjugate: det(m) p = adj(m) w also where m is singular.
  Matrix3d adjugate;
  adjugate.col(0) = m.row(1).transpose().cross(m.row(2).transpose());
  adjugate.col(1) = m.row(2).transpose().cross(m.row(0).transpose());
  adjugate.col(2) = m.row(0).transpose().cross(m.row(1).transpose());
  const double det = m.determinant();
  return (adjugate * w + det * e).squaredNorm() - det * det;
}

/// Angles at which the polynomial may vanish: roots near the unit circle.
std::vector<double> candidate_tilts(const Legs& legs) {
  constexpr int kSamples = 32;
  std::array<double, kSamples> values{};
  double largest = 0;
  for (int k = 0; k < kSamples; ++k) {
    values[static_cast<std::size_t>(k)] = eliminated(legs, 2 * std::numbers::pi * k / kSamples);
    largest = std::max(largest, std::abs(values[static_cast<std::size_t>(k)]));
  }
  std::array<Complex, 2 * kDegree + 1> c{};
  const auto coefficient = [&c](int power) -> Complex& {
    const int place = power + kDegree;
    return c[static_cast<std::size_t>(place)];
  };
  for (int n = -kDegree; n <= kDegree; ++n) {
    Complex sum = 0;
    for (int k = 0; k < kSamples; ++k)
      sum += values[static_cast<std::size_t>(k)] *
             std::polar(1.0, -2 * std::numbers::pi * ((n * k) % kSamples) / kSamples);
    coefficient(n) = sum / static_cast<double>(kSamples);
  }
  // Vertical rails leave leading coefficients that are rounding.
  constexpr double kZero = 1e-13;
  int degree = kDegree;
  while (degree > 0 && std::abs(coefficient(degree)) <= kZero * largest) --degree;
  if (degree == 0 || !(largest > 0)) return {};
  const int order = 2 * degree;
  Eigen::MatrixXcd companion = Eigen::MatrixXcd::Zero(order, order);
  const Complex leading = coefficient(degree);
  for (int n = 0; n < order; ++n) {
    companion(n, order - 1) = -coefficient(n - degree) / leading;
    if (n > 0) companion(n, n - 1) = 1;
  }
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(companion, false);
  std::vector<double> tilts;
  for (int n = 0; n < order; ++n) {
    const Complex z = solver.eigenvalues()(n);
    // A double root leaves the circle by the square root of rounding: Newton tells the real ones.
    if (std::abs(std::abs(z) - 1) < 0.02) tilts.push_back(std::arg(z));
  }
  return tilts;
}

double residual_of(const Legs& legs, const Vector3d& p, double a) {
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i)
    worst = std::max(worst, std::abs((p + legs.turned(i, a) - legs.carriage[i]).norm() - legs.length[i]));
  return worst;
}

/// Levenberg's method on the four leg lengths.
double polish(const Legs& legs, Vector3d& p, double& a) {
  const double lever = legs.length[0];  // makes the angle a length
  double damping = 0, worst = residual_of(legs, p, a);
  constexpr int kMostSteps = 60;
  for (int step = 0; step < kMostSteps; ++step) {
    Vector4d r;
    Matrix4d j;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const Vector3d b = legs.turned(i, a), leg = p + b - legs.carriage[i];
      const double length = leg.norm();
      r(row) = length - legs.length[i];
      j.row(row) << leg.transpose() / length, (b.y() * leg.z() - b.z() * leg.y()) / (length * lever);
    }
    const Vector4d move =
        (j.transpose() * j + damping * Matrix4d::Identity()).ldlt().solve(-j.transpose() * r);
    if (!move.allFinite()) break;
    const Vector3d p_next = p + move.head<3>();
    const double a_next = a + move(3) / lever, next = residual_of(legs, p_next, a_next);
    if (next < worst) {
      p = p_next;
      a = a_next;
      worst = next;
      damping = damping < 1e-8 ? 0 : damping / 10;
    } else {
      if (worst < kClosed_mm / 10 || move.norm() < 1e-13) break;
      damping = std::max(10 * damping, 1e-4);
    }
  }
  return worst;
}

/// Platforms that a tilt may have: the linear equations' answer, and, for where they are dependent (level
/// carriages), the two points of their line that are the first leg's length away.
std::vector<Vector3d> platforms_at(const Legs& legs, double a) {
  const AtTilt at(legs, a);
  std::vector<Vector3d> found;
  const Eigen::JacobiSVD<Matrix3d> svd(at.m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d& sigma = svd.singularValues();
  const Vector3d turned = svd.matrixU().transpose() * at.w;
  if (!(sigma(1) > 0)) return found;
  const Vector3d along = svd.matrixV().col(2);
  const Vector3d base =
      svd.matrixV().col(0) * (turned(0) / sigma(0)) + svd.matrixV().col(1) * (turned(1) / sigma(1));
  if (sigma(2) > 1e-12 * sigma(0)) found.emplace_back(base + along * (turned(2) / sigma(2)));
  const Vector3d from = base + at.e[0];
  const double half = from.dot(along), rest = from.squaredNorm() - legs.length[0] * legs.length[0];
  const double root = std::sqrt(std::max(half * half - rest, 0.0));
  found.emplace_back(base + along * (-half + root));
  found.emplace_back(base + along * (-half - root));
  return found;
}

}  // namespace

std::vector<M1Assembly> m1_assemblies(const M1Geometry& geometry, const JointVector& joints) {
  const Legs legs(geometry, joints);
  std::vector<M1Assembly> found;
  for (const double tilt : candidate_tilts(legs))
    for (Vector3d p : platforms_at(legs, tilt)) {
      double a = tilt;
      const double residual = polish(legs, p, a);
      if (!(residual < kClosed_mm)) continue;
      a = std::remainder(a, 2 * std::numbers::pi);
      const bool known = std::any_of(found.begin(), found.end(), [&](const M1Assembly& other) {
        const Vector3d q(other.platform_mm[0], other.platform_mm[1], other.platform_mm[2]);
        return (p - q).norm() < 1e-4 &&
               std::abs(std::remainder(a - other.a_rad, 2 * std::numbers::pi)) < 1e-6;
      });
      if (known) continue;
      M1Assembly assembly{{p.x(), p.y(), p.z()}, a, residual, {}};
      for (std::size_t i = 0; i < 4; ++i) {
        const Vector3d leg = p + legs.turned(i, a) - legs.carriage[i];
        assembly.as_described[i] = -legs.side[i] * leg.dot(legs.rail[i]) > 0;
      }
      found.push_back(assembly);
    }
  std::stable_sort(found.begin(), found.end(), [](const M1Assembly& a, const M1Assembly& b) {
    if (a.physical() != b.physical()) return a.physical();
    return a.a_rad < b.a_rad;
  });
  return found;
}

}  // namespace kinebus
