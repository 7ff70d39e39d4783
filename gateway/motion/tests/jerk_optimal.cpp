#include "gateway/motion/tests/jerk_optimal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kinebus::probe {
namespace {

// Of the jerk limits and the joints'; the planner leaves as much to quantisation.
constexpr double kJerkShare = 0.98;
constexpr double kNoBound = 1e12;
constexpr int kLeastSteps = 6;   // of a piece
constexpr double kGrowth = 1.5;  // from step to step on the grid
constexpr double kBarrierFall = 0.25;
constexpr int kMostSteps = 400;

using Triple = std::array<double, 3>;  // coefficients of x, x', x'', or of three neighbours

/// |rows . (x, x', x'')| <= limit, or limit / sqrt(x).
struct Bound {
  std::array<Triple, 3> rows{};
  int count = 1;
  double limit = 0;
  bool by_speed = false;
};

struct GridNode {
  double s = 0;  ///< from the start of the path
  double cap = kNoBound;
  std::vector<Bound> bounds;
};

bool one_piece(const PathPiece& a, const PathPiece& b) {
  return a.coefficients == b.coefficients && a.length == b.length && a.arc == b.arc &&
         a.angle0_rad == b.angle0_rad;
}

class JerkProblem {
 public:
  JerkProblem(const Kinematics& kinematics, const MotionLimits& limits)
      : kinematics_(&kinematics), limits_(&limits) {}

  void add(const PathPiece& piece, double feed, double grid_mm, bool jumps) {
    std::vector<double> steps;
    // Finer towards the ends, where neighbours may be short.
    const double most = std::min(grid_mm, piece.length / kLeastSteps);
    double least = std::min(most, last_step_ * kGrowth), at = 0;
    const double fine = std::min(most, std::max(grid_mm / 10, 1e-3));
    while (at < piece.length * (1 - 1e-9)) {
      const double left = piece.length - at;
      double step = std::min({least, most, std::max(fine, left * (1 - 1 / kGrowth))});
      if (step > left * 0.7) step = left;
      steps.push_back(step);
      at += step;
      least = step * kGrowth;
    }
    last_step_ = std::max(steps.back(), fine);
    at = 0;
    const PosePoint start = piece.evaluate(0);
    if (!nodes_.empty())
      merge_into_last(piece, start, feed, jumps);
    else
      nodes_.push_back(node(piece, 0, feed, 0));
    const double s0 = nodes_.back().s;
    for (const double step : steps) {
      at += step;
      nodes_.push_back(node(piece, std::min(at, piece.length), feed, s0 + at));
    }
    bend_ = piece.evaluate(piece.length).x2;
  }

  JerkOptimum solve() {
    const std::size_t n = nodes_.size();
    x_.assign(n, 0.0);
    JerkOptimum result;
    result.points = n;
    if (n < 3) return result;
    leave_rest(nodes_[0], nodes_[1]);
    leave_rest(nodes_[n - 1], nodes_[n - 2]);
    stencils();
    // Any positive profile is feasible once it is slow enough.
    double slow = 1;
    for (;; slow *= 0.25) {
      for (std::size_t i = 1; i + 1 < n; ++i) {
        const double ends = std::min(nodes_[i].s, nodes_.back().s - nodes_[i].s);
        x_[i] = slow * std::pow(std::min(ends, 1.0), 4.0 / 3) * 1000;
      }
      if (std::isfinite(merit(x_, 1))) break;
      if (slow < 1e-20) return result;
    }
    double weight = 1e-3 * time(x_) / static_cast<double>(n);
    std::vector<double> next(n);
    while (result.steps < kMostSteps) {
      const double decrement = newton(weight);
      ++result.steps;
      double share = 1;
      const double before = merit(x_, weight);
      bool better = false;
      for (int k = 0; k < 60 && !better; ++k, share *= 0.5) {
        for (std::size_t i = 0; i < n; ++i) next[i] = x_[i] + share * step_[i];
        const double after = merit(next, weight);
        better = after <= before - 1e-4 * share * decrement;
      }
      if (better) x_ = next;
      const double barriers = weight * static_cast<double>(bounds_);
      result.gap = barriers / time(x_);
      if (!better || decrement < 0.3 * barriers) {
        if (result.gap < 1e-3) break;
        weight *= kBarrierFall;
      }
    }
    result.time_s = time(x_);
    return result;
  }

 private:
  GridNode node(const PathPiece& piece, double at, double feed, double s) {
    GridNode node;
    node.s = s;
    add_bounds(piece, at, feed, node);
    return node;
  }

  void merge_into_last(const PathPiece& piece, const PosePoint& start, double feed, bool jumps) {
    GridNode& last = nodes_.back();
    add_bounds(piece, 0, feed, last);
    if (!jumps) return;
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) square += (start.x2[i] - bend_[i]) * (start.x2[i] - bend_[i]);
    if (square > 0)
      last.cap = std::min(last.cap, kCurvatureJump_s * limits_->tool_jerk_mm_per_s3 / std::sqrt(square));
    PosePoint before = start;
    before.x2 = bend_;
    JointPoint q_before, q_after;
    (void)kinematics_->inverse_along(piece.frame, before, q_before);
    (void)kinematics_->inverse_along(piece.frame, start, q_after);
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_->joint_count()); ++j) {
      const double jump = std::abs(q_after.q2[j] - q_before.q2[j]);
      if (jump > 1e-9)
        last.cap = std::min(last.cap, kCurvatureJump_s * limits_->joint_jerk_per_s3[j] * kJerkShare / jump);
    }
  }

  void add_bounds(const PathPiece& piece, double at, double feed, GridNode& node) {
    const double e = std::min(1e-4, piece.length / 4);
    const double low = std::max(0.0, at - e), high = std::min(piece.length, at + e);
    PosePoint p = piece.evaluate(at), before = piece.evaluate(low), after = piece.evaluate(high);
    JointPoint q, q_before, q_after;
    (void)kinematics_->inverse_along(piece.frame, p, q);
    (void)kinematics_->inverse_along(piece.frame, before, q_before);
    (void)kinematics_->inverse_along(piece.frame, after, q_after);
    const auto cap = [&](double rate, double speed) {
      if (std::abs(rate) > 1e-12) node.cap = std::min(node.cap, speed * speed / (rate * rate));
    };
    cap(std::sqrt(p.x1[0] * p.x1[0] + p.x1[1] * p.x1[1] + p.x1[2] * p.x1[2]),
        std::min(feed, limits_->tool_speed_mm_per_s));
    Bound tool, jerk;
    tool.count = jerk.count = 3;
    tool.limit = limits_->tool_accel_mm_per_s2;
    jerk.limit = limits_->tool_jerk_mm_per_s3 * kJerkShare;
    jerk.by_speed = true;
    const auto third = piece.third_derivative(at);
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      tool.rows[i] = {p.x2[i], 0.5 * p.x1[i], 0};
      jerk.rows[i] = {third[i], 1.5 * p.x2[i], 0.5 * p.x1[i]};
      size += std::abs(p.x1[i]) + std::abs(p.x2[i]);
    }
    if (size > 1e-9) {
      node.bounds.push_back(tool);
      node.bounds.push_back(jerk);
    }
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      cap(p.x1[i], limits_->axis_speed_per_s[i]);
      put({p.x2[i], 0.5 * p.x1[i], 0}, limits_->axis_accel_per_s2[i], false, node);
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_->joint_count()); ++j) {
      cap(q.q1[j], limits_->joint_speed_per_s[j] * kJerkShare);
      put({q.q2[j], 0.5 * q.q1[j], 0}, limits_->joint_accel_per_s2[j] * kJerkShare, false, node);
      const double q3 = (q_after.q2[j] - q_before.q2[j]) / (high - low);
      put({q3, 1.5 * q.q2[j], 0.5 * q.q1[j]}, limits_->joint_jerk_per_s3[j] * kJerkShare, true, node);
    }
  }

  static void put(const Triple& row, double limit, bool by_speed, GridNode& node) {
    if (!std::isfinite(limit)) return;
    if (std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]) < 1e-12) return;
    Bound bound;
    bound.rows[0] = row;
    bound.limit = limit;
    bound.by_speed = by_speed;
    node.bounds.push_back(bound);
  }

  /// From rest without acceleration: s = j t^3 / 6 up to the next point.
  static void leave_rest(const GridNode& end, GridNode& next) {
    double jerk = kNoBound;
    for (const Bound& bound : end.bounds) {
      double size2 = 0;
      for (const Triple& row : bound.rows) size2 += row[2] * row[2];
      if (bound.by_speed && size2 > 0) jerk = std::min(jerk, 0.5 * bound.limit / std::sqrt(size2));
    }
    const double way = std::abs(next.s - end.s);
    next.cap = std::min(next.cap, 0.25 * jerk * jerk * std::pow(6 * way / jerk, 4.0 / 3));
  }

  /// Rows become coefficients of the three neighbouring unknowns.
  void stencils() {
    bounds_ = 0;
    for (std::size_t i = 1; i + 1 < nodes_.size(); ++i) {
      GridNode& node = nodes_[i];
      const double a = node.s - nodes_[i - 1].s, b = nodes_[i + 1].s - node.s;
      const Triple d1{-b / (a * (a + b)), (b - a) / (a * b), a / (b * (a + b))};
      const Triple d2{2 / (a * (a + b)), -2 / (a * b), 2 / (b * (a + b))};
      for (Bound& bound : node.bounds) {
        for (int r = 0; r < bound.count; ++r) {
          Triple& row = bound.rows[static_cast<std::size_t>(r)];
          const Triple c = row;
          for (std::size_t k = 0; k < 3; ++k)
            row[k] = (c[1] * d1[k] + c[2] * d2[k] + (k == 1 ? c[0] : 0)) / bound.limit;
        }
        bound.limit = 1;
      }
      bounds_ += node.bounds.size() + 2;
    }
  }

  double time(const std::vector<double>& x) const {
    double t = 0;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i)
      t += 2 * (nodes_[i + 1].s - nodes_[i].s) / (std::sqrt(x[i]) + std::sqrt(x[i + 1]));
    return t;
  }

  double merit(const std::vector<double>& x, double weight) const {
    double logs = 0;
    for (std::size_t i = 1; i + 1 < nodes_.size(); ++i) {
      const GridNode& node = nodes_[i];
      if (!(x[i] > 0) || !(x[i] < node.cap)) return INFINITY;
      logs -= std::log(x[i]) + std::log1p(-x[i] / node.cap);
      for (const Bound& bound : node.bounds) {
        double u2 = 0;
        for (int r = 0; r < bound.count; ++r) {
          const Triple& row = bound.rows[static_cast<std::size_t>(r)];
          const double u = row[0] * x[i - 1] + row[1] * x[i] + row[2] * x[i + 1];
          u2 += u * u;
        }
        const double slack = (bound.by_speed ? 1 / x[i] : 1) - u2;
        if (!(slack > 0)) return INFINITY;
        logs -= std::log(bound.by_speed ? slack * x[i] : slack);
      }
    }
    return time(x) + weight * logs;
  }

  /// Newton's direction into step_; the decrease that its model promises.
  double newton(double weight) {
    const std::size_t n = nodes_.size();
    g_.assign(n, 0.0);
    d0_.assign(n, 0.0);
    d1_.assign(n, 0.0);
    d2_.assign(n, 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double h = 2 * (nodes_[i + 1].s - nodes_[i].s);
      const double p = std::sqrt(x_[i]), q = std::sqrt(x_[i + 1]), sum = p + q;
      // t = h / (p + q)
      const double dp = p > 0 ? 0.5 / p : 0, dq = q > 0 ? 0.5 / q : 0;
      g_[i] -= h / (sum * sum) * dp;
      g_[i + 1] -= h / (sum * sum) * dq;
      const double s3 = 2 * h / (sum * sum * sum), s2 = h / (sum * sum);
      if (p > 0) d0_[i] += s3 * dp * dp + s2 * 0.25 / (p * p * p);
      if (q > 0) d0_[i + 1] += s3 * dq * dq + s2 * 0.25 / (q * q * q);
      d1_[i] += s3 * dp * dq;
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const GridNode& node = nodes_[i];
      const double x = x_[i], room = node.cap - x;
      g_[i] += weight * (1 / room - 1 / x);
      d0_[i] += weight * (1 / (room * room) + 1 / (x * x));
      for (const Bound& bound : node.bounds) {
        // -log(r^2 - |u|^2) with r as a tangent: 1, or 1 / sqrt(x).
        const double r = bound.by_speed ? 1 / std::sqrt(x) : 1, slope = bound.by_speed ? -0.5 * r / x : 0;
        double u2 = 0;
        Triple grad{0, -2 * r * slope, 0};
        std::array<Triple, 3> hess{};
        hess[1][1] = -2 * slope * slope;
        for (int k = 0; k < bound.count; ++k) {
          const Triple& row = bound.rows[static_cast<std::size_t>(k)];
          const double u = row[0] * x_[i - 1] + row[1] * x + row[2] * x_[i + 1];
          u2 += u * u;
          for (std::size_t a = 0; a < 3; ++a) {
            grad[a] += 2 * u * row[a];
            for (std::size_t b = a; b < 3; ++b) hess[a][b] += 2 * row[a] * row[b];
          }
        }
        const double inverse = 1 / (r * r - u2);
        for (std::size_t a = 0; a < 3; ++a) grad[a] *= inverse;
        for (std::size_t a = 0; a < 3; ++a) {
          g_[i - 1 + a] += weight * grad[a];
          for (std::size_t b = a; b < 3; ++b) {
            const double h = weight * (grad[a] * grad[b] + hess[a][b] * inverse);
            (b == a ? d0_ : b == a + 1 ? d1_ : d2_)[i - 1 + a] += h;
          }
        }
        if (bound.by_speed) {
          // The logarithm was of slack * x.
          g_[i] -= weight / x;
          d0_[i] += weight / (x * x);
        }
      }
    }
    // Ends are at rest. Banded L D L^T.
    step_.assign(n, 0.0);
    l1_.assign(n, 0.0);
    l2_.assign(n, 0.0);
    std::vector<double>& d = d0_;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      if (i > 1) {
        d[i] -= l1_[i - 1] * l1_[i - 1] * d[i - 1];
      }
      if (i > 2) d[i] -= l2_[i - 2] * l2_[i - 2] * d[i - 2];
      double off1 = i + 2 < n ? d1_[i] : 0;
      if (i > 1) off1 -= l2_[i - 1] * l1_[i - 1] * d[i - 1];
      l1_[i] = off1 / d[i];
      l2_[i] = (i + 3 < n ? d2_[i] : 0) / d[i];
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      step_[i] = -g_[i];
      if (i > 1) step_[i] -= l1_[i - 1] * step_[i - 1];
      if (i > 2) step_[i] -= l2_[i - 2] * step_[i - 2];
    }
    for (std::size_t i = 1; i + 1 < n; ++i) step_[i] /= d[i];
    for (std::size_t i = n - 1; i-- > 1;) {
      if (i + 2 < n) step_[i] -= l1_[i] * step_[i + 1];
      if (i + 3 < n) step_[i] -= l2_[i] * step_[i + 2];
    }
    double decrement = 0;
    for (std::size_t i = 1; i + 1 < n; ++i) decrement -= g_[i] * step_[i];
    return decrement;
  }

  const Kinematics* kinematics_;
  const MotionLimits* limits_;
  std::vector<GridNode> nodes_;
  double last_step_ = 1e-3;
  Pose bend_{};
  std::size_t bounds_ = 0;
  std::vector<double> x_, g_, d0_, d1_, d2_, l1_, l2_, step_;
};

}  // namespace

JerkOptimum jerk_optimal(const Kinematics& kinematics, const MotionLimits& limits,
                         const std::vector<Phase>& phases,
                         const std::function<double(std::uint32_t line)>& feed_mm_per_s, double grid_mm,
                         bool jumps) {
  JerkOptimum all;
  JerkProblem problem(kinematics, limits);
  const PathPiece* before = nullptr;
  const auto solve = [&] {
    const JerkOptimum part = problem.solve();
    all.time_s += part.time_s;
    all.points += part.points;
    all.steps = std::max(all.steps, part.steps);
    all.gap = std::max(all.gap, part.gap);
    problem = JerkProblem(kinematics, limits);
  };
  for (const Phase& phase : phases) {
    const bool rests = before != nullptr && phase.v0 == 0 && phase.s0 == 0;
    if (rests) solve();
    if (rests || before == nullptr || !one_piece(*before, phase.piece))
      problem.add(phase.piece, feed_mm_per_s(phase.line), grid_mm, jumps);
    before = &phase.piece;
  }
  solve();
  return all;
}

}  // namespace kinebus::probe
