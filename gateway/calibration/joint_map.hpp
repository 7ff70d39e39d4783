#pragma once
// g(q) = q - e(q) of a joint's calibration, twice continuously differentiable, and its inverse.

#include <limits>
#include <vector>

#include "gateway/calibration/joint_calibration.hpp"

namespace kinebus {

class JointMap {
 public:
  explicit JointMap(const JointCalibration& calibration);

  struct Value {
    double g = 0, g1 = 1, g2 = 0;  ///< g(q), dg/dq, d2g/dq2
  };
  Value at(double q) const;
  double to_drive(double q) const { return at(q).g; }
  /// The q with g(q) = drive. The errors' slope is far below 1, so it exists and is one.
  double to_joint(double drive) const;

  /// A span of motion may go this far and still be seen by its ends and its middle.
  double longest_step() const { return longest_step_; }
  double largest_slope() const { return slope_; }          ///< of e, an upper bound
  double largest_curvature() const { return curvature_; }  ///< of e, an upper bound, per joint unit

 private:
  struct Spline {
    double start = 0, step = 0;
    std::vector<double> value, bend;  ///< at the knots: e and e''
    Value at(double q) const;         ///< e, e', e''
  };
  double wave_ = 0, sine_ = 0, cosine_ = 0;  ///< 2 pi / pitch, amplitudes
  Spline spline_;
  double longest_step_ = std::numeric_limits<double>::infinity();
  double slope_ = 0, curvature_ = 0;
};

}  // namespace kinebus
