// Lines a second, on text like that of slicers.

#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "gateway/gcode/programs/job_reader.hpp"

using namespace kinebus;

namespace {

constexpr int kLines = 10000;

/// "G1 X39.781 Y23.435 E1.737", as PrusaSlicer writes perimeters; every 20th line has a comment or a feed.
std::string sliced_text() {
  std::string text = "G21\nG90\nM82\nG92 E0\nG1 Z.2 F12000\n";
  char line[80];
  double e = 0;
  for (int i = 0; i < kLines; ++i) {
    const double angle = i * 0.01;
    e += 0.01234;
    if (i % 20 == 10)
      std::snprintf(line, sizeof line, ";TYPE:External perimeter\n");
    else
      std::snprintf(line, sizeof line, "G1 X%.3f Y%.3f E%.5f%s\n", 40 * std::cos(angle), 40 * std::sin(angle),
                    e, i % 20 == 0 ? " F1800" : "");
    text += line;
  }
  return text;
}

std::string five_axis_text() {
  std::string text = "G21 G90 M83 G43.4\nG1 F6000\n";
  char line[120];
  for (int i = 0; i < kLines; ++i) {
    const double angle = i * 0.01;
    std::snprintf(line, sizeof line, "G1 X%.4f Y%.4f Z%.4f A%.4f C%.4f E0.01234\n", 40 * std::cos(angle),
                  40 * std::sin(angle), i * 0.001, 10 * std::sin(angle), angle * 57.29578);
    text += line;
  }
  return text;
}

void run(benchmark::State& state, const std::string& text) {
  gcode::CommandBuffer out;
  out.reserve(4096);
  std::int64_t lines = 0;
  while (state.KeepRunning()) {
    gcode::Interpreter interpreter;
    gcode::JobReader reader(interpreter);
    for (std::size_t at = 0; at < text.size(); at += 65536) {
      out.clear();
      if (!reader.read(std::string_view(text).substr(at, 65536), out)) state.SkipWithError("refused");
      benchmark::DoNotOptimize(out.data());
    }
    lines += reader.lines();
  }
  state.SetItemsProcessed(lines);
  state.counters["per_line"] = benchmark::Counter(static_cast<double>(lines),
                                                  benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void sliced(benchmark::State& state) {
  run(state, sliced_text());
}
void five_axis(benchmark::State& state) {
  run(state, five_axis_text());
}

}  // namespace

BENCHMARK(sliced);
BENCHMARK(five_axis);
