// Time of the fits on as many readings as a person takes.

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "tools/calibrate/fit/geometry_fit.hpp"
#include "tools/calibrate/fit/rail_fit.hpp"

namespace kinebus {
namespace {

/// Readings every 5 mm forth and back, with scale, backlash, periodic error and 10 um of noise.
std::vector<RailSample> rail_readings() {
  std::mt19937_64 engine(1);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<RailSample> out;
  for (const int direction : {1, -1})
    for (int k = 0; k <= 100; ++k) {
      const double q = 530 + 5 * k;
      out.push_back(
          {q, q * 1.0014 + 0.01 * std::sin(q / 10 * 6.2832) - 0.03 * direction + noise(engine), direction});
    }
  return out;
}

void fit_a_rail(benchmark::State& state) {
  const auto samples = rail_readings();
  const RailFitOptions options{.anchor = 1030, .pitch = 10, .table_points = static_cast<int>(state.range(0))};
  for (auto _ : state) benchmark::DoNotOptimize(fit_rail(samples, options));
}

/// Touch probe readings of a machine whose switches and attachments are out by tenths of a millimetre.
void fit_the_geometry(benchmark::State& state) {
  MachineDeviation truth;
  truth.offset_mm = {0.25, -0.15, 0.1, -0.3};
  const GeometryModel model({}, {});
  std::mt19937_64 engine(2);
  std::normal_distribution<double> noise(0, 0.01);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine);
  };
  std::vector<GeometryReading> readings;
  while (static_cast<int>(readings.size()) < state.range(0)) {
    GeometryReading r;
    r.commanded = {uniform(-80, 80), uniform(-80, 80), uniform(0, 200), uniform(-0.7, 0.7), 0, 0};
    const auto tool = model.tool(truth, r.commanded);
    if (!tool) continue;
    for (std::size_t k = 0; k < 3; ++k) r.value_mm[k] = (*tool)[k] + noise(engine);
    r.has = {true, true, true};
    readings.push_back(r);
  }
  for (auto _ : state) benchmark::DoNotOptimize(fit_geometry(GeometryModel({}, readings), {}));
}

BENCHMARK(fit_a_rail)->ArgName("table")->Arg(0)->Arg(11);
BENCHMARK(fit_the_geometry)->ArgName("points")->Arg(40)->Arg(120)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinebus
