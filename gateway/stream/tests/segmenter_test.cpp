#include "gateway/stream/segmenter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"
#include "protocol/time.hpp"

namespace kinebus::testing {
namespace {

std::vector<FittedSegment> fit_all(Segmenter& segmenter, const std::vector<JointSpan>& spans,
                                   const std::array<AxisState, kAxesPerNode>& from) {
  segmenter.start(from);
  std::vector<FittedSegment> segments;
  std::size_t k = 0;
  while (!segmenter.ended()) {
    while (k < spans.size() && segmenter.has_room()) segmenter.push(spans[k++]);
    while (const auto segment = segmenter.next()) segments.push_back(*segment);
  }
  return segments;
}

struct Measured {
  double error_counts = 0;        ///< largest distance from the spans, at 16 places of every segment
  double acceleration_ratio = 0;  ///< largest acceleration over the axis' limit
  double asked_ratio = 0;         ///< the same of the spans themselves
  double excess = 0;              ///< how far accelerations leave those of the spans, over the limit
};

/// From outside: what a node does with the segments, against the spans.
Measured measure(const NodeAxes& node, const std::vector<JointSpan>& spans,
                 const std::vector<FittedSegment>& segments,
                 const std::array<AxisState, kAxesPerNode>& from) {
  Measured m;
  std::array<AxisState, kAxesPerNode> state = from;
  std::int64_t knot = 0;
  std::size_t first = 0;
  constexpr double u = kSecondsPerUnit;
  for (const FittedSegment& s : segments) {
    EXPECT_EQ(s.start_units, knot);
    EXPECT_EQ(s.start, state);
    EXPECT_GE(s.duration, 1);
    EXPECT_LE(s.duration, kMaxSegmentUnits);
    const double begin = static_cast<double>(knot) * u, end = static_cast<double>(knot + s.duration) * u;
    while (first + 1 < spans.size() && spans[first].start_s + spans[first].duration_s < begin) ++first;
    for (std::size_t i = 0; i < kAxesPerNode; ++i) {
      const AxisScaling& axis = node.axes[i];
      if (axis.joint < 0) {
        EXPECT_EQ(s.acceleration[i], 0);
        continue;
      }
      double least = 1e300, most = -1e300;
      for (int k = 0; k <= 16; ++k) {
        const std::int64_t ticks = static_cast<std::int64_t>(s.duration) * kPathTicksPerUnit * k / 16;
        const double t = begin + static_cast<double>(ticks) * u / static_cast<double>(kPathTicksPerUnit);
        std::size_t span = first;
        while (span + 1 < spans.size() && spans[span].start_s + spans[span].duration_s < t) ++span;
        const double x = std::min(t - spans[span].start_s, spans[span].duration_s);
        const double q = axis.to_counts(spans[span].position(axis.joint, x));
        const double is =
            to_counts(position_at(state[i], s.acceleration[i], ticks, kDefaultAccelerationShift));
        m.error_counts = std::max(m.error_counts, std::abs(q - is) / (axis.tolerance_counts / 0.5));
      }
      for (std::size_t k = first; k < spans.size() && spans[k].start_s <= end + u; ++k) {
        const auto& c = spans[k].coefficients[static_cast<std::size_t>(axis.joint)];
        for (const double x : {std::clamp(begin - spans[k].start_s, 0.0, spans[k].duration_s),
                               std::clamp(end - spans[k].start_s, 0.0, spans[k].duration_s)}) {
          least = std::min(least, 2 * c[2] + 6 * c[3] * x);
          most = std::max(most, 2 * c[2] + 6 * c[3] * x);
        }
      }
      m.asked_ratio = std::max(m.asked_ratio, std::max(most, -least) / axis.acceleration_limit);
      const double a = 2 * s.acceleration[i] * 4 / kCountFraction / (u * u) / axis.slope();
      m.acceleration_ratio = std::max(m.acceleration_ratio, std::abs(a) / axis.acceleration_limit);
      m.excess = std::max(m.excess, std::max(a - most, least - a) / axis.acceleration_limit);
      state[i] = advance(state[i], s.acceleration[i], s.duration, kDefaultAccelerationShift);
    }
    knot += s.duration;
  }
  for (const AxisState& s : state) EXPECT_EQ(s.velocity, 0);
  EXPECT_GE(static_cast<double>(knot) * u, spans.back().start_s + spans.back().duration_s - 1e-9);
  return m;
}

struct Outcome {
  Measured measured;
  double per_second = 0;
  std::size_t segments = 0;
  Segmenter::Counters counters;
};

Outcome stream(const NodeAxes& node, const std::vector<JointSpan>& spans) {
  Segmenter segmenter(node);
  const auto from = standing_at(node, spans.front());
  const auto segments = fit_all(segmenter, spans, from);
  Outcome o{measure(node, spans, segments, from), 0, segments.size(), segmenter.counters()};
  o.per_second = static_cast<double>(segments.size()) / (spans.back().start_s + spans.back().duration_s);
  return o;
}

TEST(Segmenter, PrintedLinesStayWithinHalfACountAndBelowTheAccelerationLimit) {
  const auto kinematics = m1();
  for (std::uint32_t seed = 1; seed <= 6; ++seed)
    for (const double length : {0.3, 1.0, 5.0, 40.0}) {
      const auto phases = printed_lines(seed, {.lines = static_cast<int>(300 / (1 + length)),
                                               .mean_length_mm = length,
                                               .speed_mm_per_s = 40 + 30.0 * seed});
      const auto spans = sample(*kinematics, phases);
      for (const NodeAxes& node : m1_axes()) {
        const Outcome o = stream(node, spans);
        EXPECT_LE(o.measured.error_counts, 0.5) << "seed " << seed << " length " << length;
        EXPECT_LE(o.measured.acceleration_ratio, 1.0) << "seed " << seed << " length " << length;
        EXPECT_EQ(o.counters.loose, 0u) << "seed " << seed << " length " << length;
      }
    }
}

/// 32,816 segments by 1.15 trials each; 33,353 by 1.35 if the first guess does not know what the end of a
/// bend leaves.
TEST(Segmenter, LinesUnderALimitOfJerkTakeFewSegmentsAndHardlyATrialTooMany) {
  const auto kinematics = m1();
  std::uint64_t segments = 0, candidates = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed)
    for (const double length : {0.3, 1.0, 5.0, 40.0}) {
      const auto phases = eased_lines(*kinematics, seed,
                                      {.lines = static_cast<int>(300 / (1 + length)),
                                       .mean_length_mm = length,
                                       .speed_mm_per_s = 20 + 30.0 * seed},
                                      100'000);
      ASSERT_FALSE(phases.empty());
      const auto spans = sample(*kinematics, phases);
      for (const NodeAxes& node : m1_axes()) {
        const Outcome o = stream(node, spans);
        EXPECT_LE(o.measured.error_counts, 0.5) << "seed " << seed << " length " << length;
        EXPECT_LE(o.measured.acceleration_ratio, 1.0) << "seed " << seed << " length " << length;
        EXPECT_EQ(o.counters.loose, 0u) << "seed " << seed << " length " << length;
        segments += o.counters.segments;
        candidates += o.counters.candidates;
      }
    }
  EXPECT_LE(segments, 33'100u);
  EXPECT_LE(static_cast<double>(candidates), 1.2 * static_cast<double>(segments));
}

TEST(Segmenter, CurvesInFiveAxesStayWithinHalfACount) {
  const auto kinematics = m1();
  for (std::uint32_t seed = 1; seed <= 4; ++seed)
    for (const double piece : {0.5, 4.0}) {
      const auto spans = sample(*kinematics, smooth_curve(seed, {.seconds = 3,
                                                                 .speed_mm_per_s = 60,
                                                                 .accel_mm_per_s2 = 1000,
                                                                 .piece_mm = piece,
                                                                 .tilt_rad = 0.4,
                                                                 .turn_rad = 1}));
      for (const NodeAxes& node : m1_axes()) {
        const Outcome o = stream(node, spans);
        EXPECT_LE(o.measured.error_counts, 0.5) << "seed " << seed;
        // No planner stands before these curves: at a lobe's tip seed 2 asks a carriage for 1.10 of its
        // limit.
        EXPECT_LE(o.measured.acceleration_ratio, std::max(1.0, o.measured.asked_ratio)) << "seed " << seed;
        EXPECT_EQ(o.counters.loose, 0u) << "seed " << seed;
      }
    }
}

TEST(Segmenter, FollowsRandomJumpsOfAcceleration) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    const auto spans = jumpy_spans(seed, 4000, 400);
    const Outcome o = stream(m1_axes()[0], spans);
    EXPECT_LE(o.measured.error_counts, 0.5) << "seed " << seed;
    EXPECT_LE(o.measured.acceleration_ratio, 1.0) << "seed " << seed;
    EXPECT_EQ(o.counters.loose, 0u) << "seed " << seed;
  }
}

TEST(Segmenter, NearTheLimitAccelerationsHardlyLeaveThoseOfTheMotion) {
  for (std::uint32_t seed = 1; seed <= 10; ++seed) {
    const auto spans = jumpy_spans(seed, 4900, 300);
    const Outcome o = stream(m1_axes()[0], spans);
    EXPECT_LE(o.measured.acceleration_ratio, 1.0) << "seed " << seed;
    EXPECT_LE(o.measured.error_counts, 0.5) << "seed " << seed;
  }
}

TEST(Segmenter, AStraightTrapezoidTakesThreeSegmentsAndOneToSettle) {
  NodeAxes node;
  node.axes[0].joint = 0;
  for (const double speed : {17.3, 60.0, 123.4, 299.0}) {
    const Outcome o = stream(node, trapezoid_spans(2990, speed, 0.1));
    EXPECT_LE(o.segments, 4u) << speed;
    EXPECT_LE(o.measured.error_counts, 0.5) << speed;
  }
}

TEST(Segmenter, ALongCruiseTakesTheLongestSegments) {
  NodeAxes node;
  node.axes[0].joint = 0;
  EXPECT_LE(stream(node, trapezoid_spans(3000, 50, 13.1)).segments, 105u);
}

TEST(Segmenter, APrintedLineTakesOneSegmentForEachPhase) {
  const auto kinematics = m1();
  const auto phases = printed_lines(5, {.lines = 400});
  const auto spans = sample(*kinematics, phases);
  for (const NodeAxes& node : m1_axes()) {
    const Outcome o = stream(node, spans);
    EXPECT_LE(static_cast<double>(o.segments), 1.1 * static_cast<double>(phases.size()));
  }
}

TEST(Segmenter, TakesBackAnOffsetAtTheRunsStart) {
  NodeAxes node;
  node.axes[0].joint = 0;
  const auto spans = trapezoid_spans(3000, 100, 0.2);
  auto from = standing_at(node, spans.front());
  from[0].position += to_fixed(2.5);
  Segmenter segmenter(node);
  const auto segments = fit_all(segmenter, spans, from);
  EXPECT_NEAR(segmenter.start_offset_counts(), 2.5, 1e-6);
  const double end = node.axes[0].to_counts(spans.back().position(0, spans.back().duration_s));
  EXPECT_NEAR(to_counts(segmenter.states()[0].position), end, 0.5);
  EXPECT_EQ(segmenter.states()[0].velocity, 0);
}

TEST(Segmenter, AReversedAxisMirrorsTheMotion) {
  NodeAxes node;
  node.axes[0].joint = 0;
  node.axes[0].reversed = true;
  node.axes[0].scale_correction = 0.0014;
  node.axes[0].offset = 530;
  const Outcome o = stream(node, trapezoid_spans(2900, 80, 0.1));
  EXPECT_LE(o.measured.error_counts, 0.5);
}

TEST(Segmenter, AnUnusedAxisNeverMoves) {
  const auto spans = jumpy_spans(9, 3000, 100);
  NodeAxes node;
  node.axes[1].joint = 1;
  Segmenter segmenter(node);
  auto from = standing_at(node, spans.front());
  from[0].position = to_fixed(12'345.25);
  for (const FittedSegment& s : fit_all(segmenter, spans, from)) EXPECT_EQ(s.acceleration[0], 0);
  EXPECT_EQ(segmenter.start_offset_counts(), 0);
  EXPECT_EQ(segmenter.states()[0], from[0]);
}

TEST(Segmenter, WaitsForItsLookAheadAndNoLonger) {
  Segmenter segmenter(m1_axes()[0]);
  JointSpan span;
  span.duration_s = 0.05;
  for (std::size_t j = 0; j < 2; ++j) span.coefficients[j] = {700, 0, 0, 0};
  std::array<AxisState, kAxesPerNode> from{};
  for (AxisState& s : from) s.position = to_fixed(700 * 1280);
  segmenter.start(from);
  int pushed = 0;
  for (; pushed < 20 && !segmenter.next(); ++pushed) {
    segmenter.push(span);
    span.start_s += span.duration_s;
  }
  EXPECT_EQ(pushed, 8);  // 393 ms in spans of 50 ms
}

}  // namespace
}  // namespace kinebus::testing
