// A group of streams whose joints have play: which side of its gap every motor is on, from run to run.
#include <gtest/gtest.h>

#include <cmath>

#include "gateway/stream/tests/model_machine.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::testing {
namespace {

std::vector<NodeAxes> axes_with_gaps() {
  auto axes = m1_axes();
  for (NodeAxes& node : axes)
    for (AxisScaling& axis : node.axes) {
      axis.gap = 40 / axis.slope();
      axis.take_up_per_s2 = 4000 / axis.slope();
    }
  return axes;
}

/// Where the joints are on the way along `phases`, against the path.
void expect_on_the_way(ModelMachine& m, const std::vector<Phase>& phases) {
  m.next = 0;
  m.group.begin_run();
  m.fill(phases);
  m.group.release(m.tau + path_ms(100));
  int looked = 0;
  for (int guard = 0; guard < 100'000 && !m.group.run_done(m.tau); ++guard) {
    m.fill(phases);
    m.send();
    m.pass(10);
    m.tell();
    const auto exact = m.planned_joints(phases);
    if (!exact) continue;
    const auto joints = m.group.joints_at(m.tau);
    ASSERT_TRUE(joints);
    for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR((*joints)[j], (*exact)[j], 5e-4) << j;
    ++looked;
  }
  ASSERT_TRUE(m.group.run_done(m.tau));
  EXPECT_GT(looked, 5);
}

TEST(StreamGroup, ARunBehindAnotherGoesOnFromTheSidesOfItsGaps) {
  ModelMachine m(axes_with_gaps());
  const auto phases = printed_lines(5, {.lines = 40});
  m.stand_at(phases.front());
  expect_on_the_way(m, phases);
  int other_side = 0;
  for (int j = 0; j < 4; ++j) other_side += m.group.side(j) < -0.99;
  EXPECT_GT(other_side, 0);
  std::array<double, 4> sides{};
  for (int j = 0; j < 4; ++j) sides[static_cast<std::size_t>(j)] = m.group.side(j);
  m.group.cancel();
  for (int j = 0; j < 4; ++j) EXPECT_EQ(m.group.side(j), sides[static_cast<std::size_t>(j)]) << "it was done";
  for (ModelNode& node : m.nodes) m.group.set_state(node.id(), node.tail(), node.status());
  expect_on_the_way(m, onward(phases, 1));
}

/// Its turns never came, so no motor has gone to the other side of its gap.
TEST(StreamGroup, ARunThatIsCancelledBeforeItsReleaseLeavesEveryMotorOnItsSide) {
  ModelMachine m(axes_with_gaps());
  const auto first = printed_lines(5, {.lines = 40});
  m.stand_at(first.front());
  expect_on_the_way(m, first);
  std::array<double, 6> sides{};
  for (int j = 0; j < 6; ++j) sides[static_cast<std::size_t>(j)] = m.group.side(j);
  const auto there = onward(first, 0.4);
  m.next = 0;
  m.group.begin_run();
  m.fill(there);
  int turned = 0;
  for (int j = 0; j < 6; ++j) turned += m.group.side(j) != sides[static_cast<std::size_t>(j)];
  ASSERT_GT(turned, 0);
  m.group.cancel();
  for (int j = 0; j < 6; ++j) EXPECT_EQ(m.group.side(j), sides[static_cast<std::size_t>(j)]) << j;
  for (ModelNode& node : m.nodes) m.group.set_state(node.id(), node.tail(), node.status());
  expect_on_the_way(m, there);
}

TEST(StreamGroup, ARunThatIsCancelledBeforeItsFirstFrameLeavesEveryMotorOnItsSide) {
  ModelMachine m(axes_with_gaps());
  const auto phases = printed_lines(5, {.lines = 40});
  m.stand_at(phases.front());
  m.group.begin_run();
  m.fill(phases);
  m.group.release(path_ms(100));
  m.group.cancel();
  for (int j = 0; j < 6; ++j) EXPECT_EQ(m.group.side(j), 1) << j;
}

}  // namespace
}  // namespace kinebus::testing
