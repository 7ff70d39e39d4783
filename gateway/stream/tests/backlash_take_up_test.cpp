#include "gateway/stream/backlash_take_up.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinebus {
namespace {

constexpr double kGap = 0.1, kAccel = 1000;

BacklashTakeUp take_up() {
  BacklashTakeUp::Joints joints{};
  joints[0] = {.gap = kGap, .accel_per_s2 = kAccel, .hysteresis = 1e-3, .home_side = 1};
  return BacklashTakeUp(joints);
}

/// A cubic that goes from `a` to `b` at rest at both ends; joint 1 goes along without a gap.
JointSpan move(double start_s, double duration_s, double a, double b, bool last) {
  JointSpan s;
  s.start_s = start_s;
  s.duration_s = duration_s;
  const double k = (b - a) / (duration_s * duration_s);
  s.coefficients[0] = {a, 0, 3 * k, -2 * k / duration_s};
  s.coefficients[1] = s.coefficients[0];
  s.last = last;
  return s;
}

std::vector<JointSpan> run(BacklashTakeUp& t, const std::vector<JointSpan>& spans) {
  std::vector<JointSpan> out;
  t.restart();
  for (const JointSpan& s : spans) {
    EXPECT_TRUE(t.wants_span());
    t.push(s);
    while (auto piece = t.next()) out.push_back(*piece);
  }
  return out;
}

void expect_smooth(const std::vector<JointSpan>& spans) {
  for (std::size_t i = 0; i + 1 < spans.size(); ++i) {
    const JointSpan &a = spans[i], &b = spans[i + 1];
    EXPECT_NEAR(a.start_s + a.duration_s, b.start_s, 1e-12);
    EXPECT_FALSE(a.last);
    for (const int joint : {0, 1}) {
      EXPECT_NEAR(a.position(joint, a.duration_s), b.position(joint, 0), 1e-8);
      EXPECT_NEAR(a.velocity(joint, a.duration_s), b.velocity(joint, 0), 5e-3);
    }
  }
  ASSERT_FALSE(spans.empty());
  EXPECT_TRUE(spans.back().last);
  EXPECT_NEAR(spans.back().velocity(0, spans.back().duration_s), 0, 1e-9);
}

TEST(BacklashTakeUp, NoGapPassesSpansThrough) {
  BacklashTakeUp t{BacklashTakeUp::Joints{}};
  EXPECT_FALSE(t.needed());
  const auto out = run(t, {move(0, 1, 0, 5, true)});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_EQ(out[0].coefficients, move(0, 1, 0, 5, true).coefficients);
}

TEST(BacklashTakeUp, AMotionInTheHomeDirectionOnlyLeads) {
  BacklashTakeUp t = take_up();
  const auto out = run(t, {move(0, 1, 0, 5, true)});
  ASSERT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].position(0, 0.3), move(0, 1, 0, 5, true).position(0, 0.3) + kGap / 2, 1e-12);
  EXPECT_EQ(t.side(0), 1);
}

TEST(BacklashTakeUp, ATurnIsTakenUpSmoothlyWithinItsAcceleration) {
  BacklashTakeUp t = take_up();
  const std::vector<JointSpan> plan{move(0, 1, 0, 5, false), move(1, 1, 5, 1, false), move(2, 1, 1, 4, true)};
  const auto out = run(t, plan);
  expect_smooth(out);
  EXPECT_GT(out.size(), 6u);
  double most = 0;
  for (const JointSpan& s : out) {
    const JointSpan& p = plan[std::min<std::size_t>(2, static_cast<std::size_t>(s.start_s + 1e-9))];
    const double lead = s.position(0, 0) - p.position(0, s.start_s - p.start_s);
    EXPECT_LE(std::abs(lead), kGap / 2 + 1e-9);
    EXPECT_NEAR(s.position(1, 0), p.position(1, s.start_s - p.start_s), 1e-9);
    most = std::max(most, std::abs(2 * (s.coefficients[0][2] - s.coefficients[1][2])));
  }
  EXPECT_NEAR(most, kAccel, 1e-6);
  EXPECT_NEAR(t.side(0), 1, 1e-12);
  EXPECT_NEAR(t.side_at(0, 1.9), -1, 1e-12);
}

TEST(BacklashTakeUp, ARunThatEndsInsideATakeUpIsLengthened) {
  BacklashTakeUp t = take_up();
  // Goes back by 20 um in 4 ms: the take-up needs 20 ms.
  const auto out = run(t, {move(0, 0.004, 0, -0.02, true)});
  expect_smooth(out);
  EXPECT_NEAR(out.back().start_s + out.back().duration_s, 0.02, 0.004);
  EXPECT_NEAR(out.back().position(0, out.back().duration_s), -0.02 - kGap / 2, 1e-9);
  EXPECT_EQ(t.side(0), -1);
}

TEST(BacklashTakeUp, RestIsNoMotion) {
  BacklashTakeUp t = take_up();
  JointSpan rest;
  rest.duration_s = 1;
  rest.coefficients[0] = {7, -1e-9, 2e-9, 0};
  rest.last = true;
  EXPECT_EQ(run(t, {rest}).size(), 1u);
  EXPECT_EQ(t.side(0), 1);
}

TEST(BacklashTakeUp, ALostRunKeepsWhatWasTakenUp) {
  BacklashTakeUp t = take_up();
  (void)run(t, {move(0, 1, 5, 0, true)});
  double middle = 0;
  for (double time = 0; time < 0.5; time += 1e-4)
    if (std::abs(t.side_at(0, time)) < std::abs(t.side_at(0, middle))) middle = time;
  t.abandon(middle);
  EXPECT_NEAR(t.side(0), 0, 0.05);
  const auto out = run(t, {move(0, 1, 3, 6, true)});
  EXPECT_NEAR(out[0].position(0, 0), 3, 0.01);
  t.homed();
  EXPECT_EQ(t.side(0), 1);
}

TEST(BacklashTakeUp, RandomMotionStaysSmoothAndWithinTheGap) {
  std::mt19937_64 engine(3);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  for (int n = 0; n < 200; ++n) {
    BacklashTakeUp t = take_up();
    std::vector<JointSpan> plan;
    double time = 0, at = 0;
    for (int k = 0; k < 12; ++k) {
      const double next = at + uniform(-1, 1) * std::pow(10, uniform(-4, 0.5)), d = uniform(0.002, 0.2);
      plan.push_back(move(time, d, at, next, k == 11));
      time += d;
      at = next;
    }
    const auto out = run(t, plan);
    expect_smooth(out);
    EXPECT_NEAR(std::abs(t.side(0)), 1, 1e-9);
  }
}

}  // namespace
}  // namespace kinebus
