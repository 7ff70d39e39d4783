#include "gateway/motion/path_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

TEST(PathDistance, MeasuresToTheLineBesideThePose) {
  PathDistance path;
  Job job;
  job.to({10, 0, 0, 0, 0, 0}).to({10, 10, 0, 0, 0, 0});
  for (const auto& line : job.lines()) path.add(line);
  EXPECT_NEAR(path.distance_mm({5, 0.3, 0, 0, 0, 0}, 2), 0.3, 1e-12);
  EXPECT_EQ(path.nearest_line(), 2u);
  EXPECT_NEAR(path.distance_mm({10.3, -0.4, 0, 0, 0, 0}, 3), 0.5, 1e-12);
  EXPECT_NEAR(path.distance_mm({10, 4, 0.2, 0, 0, 0}, 3), 0.2, 1e-12);
  EXPECT_EQ(path.nearest_line(), 3u);
}

TEST(PathDistance, MeasuresToArcsAndHelices) {
  PathDistance path;
  Job job({10, 0, 0, 0, 0, 0});
  job.arc({10, 0, 4, 0, 0, 0}, {0, 0, 0}, {0, 0, 1}, 4 * std::numbers::pi);
  for (const auto& line : job.lines()) path.add(line);
  EXPECT_NEAR(path.distance_mm({0, 10.01, 0.5, 0, 0, 0}, 2), 0.01, 1e-6);
  EXPECT_NEAR(path.distance_mm({-9.98, 0, 3, 0, 0, 0}, 2), 0.02, 1e-6);
}

TEST(PathDistance, FollowsADenseCurveAndForgetsWhatLiesBehind) {
  const Lines lines = dense_curve(5000, 10, 100, 0, 0);  // 1 m around a curve of 70 mm: it comes back often
  PathDistance path;
  std::size_t fed = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    for (; fed < lines.size() && fed < i + 100; ++fed) path.add(lines[fed]);
    Pose pose = std::get<canonical::Feed>(lines[i].command).target;
    pose[kZ] += 0.003;
    const double distance = path.distance_mm(pose, lines[i].line + 20);
    EXPECT_LE(distance, 0.003 + 1e-9);
    EXPECT_GE(distance, 0.0025);  // the curve climbs
    EXPECT_LE(std::abs(static_cast<double>(path.nearest_line()) - static_cast<double>(lines[i].line)), 2);
  }
}

TEST(PathDistance, ARowOfRetractionsDoesNotEndTheSearch) {
  PathDistance path;
  Job job;
  job.to({10, 0, 0, 0, 0, 0});
  for (int i = 1; i <= 10; ++i) job.to({10, 0, 0, 0, 0, static_cast<double>(i % 2)});
  job.to({10, 10, 0, 0, 0, 0});
  for (const auto& line : job.lines()) path.add(line);
  EXPECT_NEAR(path.distance_mm({9.9, 0.01, 0, 0, 0, 0}, 2), 0.01, 1e-12);
  EXPECT_NEAR(path.distance_mm({10.01, 1, 0, 0, 0, 0}, 20), 0.01, 1e-12);
}

TEST(PathDistance, PassesOfACycleThatShareTheirCornersAreNotSkipped) {
  // Deeper each time, from one corner and back to it, as G71 and G76 cut, all of one line.
  PathDistance path;
  std::vector<Pose> corners{{}};
  for (int pass = 1; pass <= 6; ++pass)
    for (const Pose& corner :
         {Pose{0.3 * pass, 0, 0}, Pose{0.3 * pass, 10, 0}, Pose{0, 10, 0}, Pose{0, 0, 0}})
      corners.push_back(corner);
  for (std::size_t i = 1; i < corners.size(); ++i)
    path.add({5, canonical::Feed{corners[i], Frame::kMachine, 10, 0}});
  constexpr int kSteps = 50;
  for (std::size_t i = 1; i < corners.size(); ++i)
    for (int step = 0; step <= kSteps; ++step) {
      Pose pose{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        pose[axis] = std::lerp(corners[i - 1][axis], corners[i][axis], static_cast<double>(step) / kSteps);
      pose[kZ] = 2e-4;  // as the tool is beside its plan
      ASSERT_LE(path.distance_mm(pose, 5), 3e-4) << "move " << i << ", step " << step;
    }
}

TEST(PathDistance, WithoutMovesThereIsNothingToLeave) {
  PathDistance path;
  EXPECT_EQ(path.distance_mm({1, 2, 3, 0, 0, 0}, 1), 0);
}

}  // namespace
}  // namespace kinebus::probe
