#include "gateway/calibration/geometry_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "gateway/calibration/robust.hpp"

namespace kinebus {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

bool asked_for(const GeometryModel::Parameter& p, const GeometryFitOptions& o, bool gauges) {
  if (p.name.starts_with("table tilt")) return gauges;
  if (!p.machine) return true;
  if (p.name.ends_with("switch offset")) return true;
  if (o.switch_offsets_only) return false;
  if (p.name.ends_with("scale")) return o.scale;
  if (p.name.find("rail lean") != std::string::npos) return o.rail_lean;
  return true;
}

std::vector<std::size_t> chosen(const GeometryModel& model, const GeometryFitOptions& options) {
  bool gauges = false;
  for (const GeometryReading& r : model.readings())
    gauges = gauges || r.kind == GeometryReading::Kind::kGauge;
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < model.parameters().size(); ++k)
    if (asked_for(model.parameters()[k], options, gauges)) list.push_back(k);
  return list;
}

/// Columns of the chosen parameters, each over its prior: a column of length 1 moves the readings by one
/// sigma when the parameter moves by all it may.
Eigen::MatrixXd scaled_columns(const GeometryModel& model, const std::vector<double>& jacobian,
                               const std::vector<std::size_t>& list) {
  const auto n = static_cast<Eigen::Index>(model.parameters().size());
  const Eigen::Map<const RowMajor> all(jacobian.data(), static_cast<Eigen::Index>(model.residual_count()), n);
  Eigen::MatrixXd a(all.rows(), static_cast<Eigen::Index>(list.size()));
  for (std::size_t k = 0; k < list.size(); ++k)
    a.col(static_cast<Eigen::Index>(k)) =
        all.col(static_cast<Eigen::Index>(list[k])) * model.parameters()[list[k]].prior;
  return a;
}

struct Identifiable {
  std::vector<std::size_t> free;                          // indices into the chosen list
  std::vector<std::pair<std::size_t, std::string>> held;  // and why
};

/// QR with column pivoting takes the parameter first that the readings tell most about, given those taken.
/// One whose own share moves all readings together by less than a few sigma is not determined: it follows
/// from others.
Identifiable identify(const GeometryModel& model, const Eigen::MatrixXd& a,
                      const std::vector<std::size_t>& list) {
  constexpr double kTold = 5;
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  const auto& order = qr.colsPermutation().indices();
  const Eigen::Index most = std::min(a.rows(), a.cols());
  Eigen::Index rank = 0;
  while (rank < most && std::abs(qr.matrixQR()(rank, rank)) > kTold) ++rank;
  Identifiable out;
  const Eigen::MatrixXd r = qr.matrixQR().topRows(rank).triangularView<Eigen::Upper>();
  const auto name = [&](Eigen::Index at) {
    return model.parameters()[list[static_cast<std::size_t>(order(at))]].name;
  };
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const auto index = static_cast<std::size_t>(order(k));
    if (k < rank) {
      out.free.push_back(index);
      continue;
    }
    std::string why = "no reading depends on it";
    if (rank > 0 && a.col(order(k)).norm() > kTold) {
      const Eigen::VectorXd share =
          r.leftCols(rank).triangularView<Eigen::Upper>().solve(Eigen::VectorXd(r.col(k)));
      std::vector<Eigen::Index> by(static_cast<std::size_t>(rank));
      for (Eigen::Index i = 0; i < rank; ++i) by[static_cast<std::size_t>(i)] = i;
      std::sort(by.begin(), by.end(),
                [&](Eigen::Index x, Eigen::Index y) { return std::abs(share(x)) > std::abs(share(y)); });
      why = "cannot be told from " + name(by[0]);
      for (std::size_t i = 1; i < by.size() && i < 3 && std::abs(share(by[i])) > 0.3 * std::abs(share(by[0]));
           ++i)
        why += ", " + name(by[i]);
    }
    out.held.emplace_back(index, why);
  }
  std::sort(out.free.begin(), out.free.end());
  return out;
}

struct Solved {
  bool ok = false;
  Eigen::MatrixXd covariance;  // of the free parameters, scaled
  std::size_t outliers = 0;
  int steps = 0;
};

/// Levenberg-Marquardt on the free parameters with Huber's weights, `x` moves. A weak prior keeps what is
/// known badly near 0.
Solved descend(const GeometryModel& model, const std::vector<std::size_t>& free, std::vector<double>& x) {
  constexpr int kMostSteps = 40;
  Solved s;
  const auto n = static_cast<Eigen::Index>(free.size());
  const auto prior_of = [&](Eigen::Index k) {
    return model.parameters()[free[static_cast<std::size_t>(k)]].prior;
  };
  auto residuals = model.residuals(x);
  if (!residuals) return s;
  double damping = 1e-6;
  const auto cost_of = [&](const std::vector<double>& r, const std::vector<double>& at, double sigma) {
    double cost = 0;
    for (const double v : r) {
      const double bound = 2 * sigma, u = std::abs(v);
      cost += u <= bound ? v * v : 2 * bound * u - bound * bound;
    }
    for (Eigen::Index k = 0; k < n; ++k) {
      const double p = at[free[static_cast<std::size_t>(k)]] / prior_of(k);
      cost += p * p;
    }
    return cost;
  };
  for (; s.steps < kMostSteps; ++s.steps) {
    const auto jacobian = model.jacobian(x);
    if (!jacobian) return s;
    const Eigen::MatrixXd a = scaled_columns(model, *jacobian, free);
    const double sigma = std::max(1.0, robust_sigma(*residuals));
    Eigen::VectorXd weight(a.rows()), r(a.rows());
    s.outliers = 0;
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
      r(i) = (*residuals)[static_cast<std::size_t>(i)];
      weight(i) = huber_weight(r(i), sigma);
      s.outliers += weight(i) < 0.5 ? 1 : 0;
    }
    Eigen::MatrixXd normal = a.transpose() * weight.asDiagonal() * a + Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd right = -(a.transpose() * weight.cwiseProduct(r));
    for (Eigen::Index k = 0; k < n; ++k) right(k) -= x[free[static_cast<std::size_t>(k)]] / prior_of(k);
    s.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(n, n)) * sigma * sigma;
    const double cost = cost_of(*residuals, x, sigma);
    bool moved = false;
    for (int tries = 0; tries < 12 && !moved; ++tries, damping *= 10) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1 + damping;
      const Eigen::VectorXd step = damped.ldlt().solve(right);
      std::vector<double> y = x;
      for (Eigen::Index k = 0; k < n; ++k) y[free[static_cast<std::size_t>(k)]] += step(k) * prior_of(k);
      auto trial = model.residuals(y);
      if (!trial) continue;
      const double better = cost_of(*trial, y, sigma);
      if (!(better <= cost)) continue;
      moved = true;
      x = std::move(y);
      residuals = std::move(trial);
      damping = std::max(1e-9, damping * 0.02);
      if (cost - better < 1e-9 * (1 + cost)) {
        s.ok = true;
        return s;
      }
    }
    if (!moved) break;
  }
  s.ok = true;
  return s;
}

std::vector<double> in_mm(const GeometryModel& model, const std::vector<double>& residuals) {
  std::vector<double> out;
  std::size_t at = 0;
  for (const GeometryReading& r : model.readings()) {
    std::size_t count = 1;
    if (r.kind == GeometryReading::Kind::kPoint)
      count = static_cast<std::size_t>(std::count(r.has.begin(), r.has.end(), true));
    for (std::size_t k = 0; k < count; ++k) out.push_back(residuals[at++] * r.sigma_mm);
  }
  return out;
}

}  // namespace

GeometryFit fit_geometry(const GeometryModel& model, const GeometryFitOptions& options) {
  GeometryFit fit;
  std::vector<double> x = model.start();
  const std::vector<std::size_t> list = chosen(model, options);
  // First where gauges and balls are, which says nothing about the machine.
  std::vector<std::size_t> setup;
  for (const std::size_t k : list)
    if (!model.parameters()[k].machine && !model.parameters()[k].name.starts_with("table"))
      setup.push_back(k);
  if (!setup.empty()) static_cast<void>(descend(model, setup, x));
  const auto first = model.residuals(x);
  const auto jacobian = first ? model.jacobian(x) : std::nullopt;
  if (!jacobian) {
    fit.problem = "a commanded pose is out of the machine's reach";
    return fit;
  }
  fit.before_mm = in_mm(model, *first);
  fit.before_rms_mm = rms_of(fit.before_mm);
  const Identifiable known = identify(model, scaled_columns(model, *jacobian, list), list);
  if (known.free.empty()) {
    fit.problem = "the readings determine nothing";
    return fit;
  }
  std::vector<std::size_t> free;
  for (const std::size_t k : known.free) free.push_back(list[k]);
  const Solved solved = descend(model, free, x);
  const auto last = solved.ok ? model.residuals(x) : std::nullopt;
  if (!last) {
    fit.problem = "no deviations within reason explain the readings";
    return fit;
  }
  fit.solved = true;
  fit.steps = solved.steps;
  fit.outliers = solved.outliers;
  fit.after_mm = in_mm(model, *last);
  fit.after_rms_mm = rms_of(fit.after_mm);
  fit.deviation = GeometryModel::deviation(x);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const GeometryModel::Parameter& p = model.parameters()[list[k]];
    FittedParameter f{p.name, p.unit, x[list[k]], 0, false, ""};
    const auto at = std::find(free.begin(), free.end(), list[k]);
    if (at != free.end()) {
      const auto row = static_cast<Eigen::Index>(at - free.begin());
      f.sigma = std::sqrt(std::max(0.0, solved.covariance(row, row))) * p.prior;
    } else {
      f.held = true;
      for (const auto& [index, why] : known.held)
        if (index == k) f.why = why;
    }
    fit.parameters.push_back(std::move(f));
  }
  return fit;
}

std::vector<Pose> suggest_poses(const BelievedMachine& machine, const std::vector<GeometryReading>& present,
                                const std::vector<Pose>& candidates, std::size_t count, double sigma_mm,
                                const GeometryFitOptions& options) {
  const auto information = [&](const std::vector<GeometryReading>& readings) {
    const GeometryModel model(machine, readings);
    const auto jacobian = model.jacobian(model.start());
    std::vector<std::size_t> list;
    for (std::size_t k = 0; k < model.parameters().size(); ++k)
      if (model.parameters()[k].machine && asked_for(model.parameters()[k], options, false))
        list.push_back(k);
    return jacobian ? scaled_columns(model, *jacobian, list) : Eigen::MatrixXd();
  };
  std::vector<GeometryReading> points;
  for (const GeometryReading& r : present)
    if (r.kind == GeometryReading::Kind::kPoint) points.push_back(r);
  std::vector<GeometryReading> possible;
  for (const Pose& pose : candidates) {
    GeometryReading r;
    r.commanded = pose;
    r.sigma_mm = sigma_mm;
    possible.push_back(r);
  }
  const Eigen::MatrixXd rows = information(possible);
  std::vector<Pose> out;
  if (rows.rows() == 0) return out;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(rows.cols(), rows.cols());
  const auto take = [&](const Eigen::MatrixXd& block) {
    const Eigen::MatrixXd gain = covariance * block.transpose();
    const Eigen::MatrixXd inner = Eigen::MatrixXd::Identity(block.rows(), block.rows()) + block * gain;
    covariance -= gain * inner.ldlt().solve(gain.transpose());
  };
  if (!points.empty())
    if (const Eigen::MatrixXd known = information(points); known.rows() > 0) take(known);
  std::vector<bool> used(possible.size(), false);
  while (out.size() < std::min(count, possible.size())) {
    double best = -1;
    std::size_t best_at = 0;
    for (std::size_t i = 0; i < possible.size(); ++i) {
      if (used[i]) continue;
      const Eigen::MatrixXd block = rows.middleRows(3 * static_cast<Eigen::Index>(i), 3);
      const Eigen::Matrix3d inner = Eigen::Matrix3d::Identity() + block * covariance * block.transpose();
      const double gain = inner.determinant();
      if (gain > best) {
        best = gain;
        best_at = i;
      }
    }
    used[best_at] = true;
    take(rows.middleRows(3 * static_cast<Eigen::Index>(best_at), 3));
    out.push_back(candidates[best_at]);
  }
  return out;
}

}  // namespace kinebus
