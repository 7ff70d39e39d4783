#include "gateway/motion/lookahead.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "gateway/motion/phase_emitter.hpp"

namespace kinebus {
namespace {

PlanPiece straight(double length, double cap, double accel = 1000) {
  PlanPiece piece;
  piece.length = length;
  piece.cap = cap;
  piece.accel = accel;
  return piece;
}

std::vector<Lookahead::Step> take_all(Lookahead& lookahead) {
  std::vector<Lookahead::Step> steps;
  Lookahead::Step step;
  while (lookahead.take(step)) steps.push_back(step);
  return steps;
}

void add(Lookahead& lookahead, const PlanPiece& piece) {
  lookahead.new_geometry().length = piece.length;
  lookahead.add(piece);
}

TEST(Lookahead, ShortMiddleSegmentLimitsBothNeighbours) {
  Lookahead lookahead(64);
  add(lookahead, straight(10, 10000));
  add(lookahead, straight(0.1, 400));
  add(lookahead, straight(10, 10000));
  lookahead.finish();
  const auto steps = take_all(lookahead);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[0].x_start, 0);
  EXPECT_EQ(steps[0].x_end, 400);
  EXPECT_EQ(steps[1].x_end, 400);
  EXPECT_EQ(steps[2].x_end, 0);
  EXPECT_TRUE(steps[2].last);
}

TEST(Lookahead, StopIsReachedThroughManyShortPieces) {
  Lookahead lookahead(4096);
  for (int i = 0; i < 1000; ++i) add(lookahead, straight(0.01, 1e6));
  lookahead.finish();
  const auto steps = take_all(lookahead);
  ASSERT_EQ(steps.size(), 1000u);
  for (const auto& step : steps) EXPECT_LE(std::abs(step.x_end - step.x_start), 2 * 1000 * 0.01 * (1 + 1e-9));
  EXPECT_NEAR(steps[499].x_end, 2 * 1000 * 5, 1e-6);
  EXPECT_EQ(steps.back().x_end, 0);
}

TEST(Lookahead, NothingIsGivenOutBeforeItsSpeedIsKnown) {
  Lookahead lookahead(4096);
  for (int i = 0; i < 500; ++i) {
    add(lookahead, straight(0.01, 1e6));
    Lookahead::Step step;
    EXPECT_FALSE(lookahead.take(step));
  }
}

TEST(Lookahead, StopInTheMiddleIsAStop) {
  Lookahead lookahead(64);
  add(lookahead, straight(10, 100));
  lookahead.stop_here();
  add(lookahead, straight(10, 100));
  lookahead.finish();
  const auto steps = take_all(lookahead);
  ASSERT_EQ(steps.size(), 2u);
  EXPECT_EQ(steps[0].x_end, 0);
  EXPECT_FALSE(steps[0].last);
  EXPECT_TRUE(steps[1].last);
}

// The streamed result is that of planning all at once, and each step's constant acceleration is within the
// limits.
TEST(Lookahead, StreamingChangesNothing) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const auto pick = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    std::vector<PlanPiece> pieces;
    for (int i = 0; i < 3000; ++i) {
      PlanPiece piece = straight(std::exp(pick(-5, 1)), std::exp(pick(0, 9)), pick(500, 3000));
      if (pick(0, 1) < 0.5) {
        piece.curved = true;
        piece.k2 = std::pow(piece.accel / piece.cap * pick(0, 1), 2);
        piece.c = std::sqrt(piece.k2) * pick(0, 0.5);
      }
      if (pick(0, 1) < 0.3) {
        piece.linear = true;
        piece.up0 = pick(100, 3000);
        piece.up1 = pick(0, 1) < 0.2 ? 0 : pick(0, 3000);
        piece.down0 = pick(100, 3000);
        piece.down1 = pick(0, 3000);
      }
      pieces.push_back(piece);
    }
    Lookahead whole(8192), streamed(8192);
    std::vector<double> ends, streamed_ends;
    for (const auto& piece : pieces) add(whole, piece);
    whole.finish();
    Lookahead::Step step;
    while (whole.take(step)) {
      const double a = (step.x_end - step.x_start) / (2 * step.length);
      const double low = std::min(step.x_start, step.x_end), high = std::max(step.x_start, step.x_end);
      const double allowed =
          a > 0 ? step.piece->accel_between(low, high) : step.piece->decel_between(low, high);
      EXPECT_LE(std::abs(a), allowed * (1 + 1e-6) + 1e-6);
      EXPECT_LE(high, step.piece->cap);
      ends.push_back(step.x_end);
    }
    for (const auto& piece : pieces) {
      add(streamed, piece);
      while (streamed.take(step)) streamed_ends.push_back(step.x_end);
    }
    streamed.finish();
    while (streamed.take(step)) streamed_ends.push_back(step.x_end);
    EXPECT_EQ(ends, streamed_ends);
  }
}

TEST(PhaseEmitter, SpeedsAndLengthsAddUp) {
  Lookahead lookahead(64);
  add(lookahead, straight(10, 2500));
  add(lookahead, straight(10, 900));
  lookahead.finish();
  PhaseEmitter emitter;
  Lookahead::Step step;
  double v = 0, length = 0;
  int phases = 0;
  while (lookahead.take(step)) {
    emitter.start(step);
    Phase phase;
    double s = 0;
    while (emitter.next(phase)) {
      EXPECT_NEAR(phase.v0, v, 1e-12);
      EXPECT_NEAR(phase.s0, s, 1e-12);
      EXPECT_LE(std::abs(phase.a), 1000 * (1 + 1e-12));
      v = phase.speed(phase.duration_s);
      s = phase.s(phase.duration_s);
      ++phases;
    }
    EXPECT_NEAR(s, 10, 1e-12);
    length += s;
  }
  EXPECT_NEAR(v, 0, 1e-12);
  EXPECT_NEAR(length, 20, 1e-12);
  EXPECT_EQ(phases, 5);  // up, cruise, down to 30 mm/s; cruise, down
}

}  // namespace
}  // namespace kinebus
