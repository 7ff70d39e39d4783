// Shaped phases against the convolution itself, summed up from the planner's phases.

#include "gateway/shaping/path_shaper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "gateway/motion/tests/test_machine.hpp"

namespace kinebus {
namespace {

using probe::Job;
using Shapers = PathShaper::Shapers;

Shapers common(ShaperKind kind, double frequency_hz = 45) {
  const InputShaper shaper = make_shaper(kind, frequency_hz, 0.08);
  return {shaper, shaper, shaper};
}

std::vector<Phase> planned(const probe::Lines& lines, const MotionLimits& limits = {}) {
  const auto m = probe::measure(probe::m1(), limits, lines, 1, true);
  EXPECT_TRUE(m.planned) << m.error;
  return m.all;
}

std::vector<Phase> shaped(const std::vector<Phase>& phases, const Shapers& shapers) {
  PathShaper shaper(shapers);
  EXPECT_TRUE(shaper.active());
  std::vector<Phase> out;
  Phase phase;
  for (const Phase& p : phases) {
    shaper.push(p);
    while (shaper.next(phase)) out.push_back(phase);
  }
  EXPECT_TRUE(shaper.empty());
  EXPECT_EQ(shaper.held_s(), 0);
  return out;
}

/// pose(tau) of a chain of phases, at rest before and behind it.
class Chain {
 public:
  explicit Chain(const std::vector<Phase>& phases) : phases_(phases) {
    double t = 0;
    for (const Phase& p : phases) {
      starts_.push_back(t);
      t += p.duration_s;
    }
    end_s_ = t;
  }
  double end_s() const { return end_s_; }
  PosePoint at(double t) const {
    const bool before = t<0, behind = t> end_s_;
    t = std::clamp(t, 0.0, end_s_);
    auto i = static_cast<std::size_t>(std::upper_bound(starts_.begin(), starts_.end(), t) - starts_.begin());
    --i;
    PosePoint p = phases_[i].at(t - starts_[i]);
    if (before || behind) p.x1 = p.x2 = {};
    return p;
  }

 private:
  const std::vector<Phase>& phases_;
  std::vector<double> starts_;
  double end_s_ = 0;
};

void expect_is_convolution(const std::vector<Phase>& in, const std::vector<Phase>& out,
                           const Shapers& shapers) {
  const Chain plan(in), result(out);
  double mean_s = 0, duration_s = 0;
  for (const InputShaper& s : shapers) mean_s = std::max(mean_s, s.mean_s());
  for (const InputShaper& s : shapers)
    duration_s = std::max(duration_s, s.duration_s() + mean_s - s.mean_s());
  EXPECT_NEAR(result.end_s(), plan.end_s() + duration_s, 1e-6);
  double worst = 0, worst_speed = 0;
  for (double t = 0; t < result.end_s(); t += 0.37e-3) {
    const PosePoint got = result.at(t);
    for (std::size_t axis = 0; axis < kE; ++axis) {
      const InputShaper& s = shapers[axis < 3 ? axis : 0];
      double x = 0, x1 = 0;
      for (const InputShaper::Pulse& pulse : s.all()) {
        const PosePoint p = plan.at(t - pulse.time_s - (mean_s - s.mean_s()));
        x += pulse.weight * p.x[axis];
        x1 += pulse.weight * p.x1[axis];
      }
      worst = std::max(worst, std::abs(got.x[axis] - x));
      worst_speed = std::max(worst_speed, std::abs(got.x1[axis] - x1));
    }
  }
  EXPECT_LE(worst, 2e-5);
  EXPECT_LE(worst_speed, 0.05);
}

void expect_smooth_from_rest_to_rest(const std::vector<Phase>& in, const std::vector<Phase>& out) {
  ASSERT_FALSE(out.empty());
  for (const double speed : {out.front().pose_speed(0), out.back().pose_speed(out.back().duration_s)})
    EXPECT_LE(speed, 1e-3);
  const PosePoint end = out.back().at(out.back().duration_s);
  const PosePoint planned_end = in.back().at(in.back().duration_s);
  for (std::size_t axis = 0; axis < kPoseAxes; ++axis)
    EXPECT_NEAR(end.x[axis], planned_end.x[axis], 1e-9) << axis;
  for (std::size_t i = 0; i + 1 < out.size(); ++i) {
    const PosePoint a = out[i].at(out[i].duration_s), b = out[i + 1].at(0);
    EXPECT_FALSE(out[i].last);
    EXPECT_LE(out[i].line, out[i + 1].line);
    for (std::size_t axis = 0; axis < kPoseAxes; ++axis) {
      ASSERT_NEAR(a.x[axis], b.x[axis], 1e-9) << "phase " << i << " axis " << axis;
      ASSERT_NEAR(a.x1[axis], b.x1[axis], 1e-6) << "phase " << i << " axis " << axis;
    }
  }
  EXPECT_TRUE(out.back().last);
}

TEST(PathShaper, WithoutShapersThereIsNothingToDo) {
  EXPECT_FALSE(PathShaper().active());
  EXPECT_FALSE(PathShaper(common(ShaperKind::kNone)).active());
  EXPECT_TRUE(PathShaper(common(ShaperKind::kZv)).active());
}

TEST(PathShaper, PrintsAreTheConvolutionOfThePlan) {
  for (const ShaperKind kind : {ShaperKind::kZv, ShaperKind::kMzv, ShaperKind::kThreeHump}) {
    const auto in = planned(probe::random_print(7, 400));
    const auto out = shaped(in, common(kind));
    expect_smooth_from_rest_to_rest(in, out);
    expect_is_convolution(in, out, common(kind));
  }
}

TEST(PathShaper, JerkLimitedPlansToo) {
  MotionLimits limits;
  limits.tool_jerk_mm_per_s3 = 100'000;
  const auto in = planned(probe::random_print(3, 150), limits);
  const auto out = shaped(in, common(ShaperKind::kZvd));
  expect_smooth_from_rest_to_rest(in, out);
  expect_is_convolution(in, out, common(ShaperKind::kZvd));
}

TEST(PathShaper, FiveAxesTurnInStep) {
  const auto in = planned(probe::random_five_axis(5, 200, Frame::kPart));
  const auto out = shaped(in, common(ShaperKind::kEi));
  expect_smooth_from_rest_to_rest(in, out);
  expect_is_convolution(in, out, common(ShaperKind::kEi));
}

TEST(PathShaper, FilamentIsShapedLikeTheTipWithOneShaper) {
  const auto in = planned(probe::random_print(11, 200));
  const Shapers shapers = common(ShaperKind::kMzv);
  const auto out = shaped(in, shapers);
  const Chain plan(in), result(out);
  double worst = 0;
  for (double t = 0; t < result.end_s(); t += 1e-3) {
    double e = 0;
    for (const InputShaper::Pulse& p : shapers[0].all()) e += p.weight * plan.at(t - p.time_s).x[kE];
    worst = std::max(worst, std::abs(e - result.at(t).x[kE]));
  }
  EXPECT_LE(worst, 2e-5);
}

TEST(PathShaper, AxesWithShapersOfTheirOwnKeepOneMeanTimeAndAllTheFilament) {
  const Shapers shapers{make_shaper(ShaperKind::kMzv, 60, 0.05), make_shaper(ShaperKind::kTwoHump, 38, 0.1),
                        make_shaper(ShaperKind::kNone, 0, 0)};
  const auto in = planned(probe::random_print(2, 300));
  const auto out = shaped(in, shapers);
  expect_smooth_from_rest_to_rest(in, out);
  expect_is_convolution(in, out, shapers);
  // Where nothing accelerates, tool and filament are where the plan has them a mean time earlier.
  Job line;
  line.feed(50).by({60, 0, 0, 0, 0, 2}).by({0, 60, 0, 0, 0, 2});
  const auto corner = planned(line.lines());
  const auto smooth = shaped(corner, shapers);
  const Chain plan(corner), result(smooth);
  const double mean_s = shapers[1].mean_s(), t = 0.6;
  for (const PoseAxis axis : {kX, kY, kE})
    EXPECT_NEAR(result.at(t).x[axis], plan.at(t - mean_s).x[axis], 1e-6) << axis;
}

TEST(PathShaper, AverageNeverAsksForMoreThanThePlan) {
  MotionLimits limits;
  const auto out = shaped(planned(probe::random_print(4, 400), limits), common(ShaperKind::kTwoHump));
  for (const Phase& phase : out)
    for (const double t : {0.0, 0.5 * phase.duration_s, phase.duration_s}) {
      const PosePoint p = phase.at(t);
      EXPECT_LE(std::hypot(p.x1[kX], p.x1[kY], p.x1[kZ]), limits.tool_speed_mm_per_s * (1 + 1e-4));
      EXPECT_LE(std::hypot(p.x2[kX], p.x2[kY], p.x2[kZ]), limits.tool_accel_mm_per_s2 + 10);
    }
}

TEST(PathShaper, ComesToRestWherePosesDoNotJoin) {
  Job first, second(Pose{5, 5, 5, 0, 0, 0}, Frame::kMachine);
  first.feed(80).by({20, 0, 0, 0, 0, 1});
  second.feed(80).by({0, 20, 0, 0, 0, 1});
  std::vector<Phase> a = planned(first.lines());
  const std::vector<Phase> b = planned(second.lines());
  a.back().last = false;
  const std::size_t count = a.size();
  a.insert(a.end(), b.begin(), b.end());
  const Shapers shapers = common(ShaperKind::kZvd);
  const auto out = shaped(a, shapers);
  double total_s = 0, first_s = 0;
  for (std::size_t i = 0; i < a.size(); ++i) (i < count ? first_s : total_s) += a[i].duration_s;
  total_s += first_s;
  double t = 0;
  bool changed = false;
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!changed && out[i].piece.frame == Frame::kMachine) {
      changed = true;
      EXPECT_NEAR(t, first_s + shapers[0].duration_s(), 1e-6);
      EXPECT_LE(out[i - 1].pose_speed(out[i - 1].duration_s), 1e-3);
      EXPECT_NEAR(out[i - 1].at(out[i - 1].duration_s).x[kX], 20, 1e-9);
      EXPECT_LE(out[i].pose_speed(0), 1e-3);
      EXPECT_NEAR(out[i].at(0).x[kX], 5, 1e-9);
    }
    EXPECT_EQ(out[i].last, i + 1 == out.size());
    t += out[i].duration_s;
  }
  EXPECT_TRUE(changed);
  EXPECT_NEAR(t, total_s + 2 * shapers[0].duration_s(), 1e-6);
}

TEST(PathShaper, ManyRunsFollowEachOther) {
  Job job;
  job.feed(60).by({10, 5, 0, 0, 0, 1});
  const auto phases = planned(job.lines());
  PathShaper shaper(common(ShaperKind::kMzv));
  Phase out;
  for (int run = 0; run < 3; ++run) {
    int lasts = 0;
    for (const Phase& p : phases) {
      shaper.push(p);
      while (shaper.next(out)) lasts += out.last ? 1 : 0;
    }
    EXPECT_EQ(lasts, 1);
    EXPECT_TRUE(shaper.empty());
  }
  shaper.push(phases.front());
  EXPECT_TRUE(shaper.next(out));
  shaper.reset();
  EXPECT_TRUE(shaper.empty());
  EXPECT_FALSE(shaper.next(out));
}

}  // namespace
}  // namespace kinebus
