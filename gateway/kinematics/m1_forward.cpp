#include "gateway/kinematics/m1_forward.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinebus {
namespace {

constexpr int kLegs = 4;
using Vector4 = std::array<double, 4>;  // p in mm, A scaled to mm

/// Residuals r_i = (|L_i|^2 - l_i^2) / (2 l_i), mm, and their Jacobian by (p, scaled A).
struct Closure {
  double r[kLegs];
  double j[kLegs][4];
  double along[kLegs];  // -branch * L . d^: > 0 on the right branch
  double squares = 0;
  double worst_mm = 0;
};

struct Problem {
  const LegTable& t;
  double sx0[kLegs], sy0[kLegs], sz0[kLegs];  // -a - (q + c) d^, with b.x in x
  double inv_l[kLegs];
  double per_scale;

  Problem(const LegTable& legs, const JointVector& joints, double rotation_scale_mm)
      : t(legs), per_scale(1 / rotation_scale_mm) {
    for (int i = 0; i < kLegs; ++i) {
      const double w = joints[static_cast<std::size_t>(i)] + t.c[i];
      sx0[i] = t.bx_ax[i] - w * t.dx[i];
      sy0[i] = -t.ay[i] - w * t.dy[i];
      sz0[i] = -t.az[i] - w * t.dz[i];
      inv_l[i] = 1 / std::sqrt(t.ll[i]);
    }
  }

  void evaluate(const Vector4& x, Closure& out) const {
    const double angle = x[3] * per_scale, ca = std::cos(angle), sa = std::sin(angle);
    out.squares = 0;
    out.worst_mm = 0;
    for (int i = 0; i < kLegs; ++i) {
      const double by = ca * t.by[i] - sa * t.bz[i], bz = sa * t.by[i] + ca * t.bz[i];
      const double lx = x[0] + sx0[i], ly = x[1] + by + sy0[i], lz = x[2] + bz + sz0[i];
      out.r[i] = 0.5 * (lx * lx + ly * ly + lz * lz - t.ll[i]) * inv_l[i];
      out.j[i][0] = lx * inv_l[i];
      out.j[i][1] = ly * inv_l[i];
      out.j[i][2] = lz * inv_l[i];
      out.j[i][3] = (by * lz - bz * ly) * inv_l[i] * per_scale;
      out.along[i] = -t.branch[i] * (lx * t.dx[i] + ly * t.dy[i] + lz * t.dz[i]);
      out.squares += out.r[i] * out.r[i];
    }
    for (const double r : out.r) out.worst_mm = std::max(out.worst_mm, std::abs(r));
  }
};

/// (J^T J + damping I) step = -J^T r, by Cholesky. false: not positive definite.
bool solve_step(const Closure& f, double damping, Vector4& step) {
  double g[4][4], y[4];
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b <= a; ++b)
      g[a][b] = f.j[0][a] * f.j[0][b] + f.j[1][a] * f.j[1][b] + f.j[2][a] * f.j[2][b] + f.j[3][a] * f.j[3][b];
    g[a][a] += damping;
    y[a] = -(f.j[0][a] * f.r[0] + f.j[1][a] * f.r[1] + f.j[2][a] * f.r[2] + f.j[3][a] * f.r[3]);
  }
  double inverse[4];
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      double v = g[a][b];
      for (int k = 0; k < b; ++k) v -= g[a][k] * g[b][k];
      g[a][b] = v * inverse[b];
    }
    double v = g[a][a];
    for (int k = 0; k < a; ++k) v -= g[a][k] * g[a][k];
    if (!(v > 1e-14)) return false;
    inverse[a] = 1 / std::sqrt(v);
  }
  for (int a = 0; a < 4; ++a) {
    for (int k = 0; k < a; ++k) y[a] -= g[a][k] * y[k];
    y[a] *= inverse[a];
  }
  for (int a = 3; a >= 0; --a) {
    for (int k = a + 1; k < 4; ++k) y[a] -= g[k][a] * y[k];
    y[a] *= inverse[a];
  }
  step = {y[0], y[1], y[2], y[3]};
  return true;
}

/// One run of Levenberg's method. Returns the closure error; x moves to where it ends.
double descend(const Problem& problem, Vector4& x, Closure& f) {
  constexpr int kMaxSteps = 60;
  // A full step below this changes legs by less than rounding does: quadratic convergence is done.
  constexpr double kLastStepSquared_mm2 = 1e-14;
  problem.evaluate(x, f);
  double damping = 0;
  Closure trial;
  for (int k = 0; k < kMaxSteps; ++k) {
    Vector4 step;
    if (!solve_step(f, damping, step)) {
      damping = std::max(10 * damping, 1e-3);
      continue;
    }
    const Vector4 y{x[0] + step[0], x[1] + step[1], x[2] + step[2], x[3] + step[3]};
    problem.evaluate(y, trial);
    const double moved = step[0] * step[0] + step[1] * step[1] + step[2] * step[2] + step[3] * step[3];
    if (moved < kLastStepSquared_mm2 && trial.worst_mm < kForwardTolerance_mm) {
      x = y;
      f = trial;
      return f.worst_mm;
    }
    if (trial.squares < f.squares) {
      x = y;
      f = trial;
      damping = damping < 1e-6 ? 0 : damping * 0.1;
    } else {
      if (!(moved > 1e-24)) break;
      damping = std::max(10 * damping, 1e-3);
    }
  }
  return f.worst_mm;
}

}  // namespace

double solve_platform(const LegTable& legs, const M1Geometry& geometry, const JointVector& joints,
                      PlatformPose& pose) {
  const double scale = geometry.rotation_scale_mm;
  const Problem problem(legs, joints, scale);
  // Homing and hand-moved carriages stand a little outside the pose limits.
  constexpr double kSpare_rad = 0.35;
  const Interval& a = geometry.limits.a_rad;
  const double a_min = a.limited() ? a.min - kSpare_rad : -std::numbers::pi / 2;
  const double a_max = a.limited() ? a.max + kSpare_rad : std::numbers::pi / 2;
  const Interval z = geometry.limits.z_mm.limited() ? geometry.limits.z_mm : Interval{-200, 200};

  double best = std::numeric_limits<double>::infinity();
  constexpr int kStarts = 10;
  for (int k = 0; k < kStarts; ++k) {
    Vector4 x;
    if (k == 0) {
      x = {pose.p_mm[0], pose.p_mm[1], pose.p_mm[2], pose.a_rad * scale};
    } else {
      // Table centre at three heights, level and tilted both ways.
      const int level = (k - 1) / 3;
      const double height = z.min + (z.max - z.min) * (0.25 + 0.25 * level);
      const double tilt =
          ((k - 1) % 3 == 0 ? 0.0 : ((k - 1) % 3 == 1 ? 0.6 : -0.6)) * std::min(a_max, -a_min);
      x = {geometry.nozzle_mm[0], geometry.nozzle_mm[1], geometry.nozzle_mm[2] - height, tilt * scale};
    }
    Closure f;
    const double error = descend(problem, x, f);
    const double angle = x[3] / scale;
    const bool right = angle >= a_min && angle <= a_max &&
                       std::all_of(f.along, f.along + kLegs, [](double v) { return v > 0; });
    if (right && error < kForwardTolerance_mm) {
      pose = {{x[0], x[1], x[2]}, angle};
      return error;
    }
    if (!(error < kForwardTolerance_mm)) best = std::min(best, error);
  }
  // Only other assemblies were found: no pose of this machine has these joints.
  return std::isfinite(best) ? std::max(best, kForwardTolerance_mm) : std::numeric_limits<double>::infinity();
}

}  // namespace kinebus
