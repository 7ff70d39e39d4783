// What the node costs its processor, or the simulation its time: a frame, a look at the positions, a
// deadline.

#include <benchmark/benchmark.h>

#include "node_firmware/core/node.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

CanFrame record(const Segment& segment) {
  CanFrame frame{.id = 0x401, .length = 8};
  put_u64_le(frame.data, encode(segment));
  return frame;
}

/// A node in the middle of a stream at full rate, with SYNC as the gateway sends it.
class Streaming {
 public:
  Streaming() {
    node_.on_frame(now_, CanFrame::make(0x000, {1, 1}));
    for (const int word : {6, 7, 15}) {
      const auto byte = static_cast<std::uint8_t>(word);
      node_.on_frame(now_, CanFrame::make(0x201, {byte, 0, byte, 0, 7, 7}));
    }
    for (int i = 0; i < 30; ++i) {
      now_ += LocalTime{1'000'000};
      pass_sync();
    }
    node_.on_frame(now_, record({.sequence = 0, .control = SegmentControl::kStart, .start_units = 10'000}));
    for (int i = 0; i < 60; ++i) feed();
    node_.on_frame(now_, encode(RateCommand{.rate_q15 = kFullRateQ15, .start = now_}));
  }
  /// 4 ms with one record, as on a curved path.
  void step() {
    now_ += LocalTime{4'000'000};
    if (now_ >= next_sync_) pass_sync();
    feed();
    if (now_ >= node_.next_deadline()) node_.on_time(now_);
    drain();
  }
  Node& node() { return node_; }
  LocalTime now() const { return now_; }

 private:
  void drain() {
    while (node_.next_frame()) {
    }
  }
  void feed() {
    sign_ = -sign_;
    node_.on_frame(
        now_, record({.sequence = next_, .duration = 250, .acceleration = {sign_ * 50'000, sign_ * -9'000}}));
    next_ = static_cast<std::uint8_t>((next_ + 1) % kSequenceModulus);
    drain();
  }
  void pass_sync() {
    counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
    node_.on_frame(now_, CanFrame::make(0x080, {counter_}));
    node_.on_frame(now_, encode(SyncStamp{.counter = counter_, .epoch = 1, .time = now_}));
    next_sync_ = now_ + LocalTime{50'000'000};
    drain();
  }

  LocalTime now_{0}, next_sync_{0};
  LoneNode node_{{.node_id = 1}, LocalTime{0}};
  std::uint8_t next_ = 1, counter_ = 0;
  std::int32_t sign_ = -1;
};

void StreamedRecord(benchmark::State& state) {
  Streaming stream;
  for (auto _ : state) stream.step();
  if (stream.node().path().stop_latched()) state.SkipWithError("the stream stopped");
}
BENCHMARK(StreamedRecord);

void PositionsEveryMillisecond(benchmark::State& state) {
  Streaming stream;
  int looks = 0;
  for (auto _ : state) {
    if (++looks % 4 == 0) {
      state.PauseTiming();
      stream.step();
      state.ResumeTiming();
    }
    const LocalTime at = stream.now() + LocalTime{1'000'000} * (looks % 4);
    benchmark::DoNotOptimize(stream.node().position(at, 0));
    benchmark::DoNotOptimize(stream.node().position(at, 1));
  }
}
BENCHMARK(PositionsEveryMillisecond);

void NextDeadline(benchmark::State& state) {
  Streaming stream;
  stream.step();
  for (auto _ : state) benchmark::DoNotOptimize(stream.node().next_deadline());
}
BENCHMARK(NextDeadline);

}  // namespace
}  // namespace kinebus
