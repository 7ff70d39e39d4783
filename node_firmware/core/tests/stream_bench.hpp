#pragma once
// Three nodes with different crystals, and the gateway's side of their streams.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {

inline constexpr int kNodes = 3;
// After a second of SYNCs; it falls with their number (clock_estimate_test measures that).
inline constexpr double kSkewUs = 4.0;

/// The gateway's side of one node's stream: exact states, sequence, credit.
struct Feed {
  std::uint8_t id = 1;
  std::uint8_t sequence = 0;
  std::array<AxisState, 2> state{};
  std::int64_t knot_units = 0;

  std::uint8_t next() {
    const std::uint8_t n = sequence;
    sequence = static_cast<std::uint8_t>((sequence + 1) % kSequenceModulus);
    return n;
  }
  CanFrame frame(std::uint32_t base, std::uint64_t raw) const {
    CanFrame f{.id = base + id, .length = 8};
    put_u64_le(f.data, raw);
    return f;
  }
  CanFrame start(std::int64_t units) {
    knot_units = units;
    return frame(
        0x400, encode(Segment{.sequence = next(), .control = SegmentControl::kStart, .start_units = units}));
  }
  CanFrame end() {
    return frame(0x400, encode(Segment{.sequence = next(), .control = SegmentControl::kEnd}));
  }
  CanFrame segment(std::uint16_t units, std::int32_t a, std::int32_t b) {
    state[0] = advance(state[0], a, units, kDefaultAccelerationShift);
    state[1] = advance(state[1], b, units, kDefaultAccelerationShift);
    knot_units += units;
    return frame(0x400, encode(Segment{.sequence = next(), .duration = units, .acceleration = {a, b}}));
  }
  CanFrame checkpoint(int axis) const {
    return frame(0x500, encode(Checkpoint{sequence, static_cast<std::uint8_t>(axis),
                                          state[static_cast<std::size_t>(axis)].position}));
  }
};

inline std::vector<NodeSetup> three() {
  return {{.id = 1, .drift_ppm = 40, .offset = 123ms},
          {.id = 2, .drift_ppm = -35, .offset = 98'765us},
          {.id = 3, .drift_ppm = 5, .offset = 7s}};
}

struct StreamTest : testing::Test {
  StreamTest() : bench(three()) {
    for (int i = 0; i < kNodes; ++i) feeds[static_cast<std::size_t>(i)].id = static_cast<std::uint8_t>(i + 1);
    bench.bring_up();
    for (int id = 1; id <= kNodes; ++id) {
      bench.write(static_cast<std::uint8_t>(id), 0x2115, 0, 2, 5);  // starvation margin 5 ms
      for (int axis = 0; axis < 2; ++axis) bench.enable(static_cast<std::uint8_t>(id), axis, 7);
    }
  }
  std::int64_t tau_units() { return bench.node().path_time(bench.local()).count() / kPathTicksPerUnit; }

  /// A wave that comes back to its start: every node with other accelerations, `blocks` times 4 x 20 ms.
  void start_all(std::int64_t ahead_units) {
    const std::int64_t at = tau_units() + ahead_units;
    for (Feed& feed : feeds) bench.send(feed.start(at));
  }
  void wave(int blocks, bool checkpoints = true) {
    for (int i = 0; i < blocks; ++i)
      for (const int sign : {1, -1, -1, 1})
        for (Feed& feed : feeds) {
          if (checkpoints) bench.send(feed.checkpoint(i & 1));
          bench.send(feed.segment(1250, sign * (600'000 + 1000 * feed.id), -sign * 250'000 * feed.id));
        }
  }
  void end_all() {
    for (Feed& feed : feeds) bench.send(feed.end());
  }
  /// All of a wave is in the queues, and path time has run for `so_far` of it.
  void move_through_wave(int blocks, BusTime so_far) {
    start_all(1000);
    wave(blocks);
    end_all();
    bench.run(50ms);
    bench.rate(1.0);
    watch(so_far);
  }
  StreamStatus status(int i) {
    const CanFrame* frame = bench.last(0x281u + static_cast<unsigned>(i));
    return frame == nullptr ? StreamStatus{} : decode_stream_status(get_u64_le(frame->data));
  }
  /// Largest difference of path time between the nodes now, us.
  double skew_us() {
    std::int64_t low = INT64_MAX, high = INT64_MIN;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const std::int64_t tau = bench.node(i).path_time(bench.local(i)).count();
      low = std::min(low, tau);
      high = std::max(high, tau);
    }
    return static_cast<double>(high - low) / 16;
  }
  /// Runs with eyes on skew and on steps of any axis.
  void watch(BusTime span, double most_skew_us = kSkewUs) {
    std::array<std::array<std::int64_t, 2>, kNodes> last{};
    bool first = true;
    bench.run(span, 500us, [&] {
      EXPECT_LE(skew_us(), most_skew_us) << bench.now.count();
      for (std::size_t i = 0; i < kNodes; ++i)
        for (int axis = 0; axis < 2; ++axis) {
          const std::int64_t here = bench.position(i, axis);
          std::int64_t& before = last[i][static_cast<std::size_t>(axis)];
          // The waves reach 110,000 counts/s: 55 counts in 500 us.
          if (!first) {
            EXPECT_LE(std::abs(here - before), from_counts(60)) << "node " << i + 1;
          }
          before = here;
        }
      first = false;
    });
  }
  bool all_rest() {
    for (std::size_t i = 0; i < kNodes; ++i)
      if (bench.node(i).path_rate_q32(bench.local(i)) != 0) return false;
    return true;
  }
  void expect_stopped_together(double most_skew_us = kSkewUs) {
    EXPECT_TRUE(all_rest());
    EXPECT_LE(skew_us(), most_skew_us);
    for (int i = 0; i < kNodes; ++i) {
      EXPECT_TRUE(status(i).flags & StreamStatus::kStopped) << i;
      EXPECT_TRUE(bench.node(static_cast<std::size_t>(i)).drive(0).power);
      EXPECT_TRUE(bench.node(static_cast<std::size_t>(i)).drive(0).holding);
    }
  }
  void expect_at_feeds_end() {
    for (std::size_t i = 0; i < kNodes; ++i)
      for (int axis = 0; axis < 2; ++axis)
        EXPECT_EQ(bench.node(i).user_position(bench.local(i), axis),
                  feeds[i].state[static_cast<std::size_t>(axis)].position);
  }

  Bench bench;
  std::array<Feed, kNodes> feeds{};
};

}  // namespace kinebus::testing_bench
