#include "gateway/stream/backlash_take_up.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gateway/stream/tests/take_up_plans.hpp"

namespace kinebus {
namespace {

using namespace take_up_plans;

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

/// Where the motor leads to, by dense looks at the plan: +1 or -1 from the places on at which the joint went
/// back.
struct Turn {
  double time = 0, side = 1;
};
std::vector<Turn> turns(const std::vector<JointSpan>& plan, double side) {
  std::vector<Turn> found;
  double extreme = plan.front().position(0, 0);
  for (const JointSpan& s : plan)
    for (int k = 0; k <= 4000; ++k) {
      const double t = s.duration_s * k / 4000, at = s.position(0, t);
      if (side * (at - extreme) >= 0) {
        extreme = at;
      } else if (side * (extreme - at) > 1e-3) {
        side = -side;
        extreme = at;
        found.push_back({s.start_s + t, side});
      }
    }
  return found;
}

/// One cubic with both turning points inside, either way round.
JointSpan wave(double start_s, double duration_s, double at, double size, bool last) {
  JointSpan s;
  s.start_s = start_s;
  s.duration_s = duration_s;
  s.line = 7;
  // size * x (x - 0.5) (x - 1), and as much as brings its ends to rest nearly.
  const double h = duration_s;
  s.coefficients[0] = {at, 0.5 * size / h, -1.5 * size / (h * h), size / (h * h * h)};
  s.last = last;
  return s;
}

TEST(BacklashTakeUp, EveryTurnInsideASpanIsFoundWhereItIs) {
  for (const double size : {8.0, -8.0, 0.05, -0.05}) {
    for (const bool quadratic : {false, true}) {
      BacklashTakeUp t = take_up();
      std::vector<JointSpan> plan{wave(0, 2, 3, size, false)};
      if (quadratic) plan[0].coefficients[0] = {3, size, -size / 2, 0};
      JointSpan rest;
      rest.start_s = 2;
      rest.duration_s = 0.5;
      rest.last = true;
      rest.coefficients[0] = {plan[0].position(0, 2), 0, 0, 0};
      plan.push_back(rest);
      (void)run(t, plan);
      const auto expected = turns(plan, 1);
      ASSERT_FALSE(expected.empty());
      const double takes = 2 * std::sqrt(kGap / kAccel);
      double before = 1;
      for (const Turn& turn : expected) {
        EXPECT_NEAR(t.side_at(0, turn.time - 1e-3), before, 1e-9) << size;
        EXPECT_NEAR(t.side_at(0, turn.time + takes / 2), 0, 0.15) << size;
        // A parabola up to the middle, its mirror image behind it.
        EXPECT_NEAR(t.side_at(0, turn.time + takes / 4), before * 0.75, 0.15) << size;
        EXPECT_NEAR(t.side_at(0, turn.time + takes * 3 / 4), -before * 0.75, 0.15) << size;
        EXPECT_NEAR(t.side_at(0, turn.time + takes + 1e-3), turn.side, 1e-9) << size;
        before = turn.side;
      }
      EXPECT_NEAR(t.side(0), before, 1e-12);
    }
  }
}

TEST(BacklashTakeUp, ATakeUpIsTwoParabolas) {
  BacklashTakeUp t = take_up();
  const auto out = run(t, {move(0, 1, 5, 0, true)});
  double begun = 0;
  for (double time = 0; time < 1 && begun == 0; time += 1e-5)
    if (t.side_at(0, time) < 1) begun = time - 1e-5;
  ASSERT_GT(begun, 0);
  const double half = std::sqrt(kGap / kAccel);
  for (double x = 0; x < 2 * half; x += half / 20) {
    const double rest = 2 * half - x;
    const double lead = x <= half ? kGap / 2 - kAccel * x * x / 2 : -kGap / 2 + kAccel * rest * rest / 2;
    EXPECT_NEAR(t.side_at(0, begun + x) * kGap / 2, lead, 1e-3 * kGap) << x;
    // The spans say the same.
    for (const JointSpan& s : out)
      if (begun + x >= s.start_s && begun + x < s.start_s + s.duration_s) {
        const double planned = move(0, 1, 5, 0, true).position(0, begun + x);
        EXPECT_NEAR(s.position(0, begun + x - s.start_s) - planned, t.side_at(0, begun + x) * kGap / 2, 1e-9);
      }
  }
}

TEST(BacklashTakeUp, OutputIsThePlanWithTheSideAtEveryTime) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 engine(seed);
    const auto uniform = [&](double a, double b) {
      return a + (b - a) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    BacklashTakeUp::Joints joints{};
    joints[0] = {.gap = kGap, .accel_per_s2 = kAccel, .hysteresis = 1e-3, .home_side = 1};
    joints[2] = {.gap = kGap / 3, .accel_per_s2 = kAccel / 2, .hysteresis = 1e-3, .home_side = -1};
    BacklashTakeUp t(joints);
    std::vector<JointSpan> plan;
    double time = 0, at = 0;
    for (int k = 0; k < 8; ++k) {
      const double next = at + uniform(-3, 3), d = uniform(0.05, 0.2);
      plan.push_back(move(time, d, at, next, k == 7));
      plan.back().coefficients[2] = plan.back().coefficients[0];
      for (double& c : plan.back().coefficients[2]) c = -c;
      plan.back().line = static_cast<std::uint32_t>(k + 1);
      time += d;
      at = next;
    }
    const auto out = run(t, plan);
    expect_smooth(out);
    std::size_t k = 0;
    double end = 0;
    for (const JointSpan& s : out) {
      while (k + 1 < plan.size() && plan[k + 1].start_s <= s.start_s + 1e-9) ++k;
      EXPECT_EQ(s.line, plan[k].line) << seed;
      EXPECT_GT(s.duration_s, 1e-6) << seed;
      EXPECT_NEAR(s.start_s, end, 1e-9) << seed;
      end = s.start_s + s.duration_s;
      for (const double x : {0.0, 0.3, 0.5, 0.9}) {
        const double when = s.start_s + x * s.duration_s, in_plan = when - plan[k].start_s;
        const double planned = plan[k].position(0, std::min(in_plan, plan[k].duration_s));
        EXPECT_NEAR(s.position(1, x * s.duration_s), planned, 1e-9) << seed;
        EXPECT_NEAR(s.position(0, x * s.duration_s) - planned, t.side_at(0, when) * kGap / 2, 1e-8) << seed;
        EXPECT_NEAR(s.position(2, x * s.duration_s) + planned, t.side_at(2, when) * kGap / 6, 1e-8) << seed;
      }
    }
  }
}

TEST(BacklashTakeUp, ATurnBackBeforeTheTakeUpBeganCancelsIt) {
  BacklashTakeUp t = take_up();
  t.restart();
  // Three turns within the 20 ms of the first one's take-up: the last two make none.
  std::vector<JointSpan> plan;
  for (int k = 0; k < 4; ++k)
    plan.push_back(move(0.002 * k, 0.002, k % 2 == 0 ? 0 : -0.01, k % 2 == 0 ? -0.01 : 0, k == 3));
  const auto out = run(t, plan);
  expect_smooth(out);
  EXPECT_NEAR(t.side(0), 1, 1e-12);
  EXPECT_NEAR(out.back().start_s + out.back().duration_s, 0.04, 0.003) << "there and back";
  plan.resize(3);
  plan.back().last = true;
  BacklashTakeUp once = take_up();
  const auto shorter = run(once, plan);
  EXPECT_NEAR(once.side(0), -1, 1e-12);
  EXPECT_NEAR(shorter.back().start_s + shorter.back().duration_s, 0.02, 0.003);
}

TEST(BacklashTakeUp, ARunThatWasLostInsideTheGapIsBroughtToItsNearerSide) {
  for (const bool far : {false, true}) {
    BacklashTakeUp t = take_up();
    t.restart();
    const JointSpan back = move(0, 1, 5, 0, true);
    t.push(back);
    double when = 0;
    while (t.side_at(0, when) > (far ? -0.6 : 0.6)) when += 1e-5;
    t.abandon(when);
    EXPECT_TRUE(t.wants_span()) << "what was not taken is dropped";
    EXPECT_FALSE(t.next());
    EXPECT_NEAR(t.side(0), far ? -0.6 : 0.6, 0.01);
    JointSpan still;
    still.duration_s = 0.5;
    still.coefficients[0] = {2, 0, 0, 0};
    still.last = true;
    const auto out = run(t, {still});
    EXPECT_NEAR(out.front().position(0, 0), 2 + (far ? -0.6 : 0.6) * kGap / 2, 0.001);
    EXPECT_NEAR(t.side(0), far ? -1 : 1, 1e-12);
    EXPECT_NEAR(out.back().position(0, out.back().duration_s), 2 + (far ? -1 : 1) * kGap / 2, 1e-9);
    t.homed();
    EXPECT_EQ(t.side(0), 1);
    (void)run(t, {move(0, 1, 0, 5, true)});
    EXPECT_EQ(t.side(0), 1) << "the home direction again";
  }
}

TEST(BacklashTakeUp, AnewRunTakesNothingOfTheLast) {
  BacklashTakeUp t = take_up();
  t.restart();
  t.push(move(0, 1, 5, 0, false));
  EXPECT_FALSE(t.wants_span());
  t.restart();
  EXPECT_TRUE(t.wants_span());
  EXPECT_FALSE(t.next());
  // The new run begins elsewhere: that is no turn.
  const auto out = run(t, {move(0, 1, 50, 45, true)});
  EXPECT_EQ(out.size(), 1u);
  EXPECT_NEAR(out[0].position(0, 0), 50 - kGap / 2, 1e-9);
  EXPECT_EQ(out[0].line, 0u);
}

TEST(BacklashTakeUp, ATurnBesideASpanIsNoneOfIts) {
  // Parabolas and cubics that turn just before their beginning, or just behind their end.
  for (const double vertex : {-0.4, 1.4}) {
    for (const double cubic : {0.0, 0.2}) {
      BacklashTakeUp t = take_up();
      const double way = vertex < 0 ? 1 : -1;  // grows from 0 to 1 s
      JointSpan s;
      s.duration_s = 1;
      s.last = true;
      s.coefficients[0] = {0, -2 * way * vertex, way, cubic * way};
      (void)run(t, {s});
      EXPECT_EQ(t.side(0), 1) << vertex << " " << cubic;
    }
  }
}

TEST(BacklashTakeUp, AJointThatCreepsBackSpanBySpanHasTurned) {
  BacklashTakeUp t = take_up();
  std::vector<JointSpan> plan;
  for (int k = 0; k < 20; ++k) plan.push_back(move(0.1 * k, 0.1, -0.0004 * k, -0.0004 * (k + 1), k == 19));
  (void)run(t, plan);
  EXPECT_EQ(t.side(0), -1);
  EXPECT_EQ(t.side_at(0, 0.2), 1);
}

TEST(BacklashTakeUp, TheRestOfATakeUpBelongsToTheLastLine) {
  BacklashTakeUp t = take_up();
  JointSpan back = move(0, 0.004, 0, -0.02, true);
  back.line = 31;
  const auto out = run(t, {back});
  ASSERT_GT(out.size(), 1u);
  for (const JointSpan& s : out) EXPECT_EQ(s.line, 31u);
}

}  // namespace
}  // namespace kinebus
