// Forward kinematics of M4's planar mechanism, by elimination and by Newton.

#include "gateway/kinematics/m4.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/Polynomials>

namespace kinebus {
namespace {

constexpr int kDegree = 8;
constexpr double kClosed_mm = 1e-9;

/// Polynomial in t = tan((phi - phi0) / 2) over (1 + t^2)^n; index = power of t.
using Polynomial = std::vector<double>;

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial c(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < b.size(); ++k) c[i + k] += a[i] * b[k];
  return c;
}
Polynomial sum(const Polynomial& a, const Polynomial& b, double factor = 1) {
  Polynomial c(std::max(a.size(), b.size()), 0.0);
  for (std::size_t i = 0; i < a.size(); ++i) c[i] += a[i];
  for (std::size_t i = 0; i < b.size(); ++i) c[i] += factor * b[i];
  return c;
}

/// constant + cosine * cos(phi) + sine * sin(phi), times 1 + t^2, with phi = phi0 + 2 atan t.
Polynomial trigonometric(double constant, double cosine, double sine, double phi0) {
  const double c = std::cos(phi0), s = std::sin(phi0);
  const double a = cosine * c + sine * s, b = sine * c - cosine * s;
  return {constant + a, 2 * b, constant - a};
}

struct Residual {
  Eigen::Vector3d r;
  Eigen::Matrix3d j;
  double worst() const { return r.cwiseAbs().maxCoeff(); }
};

/// Rod length errors and the height error of C, mm, by (x, y, phi). `height` of C over AB: negative when
/// mirrored.
Residual closure(const M4Geometry& g, const Vector3& inputs, double height, const PlanarPose& p) {
  const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), half = g.triangle_mm / 2;
  Residual out;
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1;
    const double hx = p.x_mm + side * half * c - side * g.rails_mm / 2;
    const double hy = p.y_mm + side * half * s - inputs[static_cast<std::size_t>(i)];
    const double rod = std::hypot(hx, hy);
    out.r(i) = rod - g.rod_mm;
    out.j(i, 0) = hx / rod;
    out.j(i, 1) = hy / rod;
    out.j(i, 2) = side * half * (-s * hx + c * hy) / rod;
  }
  out.r(2) = p.y_mm + height * c - inputs[2];
  out.j.row(2) << 0, 1, -height * s;
  return out;
}

double height_of(const M4Geometry& g) {
  return std::numbers::sqrt3 / 2 * g.triangle_mm;
}

double polish(const M4Geometry& g, const Vector3& inputs, double height, PlanarPose& pose) {
  constexpr int kMostSteps = 50;
  Residual f = closure(g, inputs, height, pose);
  double damping = 0;
  for (int k = 0; k < kMostSteps; ++k) {
    // Levenberg's step, the angle scaled by the triangle's height to be a length.
    Eigen::Matrix3d j = f.j;
    const double lever = std::abs(height);
    j.col(2) /= lever;
    const Eigen::Vector3d step =
        (j.transpose() * j + damping * Eigen::Matrix3d::Identity()).ldlt().solve(-j.transpose() * f.r);
    if (!step.allFinite()) break;
    const PlanarPose next{pose.x_mm + step(0), pose.y_mm + step(1), pose.phi_rad + step(2) / lever};
    const Residual trial = closure(g, inputs, height, next);
    if (trial.worst() < f.worst()) {
      pose = next;
      f = trial;
      damping = damping < 1e-8 ? 0 : damping / 10;
    } else {
      if (f.worst() < 1e-11 || step.norm() < 1e-13) break;
      damping = std::max(10 * damping, 1e-4);
    }
  }
  return f.worst();
}

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

/// The resultant's coefficients. With u_i the vertical part of rod i and 2w the distance of the rails less
/// the triangle's width, the rods say x^2 + 2w x + (w^2 + u1^2 - L1^2) = 0 and x^2 - 2w x + (w^2 + u2^2 -
/// L1^2) = 0.
Polynomial resultant(const M4Geometry& g, const Vector3& inputs, double height, double phi0) {
  const double half = g.triangle_mm / 2;
  const Polynomial u1 = trigonometric(inputs[0] - inputs[2], height, half, phi0);
  const Polynomial u2 = trigonometric(inputs[1] - inputs[2], height, -half, phi0);
  const Polynomial w = trigonometric(g.rails_mm / 2, -half, 0, phi0);
  const Polynomial unit{1, 0, 1};
  const Polynomial rod = product(product(unit, unit), {g.rod_mm * g.rod_mm});
  const Polynomial ww = product(w, w);
  const Polynomial a0 = sum(sum(ww, product(u1, u1)), rod, -1);
  const Polynomial b0 = sum(sum(ww, product(u2, u2)), rod, -1);
  // Bezout's determinant of x^2 + a1 x + a0 and x^2 + b1 x + b0: (a0 - b0)^2 + (a1 - b1)(a1 b0 - a0 b1), here
  // with a1 = 2w = -b1.
  const Polynomial difference = sum(a0, b0, -1);
  return sum(product(difference, difference), product(product(ww, {8}), sum(a0, b0)));
}

void collect(const M4Geometry& g, const Vector3& inputs, bool mirrored, std::vector<M4Assembly>& found) {
  const double height = mirrored ? -height_of(g) : height_of(g);
  // phi = phi0 + pi is t = infinity: the substitution starts where the leading coefficient says it is no
  // root.
  double phi0 = 0;
  Polynomial p = resultant(g, inputs, height, phi0);
  const auto largest = [](const Polynomial& q) {
    double v = 0;
    for (const double c : q) v = std::max(v, std::abs(c));
    return v;
  };
  for (int k = 0; k < 3 && std::abs(p[kDegree]) < 1e-6 * largest(p); ++k) {
    phi0 += 0.9;
    p = resultant(g, inputs, height, phi0);
  }
  Eigen::Matrix<double, kDegree + 1, 1> coefficients;
  for (int i = 0; i <= kDegree; ++i) coefficients(i) = p[static_cast<std::size_t>(i)] / largest(p);
  if (!coefficients.allFinite() || coefficients(kDegree) == 0) return;
  Eigen::PolynomialSolver<double, kDegree> solver;
  solver.compute(coefficients);
  const double half = g.triangle_mm / 2;
  for (int i = 0; i < kDegree; ++i) {
    const std::complex<double> t = solver.roots()(i);
    // A double root's imaginary part is the square root of rounding: Newton tells the real ones.
    if (std::abs(t.imag()) > 1e-3 * (1 + std::abs(t.real()))) continue;
    PlanarPose pose;
    pose.phi_rad = wrapped(phi0 + 2 * std::atan(t.real()));
    const double c = std::cos(pose.phi_rad), s = std::sin(pose.phi_rad);
    const double u1 = inputs[0] - inputs[2] + height * c + half * s;
    const double u2 = inputs[1] - inputs[2] + height * c - half * s;
    const double w = g.rails_mm / 2 - half * c;
    if (std::abs(w) < 1e-9) continue;
    pose.x_mm = (u2 * u2 - u1 * u1) / (4 * w);
    pose.y_mm = inputs[2] - height * c;
    const double residual = polish(g, inputs, height, pose);
    if (!(residual < kClosed_mm)) continue;
    pose.phi_rad = wrapped(pose.phi_rad);
    const bool known = std::any_of(found.begin(), found.end(), [&](const M4Assembly& a) {
      return a.mirrored == mirrored && std::abs(a.pose.x_mm - pose.x_mm) < 1e-5 &&
             std::abs(a.pose.y_mm - pose.y_mm) < 1e-5 &&
             std::abs(wrapped(a.pose.phi_rad - pose.phi_rad)) < 1e-7;
    });
    if (known) continue;
    const double sine = std::sin(pose.phi_rad);
    found.push_back({pose,
                     residual,
                     mirrored,
                     {inputs[0] > pose.y_mm - half * sine, inputs[1] > pose.y_mm + half * sine}});
  }
}

}  // namespace

std::vector<M4Assembly> m4_assemblies(const M4Geometry& geometry, const Vector3& inputs_mm) {
  std::vector<M4Assembly> found;
  for (const bool mirrored : {false, true}) collect(geometry, inputs_mm, mirrored, found);
  std::stable_sort(found.begin(), found.end(), [](const M4Assembly& a, const M4Assembly& b) {
    if (a.physical() != b.physical()) return a.physical();
    if (a.mirrored != b.mirrored) return b.mirrored;
    return a.pose.y_mm < b.pose.y_mm;
  });
  return found;
}

double m4_newton(const M4Geometry& geometry, const Vector3& inputs_mm, PlanarPose& pose) {
  PlanarPose trial = pose;
  const double residual = polish(geometry, inputs_mm, height_of(geometry), trial);
  if (residual < kClosed_mm) pose = {trial.x_mm, trial.y_mm, wrapped(trial.phi_rad)};
  return residual;
}

Result<Vector3, PoseError> m4_inputs(const M4Geometry& g, const PlanarPose& p) {
  const double c = std::cos(p.phi_rad), s = std::sin(p.phi_rad), half = g.triangle_mm / 2;
  Vector3 inputs{0, 0, p.y_mm + height_of(g) * c};
  for (int i = 0; i < 2; ++i) {
    const double side = i == 0 ? -1 : 1;
    const double h = p.x_mm + side * half * c - side * g.rails_mm / 2;
    const double radicand = g.rod_mm * g.rod_mm - h * h;
    if (!(radicand > 0)) return Error<PoseError>({PoseError::Kind::kOutOfReach, i, std::abs(h) - g.rod_mm});
    inputs[static_cast<std::size_t>(i)] = p.y_mm + side * half * s + std::sqrt(radicand);
  }
  return inputs;
}

}  // namespace kinebus
