// What the segmenter's choices are for: few frames, found with few tries, by accelerations that the motion
// has.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

struct Taken {
  double segments = 0, tries = 0;
};

/// A motion of stream_bench, and what it took on each node when the segmenter's numbers were chosen.
struct Motion {
  const char* name;
  std::vector<std::vector<Phase>> runs;
  std::array<Taken, 3> took;
};

/// Each line a run of its own, from rest to rest.
std::vector<std::vector<Phase>> single_lines() {
  std::vector<std::vector<Phase>> runs;
  for (std::uint32_t seed = 1; seed <= 400; ++seed)
    runs.push_back(printed_lines(seed, {.lines = 1 + static_cast<int>(seed % 3),
                                        .mean_length_mm = 0.02 * std::pow(1000, (seed % 20) / 19.0),
                                        .speed_mm_per_s = 20 + 0.5 * seed,
                                        .accel_mm_per_s2 = 2990}));
  return runs;
}

std::vector<Motion> motions() {
  return {
      {"print 5 mm", {printed_lines(1, {.lines = 1000})}, {{{3837, 4222}, {3851, 4110}, {3836, 4178}}}},
      {"print 1 mm",
       {printed_lines(1, {.lines = 1000, .mean_length_mm = 1})},
       {{{3196, 3513}, {3236, 3428}, {3176, 3434}}}},
      {"travel 40 mm",
       {printed_lines(1, {.lines = 200, .mean_length_mm = 40, .speed_mm_per_s = 150})},
       {{{1528, 2287}, {1563, 2152}, {944, 1015}}}},
      {"slow 30 mm",
       {printed_lines(1, {.lines = 100, .mean_length_mm = 30, .speed_mm_per_s = 10})},
       {{{2676, 4465}, {2790, 5019}, {2783, 5055}}}},
      {"curve", {smooth_curve(4, {.seconds = 20})}, {{{879, 972}, {1151, 1321}, {706, 763}}}},
      {"curve, 1 mm pieces",
       {smooth_curve(4, {.seconds = 20, .piece_mm = 1})},
       {{{955, 1812}, {974, 2408}, {895, 1141}}}},
      {"curve in five axes",
       {smooth_curve(4, {.seconds = 20, .tilt_rad = 0.4, .turn_rad = 1})},
       {{{1406, 1474}, {1322, 1398}, {824, 966}}}},
      {"single lines", single_lines(), {{{2772, 2915}, {2830, 2913}, {2347, 2279}}}},
  };
}

std::vector<FittedSegment> fit_all(Segmenter& segmenter, const std::vector<JointSpan>& spans) {
  segmenter.start(standing_at(segmenter.node(), spans.front()));
  std::vector<FittedSegment> segments;
  std::size_t k = 0;
  while (!segmenter.ended()) {
    while (k < spans.size() && segmenter.has_room()) segmenter.push(spans[k++]);
    if (const auto segment = segmenter.next()) segments.push_back(*segment);
  }
  return segments;
}

/// How far the accelerations leave those of the spans that they cover, over what the segmenter's header
/// allows; counts/unit^2.
double excess(const NodeAxes& node, const std::vector<JointSpan>& spans,
              const std::vector<FittedSegment>& segments) {
  constexpr double u = kSecondsPerUnit;
  double worst = 0;
  std::size_t first = 0;
  for (const FittedSegment& s : segments) {
    // A knot is rounded to the grid.
    const double begin = static_cast<double>(s.start_units - 1) * u;
    const double end = static_cast<double>(s.start_units + s.duration + 1) * u;
    while (first + 1 < spans.size() && spans[first].start_s + spans[first].duration_s < begin) ++first;
    for (std::size_t i = 0; i < kAxesPerNode; ++i) {
      const AxisScaling& axis = node.axes[i];
      const double slope = axis.slope() * u * u, limit = std::abs(slope) * axis.acceleration_limit;
      double least = HUGE_VAL, most = -HUGE_VAL;
      for (std::size_t k = first; k < spans.size() && spans[k].start_s <= end; ++k) {
        const auto& c = spans[k].coefficients[static_cast<std::size_t>(axis.joint)];
        for (const double edge : {begin, end}) {
          const double x = std::clamp(edge - spans[k].start_s, 0.0, spans[k].duration_s);
          const double a = slope * (2 * c[2] + 6 * c[3] * x);
          least = std::min(least, a);
          most = std::max(most, a);
        }
      }
      const double asked = std::max(most, -least);
      const double wider = asked > limit ? 0.05 * limit : std::max(0.75 * (limit - asked), 0.002 * limit);
      const double a = std::ldexp(s.acceleration[i], 1 + kDefaultAccelerationShift - 32);
      worst = std::max(worst, std::max(a - most, least - a) - wider);
    }
  }
  return worst;
}

TEST(Segmenter, TakesNoMoreFramesAndTriesThanWhenItsNumbersWereChosen) {
  const auto kinematics = m1();
  Taken all, at_most;
  for (const Motion& motion : motions()) {
    std::vector<std::vector<JointSpan>> runs;
    for (const auto& phases : motion.runs) runs.push_back(sample(*kinematics, phases));
    for (std::size_t n = 0; n < 3; ++n) {
      SCOPED_TRACE(::testing::Message() << motion.name << ", node " << n + 1);
      Segmenter segmenter(m1_axes()[n]);
      double count = 0;
      for (const auto& spans : runs) {
        const auto segments = fit_all(segmenter, spans);
        count += static_cast<double>(segments.size());
        EXPECT_LE(excess(segmenter.node(), spans, segments), 1e-7);
      }
      const auto tries = static_cast<double>(segmenter.counters().candidates);
      EXPECT_LE(count, 1.005 * motion.took[n].segments);
      EXPECT_LE(tries, 1.02 * motion.took[n].tries);
      EXPECT_GE(tries, 0.9 * count);
      EXPECT_LE(segmenter.counters().worst_ratio, 1);
      EXPECT_GT(segmenter.counters().worst_ratio, 0.9);
      EXPECT_EQ(segmenter.counters().segments, count);
      all.segments += count;
      all.tries += tries;
      at_most.segments += motion.took[n].segments;
      at_most.tries += motion.took[n].tries;
    }
  }
  EXPECT_LE(all.segments, 1.001 * at_most.segments);
  EXPECT_LE(all.tries, 1.005 * at_most.tries);
}

TEST(Segmenter, ASegmentBearsTheLineOfItsFirstKnot) {
  const auto kinematics = m1();
  const auto spans = sample(*kinematics, printed_lines(6, {.lines = 60}));
  Segmenter segmenter(m1_axes()[1]);
  std::size_t k = 0;
  for (const FittedSegment& s : fit_all(segmenter, spans)) {
    const double begin = static_cast<double>(s.start_units) * kSecondsPerUnit;
    while (k + 1 < spans.size() && spans[k].start_s + spans[k].duration_s < begin + 0.5 * kSecondsPerUnit)
      ++k;
    EXPECT_EQ(s.line, spans[k].line) << s.start_units;
  }
}

}  // namespace
}  // namespace kinebus::testing
