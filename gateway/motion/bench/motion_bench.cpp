// Planner speed, and job time against the time-optimal speed profile on the same path.

#include <benchmark/benchmark.h>

#include <cstdlib>

#include "gateway/kinematics/geometry.hpp"
#include "gateway/motion/tests/trajectory_probe.hpp"

namespace kinebus::probe {
namespace {

const Kinematics& m1() {
  static const auto machine = make_m1_kinematics(M1Geometry{});
  return **machine;
}

void plan(benchmark::State& state, const Lines& lines) {
  if (lines.empty()) {
    state.SkipWithError("no job: set KINEBUS_SLICED_FILE to a sliced file");
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

void BM_PlanSlicedFile(benchmark::State& state) {
  const char* path = std::getenv("KINEBUS_SLICED_FILE");
  plan(state, path == nullptr ? Lines{} : sliced_file(path));
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

BENCHMARK(BM_PlanSlicedFile)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlanRandomPrint)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlanDenseCurve)->Unit(benchmark::kMillisecond);
BENCHMARK(BM_PlanDenseFiveAxisCurve)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinebus::probe
