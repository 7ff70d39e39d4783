// Time for one call of each kinematics function, over poses that change from call to call. Kinds: 0 M1 (and
// M2, M3), 1 Cartesian with a table, 2 CoreXY, 3 linear delta, 4 M4, 5 M1 with the tool on the platform.

#include <benchmark/benchmark.h>

#include <vector>

#include "gateway/kinematics/m4.hpp"
#include "gateway/kinematics/tests/random_pose.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kPoses = 256;

std::unique_ptr<Kinematics> machine(int kind) {
  if (kind == 0) return *make_m1_kinematics({});
  if (kind == 5) return *make_m1_kinematics(testing::hanging());
  if (kind == 1) return *make_cartesian_kinematics({.has_table = true});
  if (kind == 2) return *make_corexy_kinematics({});
  if (kind == 4) return *make_m4_kinematics({});
  return *make_linear_delta_kinematics({});
}

/// `tilted`: 0: A = C = 0 and at rest, as in most prints; 1: five axes move.
std::vector<PosePoint> paths(bool tilted) {
  testing::RandomPose random(11);
  std::vector<PosePoint> list;
  for (std::size_t n = 0; n < kPoses; ++n) {
    Pose x = random.in_m1_cylinder();
    x[kA] *= 0.5;  // what the mill (kind 4) reaches too
    PosePoint p = random.path_through(x);
    if (!tilted) p.x[kA] = p.x[kC] = p.x1[kA] = p.x1[kC] = p.x2[kA] = p.x2[kC] = 0;
    list.push_back(p);
  }
  return list;
}

void inverse(benchmark::State& state) {
  const auto kinematics = machine(static_cast<int>(state.range(0)));
  const auto list = paths(state.range(1) != 0);
  JointVector q{};
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kinematics->inverse(Frame::kPart, list[n++ % kPoses].x, q).has_value());
    benchmark::DoNotOptimize(q);
  }
}

void inverse_and_jacobian(benchmark::State& state) {
  const auto kinematics = machine(static_cast<int>(state.range(0)));
  const auto list = paths(state.range(1) != 0);
  JointVector q{};
  std::array<double, kMaxJoints * kPoseAxes> matrix{};
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kinematics->jacobian(Frame::kPart, list[n++ % kPoses].x, q, matrix).has_value());
    benchmark::DoNotOptimize(matrix);
  }
}

void inverse_along(benchmark::State& state) {
  const auto kinematics = machine(static_cast<int>(state.range(0)));
  const auto list = paths(state.range(1) != 0);
  JointPoint q;
  std::size_t n = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kinematics->inverse_along(Frame::kPart, list[n++ % kPoses], q).has_value());
    benchmark::DoNotOptimize(q);
  }
}

/// `warm`: 1: from 0.1 mm and 1 mrad away; 0: from any other pose of the workspace.
void forward(benchmark::State& state) {
  const auto kinematics = machine(static_cast<int>(state.range(0)));
  const bool warm = state.range(1) != 0;
  const auto list = paths(true);
  std::vector<JointVector> joints(kPoses);
  for (std::size_t n = 0; n < kPoses; ++n) (void)kinematics->inverse(Frame::kPart, list[n].x, joints[n]);
  std::size_t n = 0;
  for (auto _ : state) {
    const std::size_t k = n % kPoses;
    Pose pose = warm ? list[k].x : list[(n * 7 + 3) % kPoses].x;
    if (warm) {
      pose[kX] += 0.1;
      pose[kA] += 1e-3;
    }
    benchmark::DoNotOptimize(kinematics->forward(Frame::kPart, joints[k], pose).has_value());
    benchmark::DoNotOptimize(pose);
    ++n;
  }
}

void check(benchmark::State& state) {
  const auto kinematics = machine(static_cast<int>(state.range(0)));
  const auto list = paths(state.range(1) != 0);
  std::size_t n = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(kinematics->check(Frame::kPart, list[n++ % kPoses].x).has_value());
}

/// All assemblies of the mill for one set of inputs, by elimination.
void eliminate(benchmark::State& state) {
  const M4Geometry geometry;
  double shift = 0;
  for (auto _ : state) {
    shift = shift > 20 ? 0 : shift + 0.37;
    benchmark::DoNotOptimize(m4_assemblies(geometry, {932.6 + shift, 1029.4, 283.4 - shift}));
  }
}

BENCHMARK(eliminate);
BENCHMARK(inverse)->ArgNames({"kind", "five_axes"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}});
BENCHMARK(inverse_and_jacobian)->ArgNames({"kind", "five_axes"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}});
BENCHMARK(inverse_along)->ArgNames({"kind", "five_axes"})->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}});
BENCHMARK(forward)->ArgNames({"kind", "warm"})->ArgsProduct({{0, 3, 4, 5}, {0, 1}});
BENCHMARK(check)->ArgNames({"kind", "five_axes"})->ArgsProduct({{0, 3, 4, 5}, {0, 1}});

}  // namespace
}  // namespace kinebus
