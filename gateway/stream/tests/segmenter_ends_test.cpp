// The segmenter where a run begins, ends, or was left in its midst, and with axes and spans that are unusual.
#include <gtest/gtest.h>

#include <cmath>

#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

constexpr double kUnit = kSecondsPerUnit;

NodeAxes one_axis() {
  NodeAxes node;
  node.axes[0].joint = 0;
  return node;
}

struct Followed {
  double worst = 0;       ///< counts, of the first axis
  double last_worst = 0;  ///< the same behind the first 50 ms
  std::size_t segments = 0;
};

/// Streams the spans and compares at 8 places of each segment.
Followed follow(Segmenter& segmenter, const std::vector<JointSpan>& spans, AxisState from) {
  segmenter.start({from, AxisState{}});
  EXPECT_EQ(segmenter.start_offset_counts(), 0);
  EXPECT_FALSE(segmenter.next()) << "nothing was pushed";
  Followed f;
  std::size_t k = 0, span = 0;
  const AxisScaling& axis = segmenter.node().axes[0];
  while (!segmenter.ended()) {
    while (k < spans.size() && segmenter.has_room()) segmenter.push(spans[k++]);
    const auto s = segmenter.next();
    if (!s) continue;
    ++f.segments;
    EXPECT_EQ(s->start[1].velocity, 0);
    for (int i = 0; i <= 8; ++i) {
      const std::int64_t ticks = static_cast<std::int64_t>(s->duration) * kPathTicksPerUnit * i / 8;
      const double t =
          (static_cast<double>(s->start_units) + static_cast<double>(ticks) / kPathTicksPerUnit) * kUnit;
      while (span + 1 < spans.size() && spans[span + 1].start_s <= t) ++span;
      while (span > 0 && spans[span].start_s > t) --span;
      const double x = std::min(t - spans[span].start_s, spans[span].duration_s);
      const double is =
          to_counts(position_at(s->start[0], s->acceleration[0], ticks, kDefaultAccelerationShift));
      const double off = std::abs(is - axis.to_counts(spans[span].position(0, x)));
      f.worst = std::max(f.worst, off);
      if (t > 0.05) f.last_worst = std::max(f.last_worst, off);
    }
  }
  EXPECT_EQ(segmenter.states()[0].velocity, 0);
  return f;
}

AxisState standing(const NodeAxes& node, const JointSpan& span, double off = 0) {
  return {to_fixed(node.axes[0].to_counts(span.position(0, 0)) + off), 0};
}

TEST(Segmenter, AnOffsetAtTheStartIsTakenBackAndIsNoLooseFit) {
  for (const double off : {-3.5, -0.7, 0.0, 0.3, 2.5, 4.0}) {
    Segmenter segmenter(one_axis());
    const auto spans = trapezoid_spans(3000, 100, 0.2);
    const Followed f = follow(segmenter, spans, standing(segmenter.node(), spans[0], off));
    EXPECT_NEAR(segmenter.start_offset_counts(), std::abs(off), 1e-6);
    EXPECT_LE(f.worst, std::max(0.5, 1.11 * std::abs(off)));
    EXPECT_LE(f.last_worst, 0.5) << off;
    EXPECT_EQ(segmenter.counters().loose, 0u) << off;
    EXPECT_LE(f.segments, off == 0 ? 5u : 16u) << off;
    EXPECT_GT(segmenter.counters().worst_ratio, 0);
    EXPECT_EQ(segmenter.counters().segments, f.segments);
  }
}

TEST(Segmenter, ARunThatWasLeftInItsMidstLeavesNothingToTheNext) {
  const auto spans = trapezoid_spans(3000, 100, 0.4);
  const auto curve = sample(*m1(), smooth_curve(2, {.seconds = 3, .tilt_rad = 0.3, .turn_rad = 0.5}));
  for (int given = 0; given < 60; given += 7) {
    Segmenter used(one_axis()), fresh(one_axis());
    used.start({standing(used.node(), curve[0], 3), AxisState{}});
    std::size_t k = 0;
    for (int n = 0; n < given;) {
      while (k < curve.size() && used.has_room()) used.push(curve[k++]);
      n += used.next() ? 1 : 0;
    }
    const Followed again = follow(used, spans, standing(used.node(), spans[0]));
    const Followed first = follow(fresh, spans, standing(fresh.node(), spans[0]));
    EXPECT_EQ(again.segments, first.segments) << given;
    EXPECT_EQ(again.worst, first.worst) << given;
    EXPECT_NEAR(used.start_offset_counts(), 0, 1e-6) << given;
  }
}

TEST(Segmenter, ARunUnderALimitOfJerkLeavesNothingToTheNext) {
  const auto kinematics = m1();
  const auto eased = sample(*kinematics, eased_lines(*kinematics, 3, {.lines = 200}, 100'000));
  const auto plain = sample(*kinematics, printed_lines(3, {.lines = 100}));
  ASSERT_GT(eased.size(), 2 * Segmenter::kCapacity);
  Segmenter used(one_axis()), fresh(one_axis());
  (void)follow(used, eased, standing(used.node(), eased[0]));
  const std::uint64_t tries = used.counters().candidates;
  const Followed again = follow(used, plain, standing(used.node(), plain[0]));
  const Followed first = follow(fresh, plain, standing(fresh.node(), plain[0]));
  EXPECT_EQ(again.segments, first.segments);
  EXPECT_EQ(used.counters().candidates - tries, fresh.counters().candidates);
}

TEST(Segmenter, AnAxisWithoutALimitIsStreamedLikeAnyOther) {
  NodeAxes node = one_axis();
  node.axes[0].acceleration_limit = 0;
  const auto spans = sample(*m1(), printed_lines(9, {.lines = 60}));
  Segmenter segmenter(node);
  const Followed f = follow(segmenter, spans, standing(node, spans[0]));
  EXPECT_LE(f.worst, 0.5);
  EXPECT_EQ(segmenter.counters().loose, 0u);
}

TEST(Segmenter, AMotionOverTheLimitIsFollowedAllTheSame) {
  NodeAxes node = one_axis();
  node.axes[0].acceleration_limit = 2000;
  const auto spans = trapezoid_spans(3000, 100, 0.2);
  Segmenter segmenter(node);
  EXPECT_LE(follow(segmenter, spans, standing(node, spans[0])).worst, 0.5);
  EXPECT_EQ(segmenter.counters().loose, 0u);
}

/// More of them than there is room for in the look-ahead.
TEST(Segmenter, SpansOfATenthOfAMillisecondGoThrough) {
  std::vector<JointSpan> spans;
  const auto whole = trapezoid_spans(3000, 100, 0.2);
  for (const JointSpan& s : whole) {
    const int parts = static_cast<int>(std::lround(s.duration_s / 1e-4));
    for (int k = 0; k < parts; ++k) {
      JointSpan part = s;
      const double h = s.duration_s / parts, t = h * k;
      part.start_s = s.start_s + t;
      part.duration_s = h;
      part.coefficients[0] = {s.position(0, t), s.velocity(0, t), s.coefficients[0][2], 0};
      part.last = s.last && k + 1 == parts;
      spans.push_back(part);
    }
  }
  Segmenter segmenter(one_axis());
  const Followed f = follow(segmenter, spans, standing(segmenter.node(), spans[0]));
  EXPECT_LE(f.worst, 0.5);
  EXPECT_EQ(segmenter.counters().loose, 0u);
  EXPECT_LE(f.segments, 40u);
}

TEST(Segmenter, AWaveOfSpansAsDenseGoesThroughAllAlong) {
  for (const double part_s : {0.5e-4, 1e-4, 2e-4, 4e-4}) {
    constexpr double kWay = 12, kOmega = 12;  // up to 144 mm/s, 1,728 mm/s^2
    const auto q = [&](double t) { return 600 + kWay * (1 - std::cos(kOmega * t)); };
    const auto v = [&](double t) { return kWay * kOmega * std::sin(kOmega * t); };
    std::vector<JointSpan> spans;
    const double seconds = 4 * M_PI / kOmega;
    const int parts = static_cast<int>(seconds / part_s);
    const double h = seconds / parts;
    for (int k = 0; k < parts; ++k) {
      JointSpan s;
      s.start_s = k * h;
      s.duration_s = h;
      const double q0 = q(k * h), q1 = q((k + 1) * h), v0 = v(k * h), v1 = v((k + 1) * h),
                   mean = (q1 - q0) / h;
      s.coefficients[0] = {q0, v0, (3 * mean - 2 * v0 - v1) / h, (v0 + v1 - 2 * mean) / (h * h)};
      s.last = k + 1 == parts;
      spans.push_back(s);
    }
    Segmenter segmenter(one_axis());
    const Followed f = follow(segmenter, spans, standing(segmenter.node(), spans[0]));
    EXPECT_LE(f.worst, 0.5) << part_s;
    EXPECT_EQ(segmenter.counters().loose, 0u) << part_s;
    EXPECT_LE(f.segments, 200u) << part_s;
  }
}

TEST(Segmenter, ARunOfAnyLengthEndsAtRestAtItsPlace) {
  for (const double duration : {2e-6, 16e-6, 50e-6, 0.0005, 0.001, 0.003, 0.02}) {
    for (const double way : {0.0, 1e-5, 2e-4}) {
      JointSpan s;
      s.duration_s = duration;
      const double k = way / (duration * duration);
      s.coefficients[0] = {600, 0, 3 * k, -2 * k / duration};
      s.last = true;
      NodeAxes node = one_axis();
      node.axes[0].acceleration_limit = 0;
      Segmenter segmenter(node);
      const Followed f = follow(segmenter, {s}, standing(node, s));
      EXPECT_NEAR(to_counts(segmenter.states()[0].position), node.axes[0].to_counts(600 + way), 0.5)
          << duration << " " << way;
      EXPECT_LE(f.segments, 5u) << duration << " " << way;
      EXPECT_GE(segmenter.knot_units(), static_cast<std::int64_t>(std::floor(duration / kUnit)));
      EXPECT_LE(segmenter.knot_units(), static_cast<std::int64_t>(std::ceil(duration / kUnit)) + 65);
    }
  }
}

/// A run whose end asks for more than the axis can brake: it is fitted as well as can be, and told.
TEST(Segmenter, WhatNoFitBringsWithinToleranceIsCounted) {
  JointSpan s;
  s.duration_s = 0.05;
  s.coefficients[0] = {600, 0, 500, 0};  // still at 50 mm/s where it ends
  s.last = true;
  Segmenter segmenter(one_axis());
  (void)follow(segmenter, {s}, standing(segmenter.node(), s));
  EXPECT_GT(segmenter.counters().loose, 0u);
  EXPECT_GT(segmenter.counters().worst_ratio, 1);
}

}  // namespace
}  // namespace kinebus::testing
