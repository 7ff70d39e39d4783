// How many frames and tries motions take that are harder than a print: to the number, as arithmetic is the
// same everywhere. Who finds better choices writes the new numbers here, so that they are not lost again.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

using Runs = std::vector<std::vector<JointSpan>>;

/// Two joints that swing, the second twice as fast and half as far, in cubics of `part_s` each.
std::vector<JointSpan> waves(double way, double omega, double part_s, int turns, bool eased) {
  const double seconds = 2 * turns * M_PI / omega;
  const int parts = static_cast<int>(seconds / part_s);
  const double h = seconds / parts;
  std::vector<JointSpan> spans;
  for (int k = 0; k < parts; ++k) {
    JointSpan span;
    span.start_s = k * h;
    span.duration_s = h;
    span.eased = eased;
    span.last = k + 1 == parts;
    for (int j = 0; j < 2; ++j) {
      const double w = omega * (1 + j), a = way / (1 + j);
      const auto q = [&](double t) { return 600 + a * (1 - std::cos(w * t)); };
      const auto v = [&](double t) { return a * w * std::sin(w * t); };
      const double q0 = q(k * h), q1 = q((k + 1) * h), mean = (q1 - q0) / h;
      const double v0 = k == 0 ? 0 : v(k * h), v1 = span.last ? 0 : v((k + 1) * h);
      span.coefficients[static_cast<std::size_t>(j)] = {q0, v0, (3 * mean - 2 * v0 - v1) / h,
                                                        (v0 + v1 - 2 * mean) / (h * h)};
    }
    spans.push_back(span);
  }
  return spans;
}

/// Each run one to three lines, from rest to rest, from 0.02 to 20 mm.
Runs single_lines(int runs, const std::function<std::vector<Phase>(std::uint32_t, PrintedLines)>& make) {
  const auto kinematics = m1();
  Runs out;
  for (int k = 1; k <= runs; ++k)
    out.push_back(sample(
        *kinematics, make(static_cast<std::uint32_t>(k),
                          {.lines = 1 + k % 3, .mean_length_mm = 0.02 * std::pow(1000, (k % 20) / 19.0)})));
  return out;
}

Runs eased_singles() {
  return single_lines(60, [](std::uint32_t seed, PrintedLines shape) {
    shape.speed_mm_per_s = 20 + 2.0 * seed;
    return eased_lines(*m1(), seed, shape, 50'000);
  });
}
Runs printed_singles() {
  return single_lines(200, [](std::uint32_t seed, PrintedLines shape) {
    shape.speed_mm_per_s = 20 + 0.5 * seed;
    shape.accel_mm_per_s2 = 2990;
    return printed_lines(1000 + seed, shape);
  });
}
Runs fast_eased_lines() {
  const auto kinematics = m1();
  return {sample(*kinematics, eased_lines(*kinematics, 8, {.lines = 39, .speed_mm_per_s = 200}, 20'000))};
}

struct Motion {
  const char* name;
  Runs runs;
  std::size_t node;
  double off_counts;  ///< where the first axis stands beside the run's start; the second 0.7 of it
  std::uint64_t segments, tries, loose;
};

TEST(Segmenter, TakesAsManyFramesAndTriesAsWhenItsNumbersWereChosen) {
  const std::vector<Motion> motions{
      {"jumps near the limit, from beside", {jumpy_spans(3, 4900, 100)}, 0, 3.1, 156, 589, 0},
      {"jumps over the limit", {jumpy_spans(2, 6000, 600, 0.00002, 0.02)}, 0, 0, 575, 1420, 0},
      {"single lines under a limit of jerk", eased_singles(), 1, 0, 1076, 1240, 0},
      {"fast lines under a limit of jerk", fast_eased_lines(), 2, 0, 338, 370, 0},
      {"a wave in spans of 0.1 ms", {waves(12, 12, 0.0001, 3, false)}, 0, 0, 215, 428, 0},
      {"a fast wave under a limit of jerk", {waves(0.5, 80, 0.0005, 20, true)}, 0, 0, 539, 1573, 0},
      // Not all of these can be followed: what is ahead is not known, or the start is too far off.
      {"a fast wave in spans of 25 us", {waves(0.5, 80, 0.000025, 20, true)}, 0, 0, 1045, 37282, 13},
      {"single lines from beside", printed_singles(), 2, 2.3, 1632, 7930, 5},
  };
  for (const Motion& motion : motions) {
    SCOPED_TRACE(motion.name);
    Segmenter segmenter(m1_axes()[motion.node]);
    for (const auto& spans : motion.runs) {
      auto from = standing_at(segmenter.node(), spans.front());
      from[0].position += to_fixed(motion.off_counts);
      from[1].position -= to_fixed(0.7 * motion.off_counts);
      segmenter.start(from);
      std::size_t k = 0;
      while (!segmenter.ended()) {
        while (k < spans.size() && segmenter.has_room()) segmenter.push(spans[k++]);
        (void)segmenter.next();
      }
    }
    EXPECT_EQ(segmenter.counters().segments, motion.segments);
    EXPECT_EQ(segmenter.counters().candidates, motion.tries);
    EXPECT_EQ(segmenter.counters().loose, motion.loose);
  }
}

}  // namespace
}  // namespace kinebus::testing
