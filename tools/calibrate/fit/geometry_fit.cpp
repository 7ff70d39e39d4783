#include "tools/calibrate/fit/geometry_fit.hpp"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "tools/calibrate/fit/robust.hpp"

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

/// All readings and their derivatives at one point, worked out once and then asked for row by row.
class Readings final : public ceres::EvaluationCallback {
 public:
  /// `x`: all parameters; the free ones are replaced by `scaled` times their prior, which Ceres moves.
  Readings(const GeometryModel& model, const std::vector<std::size_t>& free, std::vector<double> x)
      : model_(model), free_(free), x_(std::move(x)), scaled_(free.size()) {
    for (std::size_t k = 0; k < free_.size(); ++k)
      scaled_[k] = x_[free_[k]] / model_.parameters()[free_[k]].prior;
  }
  void PrepareForEvaluation(bool jacobians, bool) override {
    const std::vector<double> at = x();
    residuals_ = model_.residuals(at);
    if (!jacobians || !residuals_) return;
    const auto all = model_.jacobian(at);
    if (all) jacobian_ = scaled_columns(model_, *all, free_);
    if (!all) residuals_.reset();
  }
  std::vector<double> x() const {
    std::vector<double> out = x_;
    for (std::size_t k = 0; k < free_.size(); ++k)
      out[free_[k]] = scaled_[k] * model_.parameters()[free_[k]].prior;
    return out;
  }
  double* scaled() { return scaled_.data(); }
  int size() const { return static_cast<int>(free_.size()); }
  /// nullopt: out of the machine's reach.
  const std::optional<std::vector<double>>& residuals() const { return residuals_; }
  const RowMajor& jacobian() const { return jacobian_; }

 private:
  const GeometryModel& model_;
  const std::vector<std::size_t>& free_;
  std::vector<double> x_, scaled_;
  std::optional<std::vector<double>> residuals_;
  RowMajor jacobian_;
};

/// One row: a cost of its own, so that Huber's loss sees it alone.
class ReadingCost final : public ceres::CostFunction {
 public:
  ReadingCost(const Readings& readings, std::size_t row) : readings_(readings), row_(row) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(readings.size());
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    if (!readings_.residuals()) return false;
    residuals[0] = (*readings_.residuals())[row_];
    if (jacobians != nullptr && jacobians[0] != nullptr)
      std::copy_n(readings_.jacobian().data() + row_ * static_cast<std::size_t>(readings_.size()),
                  readings_.size(), jacobians[0]);
    return true;
  }

 private:
  const Readings& readings_;
  std::size_t row_;
};

struct Solved {
  bool ok = false;
  Eigen::MatrixXd covariance;  // of the free parameters, scaled
  std::size_t outliers = 0;
  int steps = 0;
};

/// Least squares on the free parameters with Huber's loss, `x` moves. A weak prior keeps what is known badly
/// near 0. The scale of the noise comes from the readings, so the loss is set anew until it stays.
Solved descend(const GeometryModel& model, const std::vector<std::size_t>& free, std::vector<double>& x) {
  constexpr int kRounds = 20;
  constexpr double kSettled = 1e-4;  // of the scale
  Solved s;
  Readings readings(model, free, x);
  readings.PrepareForEvaluation(false, true);
  if (!readings.residuals()) return s;
  const int n = readings.size();
  ceres::LossFunctionWrapper loss(nullptr, ceres::TAKE_OWNERSHIP);
  ceres::Problem::Options sharing;
  sharing.evaluation_callback = &readings;
  sharing.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(sharing);
  for (std::size_t row = 0; row < model.residual_count(); ++row)
    problem.AddResidualBlock(new ReadingCost(readings, row), &loss, readings.scaled());
  problem.AddResidualBlock(new ceres::NormalPrior(Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n)),
                           nullptr, readings.scaled());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.function_tolerance = 1e-9;
  options.max_num_iterations = 40;
  double sigma = 0;
  for (int round = 0; round < kRounds; ++round) {
    const double now = std::max(1.0, robust_sigma(*readings.residuals()));
    if (std::abs(now - sigma) <= kSettled * sigma) break;
    sigma = now;
    loss.Reset(new ceres::HuberLoss(kHuberBound * sigma), ceres::TAKE_OWNERSHIP);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable()) return s;
    s.steps += static_cast<int>(summary.iterations.size()) - 1;
    readings.PrepareForEvaluation(false, true);
    if (!readings.residuals()) return s;
  }
  for (const double r : *readings.residuals()) s.outliers += huber_weight(r, sigma) < 0.5 ? 1 : 0;
  ceres::Covariance::Options dense;
  dense.algorithm_type = ceres::DENSE_SVD;
  ceres::Covariance covariance(dense);
  const std::vector<const double*> block{readings.scaled()};
  RowMajor matrix(n, n);
  if (!covariance.Compute(block, &problem) || !covariance.GetCovarianceMatrix(block, matrix.data())) return s;
  s.covariance = sigma * sigma * matrix;
  x = readings.x();
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
