// The handshake of set-points, in the words of IEC 61800-7-201: one moves, one waits, a third is refused.
#include "node_firmware/core/profile_position.hpp"

#include <gtest/gtest.h>

namespace kinebus::testing_set_points {
namespace {

constexpr std::uint16_t kNew = 1 << 4, kAtOnce = 1 << 5, kOnSetPoint = ProfilePosition::kChangeOnSetPoint;
constexpr ProfileLimits kLimits{10'000, 100'000, 100'000};

class Bench {
 public:
  Bench() { motion.hold(0); }
  void word(std::uint16_t word, std::int64_t counts = 0, ProfileLimits limits = kLimits) {
    set_points.on_controlword(now, word, {from_counts(counts), limits}, motion);
  }
  /// The whole handshake.
  void give(std::int64_t counts, std::uint16_t more = 0) {
    word(kNew | more, counts);
    EXPECT_TRUE(set_points.acknowledged());
    word(more, counts);
  }
  void pass(ProfileTicks ticks) {
    const ProfileTicks looked = now;
    now += ticks;
    set_points.on_time(now, looked, motion);
  }
  std::int64_t position() const { return motion.at(now).position; }
  std::int64_t target() const { return motion.target() / kOneCount; }
  bool reached() const { return set_points.reached(now, motion); }
  std::int64_t base() const { return set_points.base(motion) / kOneCount; }

  ProfilePosition set_points;
  Trapezoid motion;
  ProfileTicks now = 1000;
};

constexpr ProfileTicks kSecond = kTicksPerSecond;

TEST(ProfilePosition, ARisingEdgeTakesASetPointAndTheFallingOneEndsTheAcknowledge) {
  Bench b;
  EXPECT_FALSE(b.set_points.acknowledged());
  EXPECT_TRUE(b.reached());
  b.word(0, 500);
  EXPECT_EQ(b.target(), 0) << "no edge";
  b.word(kNew, 500);
  EXPECT_TRUE(b.set_points.acknowledged());
  EXPECT_EQ(b.target(), 500);
  EXPECT_FALSE(b.reached());
  EXPECT_EQ(b.base(), 500);
  b.word(kNew, 900);
  EXPECT_EQ(b.target(), 500) << "the bit stays: no other";
  b.word(0, 900);
  EXPECT_FALSE(b.set_points.acknowledged()) << "there is room for the next one";
  b.pass(kSecond);
  EXPECT_EQ(b.position(), from_counts(500));
  EXPECT_TRUE(b.reached());
}

TEST(ProfilePosition, TheSecondWaitsAndBeginsWhereAndWhenTheFirstEnds) {
  Bench b;
  b.give(500);
  b.pass(1600);
  const ProfileTicks end = b.motion.end();
  b.word(kNew, 800);
  EXPECT_TRUE(b.set_points.acknowledged());
  EXPECT_EQ(b.target(), 500) << "moves on to the first";
  EXPECT_EQ(b.base(), 800) << "a relative one counts from the one that waits";
  b.word(0);
  EXPECT_TRUE(b.set_points.acknowledged()) << "no room";
  b.pass(end - b.now - 10);
  EXPECT_EQ(b.target(), 500);
  b.pass(5000);
  EXPECT_EQ(b.target(), 800);
  EXPECT_FALSE(b.reached());
  EXPECT_FALSE(b.set_points.acknowledged()) << "room again";
  Trapezoid alone;
  alone.move(end, {from_counts(500), 0}, from_counts(800), kLimits);
  EXPECT_EQ(b.motion.end(), alone.end()) << "at the instant of the end, not when it was seen";
  b.pass(kSecond);
  EXPECT_EQ(b.position(), from_counts(800));
  EXPECT_TRUE(b.reached());
}

TEST(ProfilePosition, OneThatStoodInTheMeantimeBeginsNow) {
  Bench b;
  b.give(500);
  b.give(800);
  // Looked at after the end already, and nothing was done: a halt, say.
  const ProfileTicks end = b.motion.end();
  b.now = end + 8000;
  b.set_points.on_time(b.now, end + 1, b.motion);
  Trapezoid alone;
  alone.move(b.now, {from_counts(500), 0}, from_counts(800), kLimits);
  EXPECT_EQ(b.motion.end(), alone.end());
  Bench c;
  c.give(500);
  c.give(800);
  const ProfileTicks then = c.motion.end();
  c.now = then + 8000;
  c.set_points.on_time(c.now, then, c.motion);
  EXPECT_LT(c.motion.end(), then + (alone.end() - end) - 7000) << "seen before: from its end on";
}

TEST(ProfilePosition, AThirdIsRefusedUntilThereIsRoom) {
  Bench b;
  b.give(500);
  b.give(800);
  EXPECT_TRUE(b.set_points.acknowledged());
  b.word(kNew, 1200);
  EXPECT_EQ(b.base(), 800);
  b.pass(b.motion.end() - b.now + 1);
  ASSERT_EQ(b.target(), 800);
  // The bit still stands: it is asked for once more, and there is room now.
  b.word(kNew, 1200);
  EXPECT_EQ(b.base(), 1200);
  EXPECT_EQ(b.target(), 800);
  b.word(0);
  // One that was given up with its bit is not taken later.
  b.word(kNew, 7000);
  b.word(0);
  b.pass(b.motion.end() - b.now + 1);
  ASSERT_EQ(b.target(), 1200);
  b.word(0);
  EXPECT_EQ(b.base(), 1200);
  b.pass(kSecond);
  EXPECT_EQ(b.position(), from_counts(1200));
  EXPECT_TRUE(b.reached());
}

TEST(ProfilePosition, AtOnceTakesThePlaceOfBoth) {
  Bench b;
  b.give(500);
  b.give(800);
  b.pass(1600);
  b.word(kNew | kAtOnce, -300);
  EXPECT_TRUE(b.set_points.acknowledged());
  EXPECT_EQ(b.target(), -300);
  EXPECT_EQ(b.base(), -300);
  b.word(0);
  EXPECT_FALSE(b.set_points.acknowledged()) << "the one that waited is gone";
  b.pass(kSecond);
  EXPECT_EQ(b.position(), from_counts(-300));
  EXPECT_TRUE(b.reached());
  // At rest the one that comes without the bit begins at once, too.
  b.give(100);
  EXPECT_EQ(b.target(), 100);
}

TEST(ProfilePosition, ChangedOnSetPointTheFirstIsPassedAtSpeedInTheSameDirectionAlone) {
  for (const std::int64_t next : {800, 200}) {
    for (const bool on_set_point : {false, true}) {
      Bench b;
      b.give(500);
      b.pass(16'000);
      b.give(next, on_set_point ? kOnSetPoint : std::uint16_t{0});
      const ProfileState at = b.motion.at(b.motion.end());
      EXPECT_EQ(at.position, from_counts(500));
      EXPECT_EQ(at.velocity != 0, on_set_point && next == 800) << next;
      b.pass(kSecond);
      EXPECT_EQ(b.target(), next);
      b.pass(kSecond);
      EXPECT_EQ(b.position(), from_counts(next));
    }
  }
  // The other way round.
  Bench b;
  b.give(-500);
  b.pass(16'000);
  b.give(-800, kOnSetPoint);
  EXPECT_LT(b.motion.at(b.motion.end()).velocity, 0);
}

TEST(ProfilePosition, AfterAHaltItGoesOnAndAfterAResetThereIsNothing) {
  Bench b;
  b.give(500);
  b.pass(16'000);
  b.motion.stop(b.now, b.motion.at(b.now), 100'000);
  b.now = b.motion.end() + 100;
  b.set_points.resume(b.now, b.motion);
  EXPECT_EQ(b.target(), 500);
  EXPECT_GT(b.motion.end(), b.now);
  b.motion.stop(b.now, b.motion.at(b.now), 100'000);
  b.now = b.motion.end() + 100;
  const std::int64_t stands = b.motion.target();
  b.set_points.reset(kNew);
  b.set_points.resume(b.now, b.motion);
  EXPECT_EQ(b.motion.target(), stands);
  EXPECT_EQ(b.set_points.base(b.motion), stands) << "a relative one counts from where it stands";
  EXPECT_FALSE(b.set_points.acknowledged());
  b.word(kNew, 900);
  EXPECT_EQ(b.motion.target(), stands) << "the bit stood already";
  b.word(0);
  b.word(kNew, 900);
  EXPECT_EQ(b.target(), 900);
}

}  // namespace
}  // namespace kinebus::testing_set_points
