// What a pose costs: all pairs measured, and along a path of 1 mm steps.

#include <benchmark/benchmark.h>

#include <cmath>

#include "gateway/bodies/sweep.hpp"
#include "gateway/bodies/tests/legs_below.hpp"

namespace kinebus::bodies {
namespace {

Pose on_path(int n) {
  const double t = n * 0.01;
  return {80 * std::cos(t), 80 * std::sin(t), 20 + 0.01 * (n % 10'000), 0.3 * std::sin(0.1 * t), 0, 0};
}

void BM_Place(benchmark::State& state) {
  const Model model = make_collision_model(legs_below());
  Scene scene = model->at_rest();
  int n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(model->place(Frame::kPart, on_path(n++), scene));
}
BENCHMARK(BM_Place);

void BM_Clearance(benchmark::State& state) {
  const Model model = make_collision_model(legs_below());
  int n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(model->clearance(Frame::kPart, on_path(n++)));
}
BENCHMARK(BM_Clearance);

void BM_Sweep(benchmark::State& state) {
  const Model model = make_collision_model(legs_below());
  Sweep sweep(*model);
  int n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(sweep.to(Frame::kPart, on_path(n++)));
}
BENCHMARK(BM_Sweep);

}  // namespace
}  // namespace kinebus::bodies
