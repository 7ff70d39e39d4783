// Time of the correction in the path.

#include <benchmark/benchmark.h>

#include "gateway/calibration/joint_map.hpp"

namespace kinebus {
namespace {

/// Periodic error and a table of 11 places, as the sampler asks for every span.
void map_a_joint(benchmark::State& state) {
  JointCalibration c;
  c.pitch = 10;
  c.periodic_sine = 0.01;
  c.table_start = 530;
  c.table_step = 50;
  c.table = {0, 0.02, -0.01, 0.03, 0, 0.01, 0, -0.01, 0.02, 0, 0.01};
  const JointMap map(c);
  double q = 530;
  for (auto _ : state) {
    q = q > 1000 ? 530 : q + 0.7;
    benchmark::DoNotOptimize(map.at(q));
  }
}

BENCHMARK(map_a_joint);

}  // namespace
}  // namespace kinebus
