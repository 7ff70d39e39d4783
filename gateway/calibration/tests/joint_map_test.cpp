#include "gateway/calibration/joint_map.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numbers>

namespace kinebus {
namespace {

double in(double low, double high) {
  return low + (high - low) * static_cast<double>(*rc::gen::inRange<std::uint64_t>(0, 1ull << 53)) * 0x1p-53;
}

JointCalibration any() {
  JointCalibration c;
  c.pitch = in(2, 40);
  c.periodic_sine = in(-0.02, 0.02);
  c.periodic_cosine = in(-0.02, 0.02);
  c.table_start = in(-100, 500);
  c.table_step = in(5, 50);
  c.table.resize(*rc::gen::inRange<std::size_t>(2, 20));
  for (double& v : c.table) v = in(-0.1, 0.1);
  return c;
}

TEST(JointMap, NothingMeasuredChangesNothing) {
  const JointMap map(JointCalibration{});
  EXPECT_EQ(map.to_drive(123.25), 123.25);
  EXPECT_EQ(map.to_joint(123.25), 123.25);
  EXPECT_EQ(map.at(5).g1, 1);
}

TEST(JointMap, ValuesOfTheTableAreHitAndJointsComeBack) {
  EXPECT_TRUE(rc::check([] {
    JointCalibration c = any();
    c.pitch = 0;
    const JointMap map(c);
    for (std::size_t i = 0; i < c.table.size(); ++i) {
      const double q = c.table_start + c.table_step * static_cast<double>(i);
      RC_ASSERT(std::abs(q - map.to_drive(q) - c.table[i]) < 1e-12);
    }
    const JointMap both(any());
    const double q = in(-300, 1500);
    RC_ASSERT(std::abs(both.to_joint(both.to_drive(q)) - q) < 1e-10);
  }));
}

TEST(JointMap, DerivativesAreThoseOfTheValueAndContinuous) {
  EXPECT_TRUE(rc::check([] {
    const JointCalibration c = any();
    const JointMap map(c);
    const double q = in(c.table_start - 50, c.table_start + 1000), h = 1e-4;
    const auto low = map.at(q - h), mid = map.at(q), high = map.at(q + h);
    RC_ASSERT(std::abs((high.g - low.g) / (2 * h) - mid.g1) < 1e-6);
    RC_ASSERT(std::abs((high.g1 - low.g1) / (2 * h) - mid.g2) < 1e-5);
    RC_ASSERT(std::abs(1 - mid.g1) <= map.largest_slope() * (1 + 1e-9));
    RC_ASSERT(std::abs(mid.g2) <= map.largest_curvature() * (1 + 1e-9));
    // Both sides of a knot agree in value, slope and bend.
    const double knot = c.table_start + c.table_step * static_cast<double>(*rc::gen::inRange<int>(0, 20));
    const auto a = map.at(knot - 1e-9), b = map.at(knot + 1e-9);
    RC_ASSERT(std::abs(a.g - b.g) < 1e-8);
    RC_ASSERT(std::abs(a.g1 - b.g1) < 1e-8);
    RC_ASSERT(std::abs(a.g2 - b.g2) < 1e-7);
  }));
}

TEST(JointReserve, TheMotorKeepsItsLimitsWhateverTheJointDoesBelowTheReserve) {
  EXPECT_TRUE(rc::check([] {
    JointCalibration c = any();
    c.pitch = in(4, 40);
    c.table_step = in(20, 50);
    c.backlash = in(0, 0.2);
    const double speed = in(50, 450), accel = in(500, 5000);
    const JointReserve r = reserve_for(c, speed, accel);
    if (r.accel_per_s2 <= 0.06 * accel || r.speed_per_s <= 0.06 * speed)
      RC_DISCARD("beyond what is reserved");
    const JointMap map(c);
    const auto at = map.at(in(0, 1000));
    const double v = r.speed_per_s, a = r.accel_per_s2;
    RC_ASSERT(std::abs(at.g1) * v + std::sqrt(r.take_up_per_s2 * c.backlash) <= speed * (1 + 1e-9));
    RC_ASSERT(std::abs(at.g1) * a + std::abs(at.g2) * v * v + r.take_up_per_s2 <= accel * (1 + 1e-9));
  }));
}

}  // namespace
}  // namespace kinebus
