#pragma once
// What other encodings would take for the same joint motion: cubics between exact positions and velocities,
// one frame an axis, with knots of its own for every axis.

#include <cstddef>
#include <vector>

#include "gateway/motion/joint_span.hpp"
#include "gateway/stream/axis_scaling.hpp"

namespace kinebus::bench {

struct CubicEncoding {
  double tolerance_counts = 0.45;
  double grid_s = 16e-6;  ///< knots are multiples of this
  double longest_s = 0.131;
};
/// Frames for one axis: greedy, the longest cubic Hermite within tolerance, by 24 samples in each span it
/// covers.
std::size_t cubic_frames(const std::vector<JointSpan>& spans, const AxisScaling& axis,
                         const CubicEncoding& encoding);

}  // namespace kinebus::bench
