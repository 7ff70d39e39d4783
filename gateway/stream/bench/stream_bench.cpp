// Frames and CPU of the stream stage on M1, and what other encodings would take.
//   Sampler     phases -> spans                 Group      phases -> frames of all nodes
//   Segmenter   spans -> segments of node 1..3  Encodings  frames a second at equal joint error

#include <benchmark/benchmark.h>

#include <map>
#include <string>

#include "gateway/stream/bench/encodings.hpp"
#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/stream_group.hpp"
#include "gateway/stream/tests/m1_axes.hpp"
#include "gateway/stream/tests/motions.hpp"

namespace kinebus::bench {
namespace {

using namespace kinebus::testing;

struct Motion {
  const char* name;
  std::vector<Phase> phases;
  double lines;  ///< that a job would have for it
};

const std::vector<Motion>& motions() {
  static const std::vector<Motion> all = [] {
    std::vector<Motion> m;
    const auto lines = [&](const char* name, const PrintedLines& shape) {
      m.push_back({name, printed_lines(1, shape), static_cast<double>(shape.lines)});
    };
    const auto curve = [&](const char* name, const SmoothCurve& shape) {  // 0.2 mm a line
      m.push_back({name, smooth_curve(4, shape), shape.seconds * shape.speed_mm_per_s / 0.2});
    };
    lines("print 5 mm 60 mm/s", {.lines = 1000});
    lines("print 1 mm 60 mm/s", {.lines = 1000, .mean_length_mm = 1});
    lines("travel 40 mm 150 mm/s", {.lines = 200, .mean_length_mm = 40, .speed_mm_per_s = 150});
    lines("slow 30 mm 10 mm/s", {.lines = 100, .mean_length_mm = 30, .speed_mm_per_s = 10});
    curve("curve 100 mm/s", {.seconds = 20});
    curve("curve 1 mm pieces", {.seconds = 20, .piece_mm = 1});
    curve("curve, five axes", {.seconds = 20, .tilt_rad = 0.4, .turn_rad = 1});
    return m;
  }();
  return all;
}

const std::vector<JointSpan>& spans_of(const Motion& motion) {
  static std::map<std::string, std::vector<JointSpan>> cache;
  auto& spans = cache[motion.name];
  if (spans.empty()) spans = sample(*m1(), motion.phases);
  return spans;
}

double seconds(const std::vector<JointSpan>& spans) {
  return spans.back().start_s + spans.back().duration_s;
}

std::size_t segments_of(Segmenter& segmenter, const std::vector<JointSpan>& spans) {
  segmenter.start(standing_at(segmenter.node(), spans.front()));
  std::size_t k = 0, n = 0;
  while (!segmenter.ended()) {
    while (k < spans.size() && segmenter.has_room()) segmenter.push(spans[k++]);
    if (segmenter.next()) ++n;
  }
  return n;
}

void sampler(benchmark::State& state) {
  const Motion& motion = motions()[static_cast<std::size_t>(state.range(0))];
  const auto kinematics = m1();
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(n += sample(*kinematics, motion.phases).size());
  state.SetLabel(motion.name);
  state.counters["span_time"] =
      benchmark::Counter(static_cast<double>(n), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(sampler)->Name("Sampler")->DenseRange(0, 6);

void segmenter(benchmark::State& state) {
  const Motion& motion = motions()[static_cast<std::size_t>(state.range(0))];
  const auto& spans = spans_of(motion);
  Segmenter segmenter(m1_axes()[static_cast<std::size_t>(state.range(1))]);
  std::size_t n = 0;
  for (auto _ : state) benchmark::DoNotOptimize(n = segments_of(segmenter, spans));
  state.SetLabel(motion.name);
  state.counters["segments_per_s"] = static_cast<double>(n) / seconds(spans);
  state.counters["tries"] = static_cast<double>(segmenter.counters().candidates) /
                            static_cast<double>(segmenter.counters().segments);
  state.counters["worst_ratio"] = segmenter.counters().worst_ratio;
  state.counters["loose"] = static_cast<double>(segmenter.counters().loose);
  state.counters["axis_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(n) * kAxesPerNode,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(segmenter)->Name("Segmenter")->ArgsProduct({benchmark::CreateDenseRange(0, 6, 1), {0, 1, 2}});

/// Ideal nodes: every record is accepted at once and executed by its time.
std::size_t frames_of(StreamGroup& group, const std::vector<Phase>& phases,
                      const std::vector<JointSpan>& spans) {
  std::array<StreamStatus, 3> status{};
  for (std::size_t n = 0; n < 3; ++n) {
    status[n] = {.free_records = 120, .flags = StreamStatus::kSynchronised};
    group.set_state(static_cast<std::uint8_t>(n + 1), standing_at(m1_axes()[n], spans.front()), status[n]);
  }
  group.begin_run();
  group.release(PathTime{0});
  std::size_t frames = 0, k = 0;
  BusTime now{0};
  PathTime tau{0};
  while (!group.run_done(tau)) {
    while (k < phases.size() && group.wants_phases(tau))
      if (!group.push(phases[k++])) return 0;
    while (const auto frame = group.next_frame(now, tau)) {
      ++frames;
      const std::uint32_t node = (frame->id & 0x7F) - 1;
      if ((frame->id & 0x780u) == 0x400u)
        status[node].next_sequence = (status[node].next_sequence + 1) & 0x7F;
    }
    now += std::chrono::milliseconds{50};
    tau += PathTime{16'000 * 50};
    for (std::size_t n = 0; n < 3; ++n) {
      status[n].path_units = static_cast<std::uint32_t>(tau.count() / kPathTicksPerUnit);
      if (!group.on_status(now, static_cast<std::uint8_t>(n + 1), status[n], tau)) return 0;
    }
  }
  return frames;
}

void group(benchmark::State& state) {
  const Motion& motion = motions()[static_cast<std::size_t>(state.range(0))];
  const auto& spans = spans_of(motion);
  const auto kinematics = m1();
  std::size_t frames = 0;
  for (auto _ : state) {
    StreamGroup all(*kinematics, m1_axes());
    frames = frames_of(all, motion.phases, spans);
  }
  state.SetLabel(motion.name);
  state.counters["frames_per_s"] = static_cast<double>(frames) / seconds(spans);
  state.counters["line_time"] = benchmark::Counter(static_cast<double>(state.iterations()) * motion.lines,
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(group)->Name("Group")->DenseRange(0, 6)->Unit(benchmark::kMillisecond);

void encodings(benchmark::State& state) {
  const Motion& motion = motions()[static_cast<std::size_t>(state.range(0))];
  const auto& spans = spans_of(motion);
  double constant = 0, cubic = 0, timed = 0;
  for (auto _ : state) {
    constant = cubic = timed = 0;
    for (const NodeAxes& node : m1_axes()) {
      Segmenter segmenter(node);
      constant += static_cast<double>(segments_of(segmenter, spans));
      for (const AxisScaling& axis : node.axes) {
        cubic += static_cast<double>(cubic_frames(spans, axis, {}));
        timed += static_cast<double>(cubic_frames(spans, axis, {.grid_s = 1e-3, .longest_s = 0.255}));
      }
    }
  }
  state.SetLabel(motion.name);
  state.counters["two_axis_acceleration"] = constant / seconds(spans);
  state.counters["one_axis_cubic"] = cubic / seconds(spans);
  state.counters["position_velocity_time"] = timed / seconds(spans);
}
BENCHMARK(encodings)->Name("Encodings")->DenseRange(0, 6)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinebus::bench
