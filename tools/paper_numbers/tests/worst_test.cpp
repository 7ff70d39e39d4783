#include "tools/paper_numbers/worst.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/description/shipped_machines.hpp"

namespace kinebus::papers {
namespace {

TEST(Worst, FindsAHillThatNoGridPointStandsOn) {
  const Room room{150, {-5, 250}, {-0.7, 0.8}};
  const Worst worst = worst_over(room, [](const Pose& p) {
    return 3 -
           1e-4 * ((p[0] - 31.7) * (p[0] - 31.7) + (p[1] + 88.3) * (p[1] + 88.3) +
                   (p[2] - 97.1) * (p[2] - 97.1)) -
           (p[3] - 0.123) * (p[3] - 0.123);
  });
  EXPECT_NEAR(worst.value, 3, 1e-9);
  EXPECT_NEAR(worst.pose[0], 31.7, 1e-2);
  EXPECT_NEAR(worst.pose[3], 0.123, 1e-3);
}

TEST(Worst, KeepsToTheRoomAndToWhatCounts) {
  const Room room{100, {0, 200}, {-0.5, 0.5}};
  const Worst worst = worst_over(room, [](const Pose& p) { return p[0] > 40 ? -HUGE_VAL : p[0] + p[2]; });
  EXPECT_NEAR(worst.value, 240, 1e-6);
  EXPECT_LE(std::hypot(worst.pose[0], worst.pose[1]), 100 + 1e-9);
}

TEST(Worst, NoSampleOfTheShippedMachineIsWorseThanTheSearch) {
  const auto machine = machine_of("m1");
  ASSERT_TRUE(machine) << machine.error();
  const auto kinematics = make_kinematics(*machine);
  ASSERT_TRUE(kinematics);
  const Room room{100, {0, 200}, std::get<M1Geometry>(machine->kinematics).limits.a_rad};
  const auto condition = [&](const Pose& pose) {
    JointVector q{};
    return (*kinematics)->inverse(Frame::kPart, pose, q) ? (*kinematics)->condition(Frame::kPart, pose)
                                                         : -HUGE_VAL;
  };
  const Worst worst = worst_over(room, condition);
  std::mt19937_64 engine(3);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  for (int n = 0; n < 100'000; ++n) {
    // Half of them on the rims, where extremes lie.
    const double r = n % 2 == 0 ? room.radius_mm : uniform(0, room.radius_mm), f = uniform(-3.2, 3.2);
    const double z = n % 4 < 2   ? uniform(room.z_mm.min, room.z_mm.max)
                     : n % 8 < 4 ? room.z_mm.min
                                 : room.z_mm.max;
    const double a = n % 3 == 0   ? uniform(room.a_rad.min, room.a_rad.max)
                     : n % 3 == 1 ? room.a_rad.min
                                  : room.a_rad.max;
    ASSERT_LE(condition({r * std::cos(f), r * std::sin(f), z, a, 0, 0}), worst.value * (1 + 1e-9))
        << "sample " << n;
  }
}

}  // namespace
}  // namespace kinebus::papers
