// Planner speed, and job time against the time-optimal speed profile on the same path.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <variant>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/path_distance.hpp"
#include "gateway/motion/tests/jerk_optimal.hpp"
#include "gateway/motion/tests/time_optimal.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

const Kinematics& m1() {
  static const auto machine = make_m1_kinematics(M1Geometry{});
  return **machine;
}

void plan(benchmark::State& state, const Lines& lines) {
  if (lines.empty()) {
    state.SkipWithError("no moves in the job");
    return;
  }
  double seconds = 0;
  Planner::Counters counters;
  for (auto _ : state) {
    Planner planner(m1(), MotionLimits{});
    Phase phase;
    seconds = 0;
    for (const auto& line : lines) {
      if (!planner.add(line)) state.SkipWithError("not planned");
      while (!planner.wants_more() && planner.next(phase)) seconds += phase.duration_s;
    }
    if (!planner.finish()) state.SkipWithError("not planned");
    while (planner.next(phase)) seconds += phase.duration_s;
    counters = planner.counters();
  }
  const auto moves = static_cast<double>(counters.moves);
  state.counters["per_move"] =
      benchmark::Counter(moves, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["moves"] = moves;
  state.counters["job_s"] = seconds;
  state.counters["merged"] = static_cast<double>(counters.merged_moves) / moves;
  state.counters["pieces"] = static_cast<double>(counters.pieces) / moves;
  state.counters["phases"] = static_cast<double>(counters.phases) / moves;
}

void BM_PlanRandomPrint(benchmark::State& state) {
  plan(state, random_print(1, 100'000));
}
void BM_PlanDenseCurve(benchmark::State& state) {
  plan(state, dense_curve(100'000, 30, 100, 0, 0));
}
void BM_PlanDenseFiveAxisCurve(benchmark::State& state) {
  plan(state, dense_curve(100'000, 30, 100, 0.5, 1));
}
BENCHMARK(BM_PlanRandomPrint)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlanDenseCurve)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlanDenseFiveAxisCurve)->Unit(benchmark::kMillisecond);

/// Job time over that of the time-optimal profile on the same path under the same limits.
void over_optimal(benchmark::State& state, const Lines& lines, double feed) {
  for (auto _ : state) {
    const MotionLimits limits;
    const Measured m = measure(m1(), limits, lines, 4, true);
    const double best = time_optimal_s(m1(), limits, m.all, feed, 0.02);
    state.counters["job_s"] = m.duration_s;
    state.counters["optimal_s"] = best;
    state.counters["over_optimal"] = m.duration_s / best;
    state.counters["joint_accel_ratio"] = m.joint_accel_ratio;
  }
}

Lines at_feed(Lines lines, double feed) {
  for (auto& line : lines) {
    if (auto* move = std::get_if<canonical::Feed>(&line.command)) move->feed_per_s = feed;
  }
  return lines;
}

void BM_OverOptimalPrint(benchmark::State& state) {
  over_optimal(state, at_feed(random_print(7, 2000), 100), 100);
}
void BM_OverOptimalDenseCurve(benchmark::State& state) {
  over_optimal(state, dense_curve(3000, 30, 300, 0, 0), 300);
}
void BM_OverOptimalTiltedCurve(benchmark::State& state) {
  over_optimal(state, dense_curve(3000, 30, 300, 0.5, 1), 300);
}
BENCHMARK(BM_OverOptimalPrint)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_OverOptimalDenseCurve)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_OverOptimalTiltedCurve)->Iterations(1)->Unit(benchmark::kMillisecond);

/// With a jerk of 100,000 mm/s3: job time over that without jerk limit and over the sampled optimum.
void over_jerk_optimal(benchmark::State& state, const Lines& lines) {
  for (auto _ : state) {
    MotionLimits limits;
    const Measured trapezoids = measure(m1(), limits, lines, 4, false);
    limits.tool_jerk_mm_per_s3 = 100'000;
    for (std::size_t j = 0; j < kMaxJoints; ++j)
      limits.joint_jerk_per_s3[j] =
          limits.tool_jerk_mm_per_s3 * limits.joint_accel_per_s2[j] / limits.tool_accel_mm_per_s2;
    const Measured m = measure(m1(), limits, lines, 4, true);
    std::map<std::uint32_t, double> feeds;
    for (const auto& line : lines)
      if (const auto* move = std::get_if<canonical::Feed>(&line.command)) feeds[line.line] = move->feed_per_s;
    const auto feed = [&feeds](std::uint32_t line) {
      const auto found = feeds.find(line);
      return found == feeds.end() ? kUnlimited : found->second;
    };
    const JerkOptimum best = jerk_optimal(m1(), limits, m.all, feed, 0.1);
    state.counters["trapezoid_s"] = trapezoids.duration_s;
    state.counters["job_s"] = m.duration_s;
    state.counters["optimal_s"] = best.time_s;
    state.counters["over_optimal"] = m.duration_s / best.time_s;
    state.counters["optimal_over_trapezoid"] = best.time_s / trapezoids.duration_s;
    state.counters["joint_jerk_ratio"] = m.joint_jerk_ratio;
    state.counters["phases_ratio"] = static_cast<double>(m.phases) / static_cast<double>(trapezoids.phases);
  }
}

/// So many moves from the middle of a job.
Lines middle_of(const Lines& lines, std::size_t moves) {
  if (lines.size() <= moves) return lines;
  const std::size_t from = (lines.size() - moves) / 2;
  Pose at{};
  for (std::size_t i = 0; i < from; ++i) {
    if (const auto* move = std::get_if<canonical::Feed>(&lines[i].command)) at = move->target;
    if (const auto* move = std::get_if<canonical::Traverse>(&lines[i].command)) at = move->target;
  }
  Lines part{{0, canonical::SetPosition{at, Frame::kPart}}};
  part.insert(part.end(), lines.begin() + static_cast<std::ptrdiff_t>(from),
              lines.begin() + static_cast<std::ptrdiff_t>(from + moves));
  return part;
}

void BM_OverJerkOptimalPrint(benchmark::State& state) {
  over_jerk_optimal(state, random_print(7, 300));
}
void BM_OverJerkOptimalDenseCurve(benchmark::State& state) {
  over_jerk_optimal(state, dense_curve(3000, 30, 100, 0, 0));
}
void BM_OverJerkOptimalTiltedCurve(benchmark::State& state) {
  over_jerk_optimal(state, dense_curve(3000, 30, 100, 0.5, 1));
}
BENCHMARK(BM_OverJerkOptimalPrint)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_OverJerkOptimalDenseCurve)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_OverJerkOptimalTiltedCurve)->Iterations(1)->Unit(benchmark::kMillisecond);

void BM_PathDistance(benchmark::State& state) {
  const Lines lines = dense_curve(20'000, 30, 100, 0, 0);
  PathDistance path;
  for (const auto& line : lines) path.add(line);
  std::size_t at = 1;
  for (auto _ : state) {
    if (++at == lines.size()) {
      state.PauseTiming();
      path = PathDistance{};
      for (const auto& line : lines) path.add(line);
      at = 1;
      state.ResumeTiming();
    }
    Pose pose = std::get<canonical::Feed>(lines[at].command).target;
    pose[kX] += 0.002;
    benchmark::DoNotOptimize(path.distance_mm(pose, lines[at].line + 30));
  }
}
BENCHMARK(BM_PathDistance);

// Sliced jobs are not in the repository: KINEBUS_SLICED_FILE names one, plain or .gz.
[[maybe_unused]] const bool kSlicedFile = [] {
  if (const char* path = std::getenv("KINEBUS_SLICED_FILE")) {
    benchmark::RegisterBenchmark("BM_PlanSlicedFile", [path](benchmark::State& state) {
      plan(state, sliced_file(path));
    })->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(
        "BM_OverJerkOptimalSlicedFile",
        [path](benchmark::State& state) { over_jerk_optimal(state, middle_of(sliced_file(path), 400)); })
        ->Iterations(1)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}();

}  // namespace
}  // namespace kinebus::probe
