#include "gateway/motion/tests/time_optimal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinebus::probe {
namespace {

constexpr double kFar = 1e15;

struct GridPoint {
  PosePoint pose;
  JointPoint joints;
  double step = 0;  ///< to the next point
};

struct Interval {
  double low = -kFar, high = kFar;
  bool empty() const { return low > high; }
};

class Reference {
 public:
  Reference(const Kinematics& kinematics, const MotionLimits& limits, double feed)
      : kinematics_(kinematics), limits_(limits), feed_(feed) {}

  void add_piece(const PathPiece& piece, double from, double to, double grid_mm) {
    const int steps = std::max(8, static_cast<int>(std::ceil((to - from) / grid_mm)));
    for (int i = 0; i < steps; ++i) add_point(piece, from + (to - from) * i / steps, (to - from) / steps);
  }
  void add_point(const PathPiece& piece, double s, double step) {
    GridPoint point;
    point.pose = piece.evaluate(s);
    point.step = step;
    (void)kinematics_.inverse_along(piece.frame, point.pose, point.joints);
    points_.push_back(point);
  }

  double solve() const {
    const std::size_t n = points_.size();
    std::vector<double> most(n, 0.0);  // controllable: greatest x from which the end is reached
    for (std::size_t i = n - 1; i-- > 0;) {
      const double twice = 2 * points_[i].step;
      double low = 0, high = speed_cap(points_[i]);
      const auto reaches = [&](double x) {
        const Interval a = accelerations(points_[i], x);
        return !a.empty() && x + twice * a.low <= most[i + 1];
      };
      if (reaches(high)) {
        most[i] = high;
        continue;
      }
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        (reaches(middle) ? low : high) = middle;
      }
      most[i] = low;
    }
    double x = 0, time = 0;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      const double twice = 2 * points_[i].step;
      const Interval a = accelerations(points_[i], x);
      const double next = std::clamp(x + twice * a.high, 0.0, most[i + 1]);
      time += twice / (std::sqrt(x) + std::sqrt(next));
      x = next;
    }
    return time;
  }

 private:
  double speed_cap(const GridPoint& point) const {
    double cap = kFar;
    const auto& x1 = point.pose.x1;
    const double tool = std::sqrt(x1[0] * x1[0] + x1[1] * x1[1] + x1[2] * x1[2]);
    const auto limit = [&](double rate, double speed) {
      if (std::abs(rate) > 1e-12) cap = std::min(cap, speed * speed / (rate * rate));
    };
    limit(tool, std::min(feed_, limits_.tool_speed_mm_per_s));
    for (std::size_t i = 0; i < kPoseAxes; ++i) limit(x1[i], limits_.axis_speed_per_s[i]);
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_.joint_count()); ++j) {
      limit(point.joints.q1[j], limits_.joint_speed_per_s[j]);
    }
    return cap;
  }

  static void linear(double second, double first, double limit, double x, Interval& a) {
    if (!std::isfinite(limit)) return;
    if (std::abs(first) < 1e-12) {
      if (std::abs(second) * x > limit) a = {1, -1};
      return;
    }
    const double one = (limit - second * x) / first, other = (-limit - second * x) / first;
    a.low = std::max(a.low, std::min(one, other));
    a.high = std::min(a.high, std::max(one, other));
  }

  Interval accelerations(const GridPoint& point, double x) const {
    Interval a;
    double w2 = 0, c = 0, k2 = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      w2 += point.pose.x1[i] * point.pose.x1[i];
      c += point.pose.x1[i] * point.pose.x2[i];
      k2 += point.pose.x2[i] * point.pose.x2[i];
    }
    const double accel = limits_.tool_accel_mm_per_s2;
    if (w2 > 1e-18) {
      const double root = c * c * x * x + w2 * (accel * accel - k2 * x * x);
      if (root < 0) return {1, -1};
      a.low = (-c * x - std::sqrt(root)) / w2;
      a.high = (-c * x + std::sqrt(root)) / w2;
    } else if (k2 * x * x > accel * accel) {
      return {1, -1};
    }
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      linear(point.pose.x2[i], point.pose.x1[i], limits_.axis_accel_per_s2[i], x, a);
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(kinematics_.joint_count()); ++j) {
      linear(point.joints.q2[j], point.joints.q1[j], limits_.joint_accel_per_s2[j], x, a);
    }
    return a;
  }

  const Kinematics& kinematics_;
  const MotionLimits& limits_;
  double feed_;
  std::vector<GridPoint> points_;
};

bool same_piece(const PathPiece& a, const PathPiece& b) {
  return a.coefficients == b.coefficients && a.length == b.length && a.arc == b.arc &&
         a.angle0_rad == b.angle0_rad;
}

}  // namespace

double time_optimal_s(const Kinematics& kinematics, const MotionLimits& limits,
                      const std::vector<Phase>& phases, double feed_mm_per_s, double grid_mm) {
  if (phases.empty()) return 0;
  Reference reference(kinematics, limits, feed_mm_per_s);
  for (std::size_t i = 0; i < phases.size(); ++i) {
    if (i > 0 && same_piece(phases[i].piece, phases[i - 1].piece)) continue;
    reference.add_piece(phases[i].piece, 0, phases[i].piece.length, grid_mm);
  }
  reference.add_point(phases.back().piece, phases.back().piece.length, 0);
  return reference.solve();
}

}  // namespace kinebus::probe
