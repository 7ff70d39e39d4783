// The scan in poses a second, and what is made of it.

#include <benchmark/benchmark.h>

#include "tools/workspace/boundary.hpp"
#include "tools/workspace/scan.hpp"

namespace kinebus::workspace {
namespace {

constexpr Room kRoom{150, -5, 250, -45 * kRadPerDeg, 45 * kRadPerDeg};

ScanOptions options(int threads) {
  ScanOptions out;
  out.step_mm = out.ray_step_mm = 10;
  out.threads = threads;
  return out;
}

void scan_m1(benchmark::State& state) {
  const auto m1 = make_m1_kinematics({});
  std::uint64_t poses = 0;
  for (auto _ : state) poses += scan(**m1, kRoom, options(static_cast<int>(state.range(0)))).poses;
  state.counters["poses"] = benchmark::Counter(static_cast<double>(poses), benchmark::Counter::kIsRate);
}

void find_the_cylinder(benchmark::State& state) {
  const auto m1 = make_m1_kinematics({});
  const Scan s = scan(**m1, kRoom, options(1));
  for (auto _ : state) benchmark::DoNotOptimize(largest_cylinder(s, -1));
}

void make_the_boundary(benchmark::State& state) {
  const auto m1 = make_m1_kinematics({});
  const Scan s = scan(**m1, kRoom, options(1));
  for (auto _ : state) benchmark::DoNotOptimize(boundary(s, -1));
}

BENCHMARK(scan_m1)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(find_the_cylinder)->Unit(benchmark::kMicrosecond);
BENCHMARK(make_the_boundary)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace kinebus::workspace
