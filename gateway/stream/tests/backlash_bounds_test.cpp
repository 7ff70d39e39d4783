// Backlash with more turns than are remembered, and with pieces and spans of a microsecond.
#include <gtest/gtest.h>

#include "gateway/stream/tests/take_up_plans.hpp"

namespace kinebus {
namespace {

using namespace take_up_plans;

TEST(BacklashTakeUp, OldTurnsAreForgottenAndTheirSideIsNot) {
  for (const int moves : {33, 34, 100, 101}) {
    BacklashTakeUp t = take_up();
    std::vector<JointSpan> plan;
    for (int k = 0; k < moves; ++k)
      plan.push_back(move(0.1 * k, 0.1, k % 2 == 0 ? 0 : 1, k % 2 == 0 ? 1 : 0, k + 1 == moves));
    const auto out = run(t, plan);
    expect_smooth(out);
    const int turns = moves - 1, forgotten = turns - 32;
    EXPECT_EQ(t.side(0), turns % 2 == 0 ? 1 : -1);
    for (int k = moves - 26; k < moves; ++k)
      EXPECT_EQ(t.side_at(0, 0.1 * k + 0.095), k % 2 == 0 ? 1 : -1) << k;
    // Before those that are kept there is the side that the last forgotten one led to.
    EXPECT_EQ(t.side_at(0, 0), forgotten % 2 == 0 ? 1 : -1) << moves;
    const double end = turns % 2 == 0 ? 1 : 0;
    const auto next = run(t, {move(0, 0.2, end, end, true)});
    EXPECT_NEAR(next.front().position(0, 0), end + t.side(0) * kGap / 2, 1e-9)
        << "the side of the run before";
  }
}

/// The time at which a lone turn's take-up has ended.
double end_of_take_up(const std::vector<JointSpan>& plan) {
  BacklashTakeUp t = take_up();
  const auto out = run(t, plan);
  return out.back().start_s + out.back().duration_s;
}

TEST(BacklashTakeUp, NoPieceIsShorterThanRoundingLets) {
  const std::vector<JointSpan> turned{move(0, 0.1, 0, -1, true)};
  BacklashTakeUp once = take_up();
  const auto alone = run(once, turned);
  ASSERT_GT(alone.size(), 2u);
  // The take-up ends within the motion; behind a short one it is what makes the run longer.
  std::vector<JointSpan> brief{move(0, 0.004, 0, -0.02, true)};
  const double ends = end_of_take_up(brief);
  ASSERT_GT(ends, 0.02);
  brief[0].last = false;
  for (const double off : {-1e-6, 1e-6, -5e-6, 5e-6}) {
    JointSpan still;
    still.start_s = 0.004;
    still.duration_s = ends + off - 0.004;
    still.coefficients[0] = still.coefficients[1] = {-0.02, 0, 0, 0};
    still.last = true;
    BacklashTakeUp t = take_up();
    const auto out = run(t, {brief[0], still});
    for (const JointSpan& s : out) EXPECT_GT(s.duration_s, 1.5e-6) << off;
    EXPECT_TRUE(out.back().last);
    EXPECT_NEAR(out.back().start_s + out.back().duration_s, off < -2e-6 ? ends : ends + off, 1e-9) << off;
  }
}

TEST(BacklashTakeUp, ASpanThatIsShortItselfIsPassedOn) {
  BacklashTakeUp t = take_up();
  const std::vector<JointSpan> plan{move(0, 0.1, 0, 1, false), move(0.1, 1e-6, 1, 1, true)};
  const auto out = run(t, plan);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_TRUE(out.back().last);
  EXPECT_NEAR(out.back().duration_s, 1e-6, 1e-12);
}

}  // namespace
}  // namespace kinebus
