#pragma once
// From a rail's measured travel to its calibration: scale, backlash, the error of each turn, and what is
// left.

#include <span>
#include <vector>

#include "gateway/calibration/joint_calibration.hpp"

namespace kinebus {

/// One reading at rest. `commanded`: by the drive train alone (no calibration) from the home switch on, mm or
/// rad.
struct RailSample {
  double commanded = 0, measured = 0;
  int direction = 1;  ///< +1: came there in positive direction, -1: back
};

struct RailFitOptions {
  double anchor = 0;     ///< where drive and joint agree: the home switch's position
  double pitch = 0;      ///< look for an error of this period; 0: none
  int table_points = 0;  ///< 0: no table; else a spline through so many places over the measured travel
};

struct RailFit {
  JointCalibration calibration;  ///< scale, backlash, periodic, table; offset stays 0: a length has no zero
  double zero = 0;               ///< of the measuring device against the drive train, mm or rad
  double scale_sigma = 0;        ///< standard deviation of the scale
  double before_rms = 0;         ///< measured - commanded, best zero taken out
  double after_rms = 0;
  std::vector<double> before, after;  ///< of each sample
  std::size_t outliers = 0;           ///< readings that the robust fit trusts less than half
  bool has_both_directions = false;   ///< else backlash cannot be told, and is 0
};

/// Robust (Huber) linear least squares of measured = q + zero, q = anchor +
/// (commanded - anchor) (1 + scale) + e(q) - side backlash / 2.
/// Fewer than three samples, or samples at one place only: all zero, `after` = `before`.
/// By Eigen, not Ceres: the model is linear, and Eigen shares a value between columns that cannot be told
/// apart.
RailFit fit_rail(std::span<const RailSample> samples, const RailFitOptions& options);

}  // namespace kinebus
