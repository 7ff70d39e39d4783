#pragma once
// A joint with a gap, the plans that it is given, and what every answer must be like.

#include <gtest/gtest.h>

#include <vector>

#include "gateway/stream/backlash_take_up.hpp"

namespace kinebus::take_up_plans {

inline constexpr double kGap = 0.1, kAccel = 1000;

inline BacklashTakeUp take_up() {
  BacklashTakeUp::Joints joints{};
  joints[0] = {.gap = kGap, .accel_per_s2 = kAccel, .hysteresis = 1e-3, .home_side = 1};
  return BacklashTakeUp(joints);
}

/// A cubic that goes from `a` to `b` at rest at both ends; joint 1 goes along without a gap.
inline JointSpan move(double start_s, double duration_s, double a, double b, bool last) {
  JointSpan s;
  s.start_s = start_s;
  s.duration_s = duration_s;
  const double k = (b - a) / (duration_s * duration_s);
  s.coefficients[0] = {a, 0, 3 * k, -2 * k / duration_s};
  s.coefficients[1] = s.coefficients[0];
  s.last = last;
  return s;
}

inline std::vector<JointSpan> run(BacklashTakeUp& t, const std::vector<JointSpan>& spans) {
  std::vector<JointSpan> out;
  t.restart();
  for (const JointSpan& s : spans) {
    EXPECT_TRUE(t.wants_span());
    t.push(s);
    while (auto piece = t.next()) out.push_back(*piece);
  }
  return out;
}

inline void expect_smooth(const std::vector<JointSpan>& spans) {
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

}  // namespace kinebus::take_up_plans
