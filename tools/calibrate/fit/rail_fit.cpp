#include "tools/calibrate/fit/rail_fit.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "gateway/calibration/joint_map.hpp"
#include "tools/calibrate/fit/robust.hpp"

namespace kinebus {
namespace {

struct Solution {
  Eigen::VectorXd x;
  Eigen::MatrixXd covariance;
  std::size_t outliers = 0;
};

/// Iteratively reweighted least squares. Columns that the rows cannot tell apart share their value (minimum
/// norm).
Solution solve_robust(const Eigen::MatrixXd& a, const Eigen::VectorXd& y) {
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(y.size());
  Solution s;
  double sigma = 0;
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd root = weight.cwiseSqrt();
    const Eigen::MatrixXd weighted = root.asDiagonal() * a;
    s.x = weighted.completeOrthogonalDecomposition().solve(root.cwiseProduct(y));
    const Eigen::VectorXd r = y - a * s.x;
    // The floor is rounding: exact data must not make outliers of it.
    sigma = std::max(robust_sigma({r.data(), r.data() + r.size()}), 1e-12);
    for (Eigen::Index i = 0; i < r.size(); ++i) weight(i) = huber_weight(r(i), sigma);
    s.covariance =
        sigma * sigma * (weighted.transpose() * weighted).completeOrthogonalDecomposition().pseudoInverse();
  }
  for (Eigen::Index i = 0; i < weight.size(); ++i) s.outliers += weight(i) < 0.5 ? 1 : 0;
  return s;
}

/// Places of the table, from the first measured one to the last.
JointCalibration table_over(double low, double high, int points) {
  JointCalibration c;
  c.table_start = low;
  c.table_step = (high - low) / (points - 1);
  c.table.assign(static_cast<std::size_t>(points), 0.0);
  return c;
}

}  // namespace

RailFit fit_rail(std::span<const RailSample> samples, const RailFitOptions& options) {
  RailFit fit;
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::VectorXd y(n);
  double low = HUGE_VAL, high = -HUGE_VAL;
  bool forth = false, back = false;
  for (Eigen::Index i = 0; i < n; ++i) {
    const RailSample& s = samples[static_cast<std::size_t>(i)];
    y(i) = s.measured - s.commanded;
    low = std::min(low, s.commanded);
    high = std::max(high, s.commanded);
    (s.direction >= 0 ? forth : back) = true;
  }
  fit.has_both_directions = forth && back;
  if (n > 0) {
    const double mean = y.mean();
    for (Eigen::Index i = 0; i < n; ++i) fit.before.push_back(y(i) - mean);
    fit.before_rms = rms_of(fit.before);
  }
  fit.after = fit.before;
  fit.after_rms = fit.before_rms;
  if (n < 3 || !(high > low)) return fit;

  const bool periodic = options.pitch > 0;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, 5);
  Eigen::VectorXd place(n);  // of each sample in the joint's own coordinates, as well as it is known
  Solution line;
  for (double scale = 0; const int pass : {0, 1}) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const RailSample& s = samples[static_cast<std::size_t>(i)];
      place(i) = options.anchor + (s.commanded - options.anchor) * (1 + scale);
      a(i, 0) = s.commanded - options.anchor;
      a(i, 1) = 1;
      if (fit.has_both_directions) a(i, 2) = s.direction >= 0 ? -0.5 : 0.5;
      if (!periodic) continue;
      const double phase = 2 * std::numbers::pi * place(i) / options.pitch;
      a(i, 3) = std::sin(phase);
      a(i, 4) = std::cos(phase);
    }
    line = solve_robust(a, y);
    scale = line.x(0);
    if (pass == 0 && !periodic && options.table_points < 2) break;
  }
  JointCalibration& c = fit.calibration;
  c.scale = line.x(0);
  fit.scale_sigma = std::sqrt(std::max(0.0, line.covariance(0, 0)));
  fit.zero = line.x(1);
  c.backlash = std::max(0.0, line.x(2));
  if (periodic) {
    c.pitch = options.pitch;
    c.periodic_sine = line.x(3);
    c.periodic_cosine = line.x(4);
  }
  fit.outliers = line.outliers;
  Eigen::VectorXd left = y - a * line.x;
  if (options.table_points >= 2) {
    const JointCalibration table = table_over(place.minCoeff(), place.maxCoeff(), options.table_points);
    Eigen::MatrixXd basis(n, options.table_points);
    for (int k = 0; k < options.table_points; ++k) {
      JointCalibration unit = table;
      unit.table[static_cast<std::size_t>(k)] = 1;
      const JointMap map(unit);
      for (Eigen::Index i = 0; i < n; ++i) {
        basis(i, k) = place(i) - map.to_drive(place(i));
      }
    }
    const Solution spline = solve_robust(basis, left);
    c.table_start = table.table_start;
    c.table_step = table.table_step;
    c.table.assign(spline.x.data(), spline.x.data() + spline.x.size());
    left -= basis * spline.x;
    fit.outliers = spline.outliers;
  }
  fit.after.assign(left.data(), left.data() + left.size());
  fit.after_rms = rms_of(fit.after);
  return fit;
}

}  // namespace kinebus
