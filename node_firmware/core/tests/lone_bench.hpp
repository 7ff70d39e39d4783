#pragma once
// One node without a bus: its SDO server asked at once, its power and its time by hand. For what a board, or
// the memory that it keeps its parameters in, does to a node.

#include "node_firmware/core/tests/node_bench.hpp"

namespace kinebus::testing_bench {

inline constexpr std::uint32_t kNoAnswer = 1;

struct Lone {
  explicit Lone(const NodeOptions& options = {.node_id = 1}, std::span<const std::uint8_t> stored = {})
      : node(options, LocalTime{1s}, stored) {
    pull();
  }

  void wait(BusTime span) {
    const LocalTime end = now + span;
    while (now < end) {
      now = std::max(std::min(node.next_deadline(), end), now + 10us);
      node.on_time(now);
      pull();
    }
  }
  void send(const CanFrame& frame) {
    now += 1ms;
    node.on_frame(now, frame);
    pull();
  }
  void send(std::string_view text) { send(frame_of(text)); }

  /// The abort code; 0: good, kNoAnswer.
  std::uint32_t write(std::uint16_t index, std::uint8_t sub, std::size_t size, std::int64_t value) {
    std::array<std::uint8_t, 8> bytes{};
    put_le(std::span(bytes), static_cast<std::uint64_t>(value));
    CanFrame request = about(size > 4 ? 0x21 : 0x23 | ((4 - size) << 2), index, sub);
    if (size > 4)
      request.data[4] = static_cast<std::uint8_t>(size);
    else
      std::copy_n(bytes.begin(), 4, request.data.begin() + 4);
    std::uint32_t code = code_of(ask(request));
    for (std::size_t at = 0; size > 4 && at < size && code == 0; at += 7) {
      const std::size_t part = std::min<std::size_t>(7, size - at);
      CanFrame segment{.id = 0x600u + node.node_id(), .length = 8};
      segment.data[0] =
          static_cast<std::uint8_t>((at == 0 ? 0 : 0x10) | ((7 - part) << 1) | (at + part == size ? 1u : 0u));
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), part, segment.data.begin() + 1);
      code = code_of(ask(segment));
    }
    return code;
  }
  /// Of what was asked last, and was not answered at once.
  std::uint32_t late_answer() const { return code_of(answer_.value_or(CanFrame{})); }
  std::int64_t read(std::uint16_t index, std::uint8_t sub) {
    CanFrame reply = ask(about(0x40, index, sub));
    EXPECT_EQ(code_of(reply), 0u) << std::hex << index << ":" << int{sub};
    const int place = find_object({index, sub});
    std::array<std::uint8_t, 16> bytes{};
    std::copy_n(reply.data.begin() + 4, 4, bytes.begin());
    if ((reply.data[0] & 2) == 0)
      for (std::size_t at = 0; at < 8; at += 7) {
        CanFrame next = about(at == 0 ? 0x60 : 0x70, 0, 0);
        reply = ask(next);
        std::copy_n(reply.data.begin() + 1, 7, bytes.begin() + static_cast<std::ptrdiff_t>(at));
      }
    return place < 0 ? 0 : value_of(kNodeObjects[static_cast<std::size_t>(place)].type, get_u64_le(bytes));
  }
  std::uint32_t read_code(std::uint16_t index, std::uint8_t sub) {
    return code_of(ask(about(0x40, index, sub)));
  }
  std::int64_t counter(NodeCounter which) { return read(0x2120, static_cast<std::uint8_t>(which)); }

  void control(int word, int axis = 0) {
    EXPECT_EQ(write(static_cast<std::uint16_t>(0x6040 + axis * 0x800), 0, 2, word), 0u);
  }
  /// Power, and with a mode the way to operation enabled.
  void power(int axis = 0) {
    control(0x06, axis);
    control(0x07, axis);
    EXPECT_TRUE(node.drive(axis).power);
  }
  void unpower(int axis = 0) {
    control(0x00, axis);
    EXPECT_FALSE(node.drive(axis).power);
  }
  void start_move(int axis = 0) {
    EXPECT_EQ(write(static_cast<std::uint16_t>(0x6060 + axis * 0x800), 0, 1, 1), 0u);
    power(axis);
    control(0x0F, axis);
    EXPECT_EQ(write(static_cast<std::uint16_t>(0x607A + axis * 0x800), 0, 4, 50'000), 0u);
    control(0x1F, axis);
    wait(20ms);
    EXPECT_TRUE(node.moving(now));
  }

  /// The gateway's clock is the node's own from here on: SYNC with its stamps, started, mode 7 is the stream.
  void synchronise() {
    send("000#0101");
    EXPECT_EQ(write(0x1019, 0, 1, 240), 0u);
    for (const std::uint16_t index : {std::uint16_t{0x60C0}, std::uint16_t{0x68C0}})
      EXPECT_EQ(write(index, 0, 2, -1), 0u);
    for (int i = 0; i < 100; ++i) sync();
  }
  void sync() {
    wait(5ms);
    counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
    const BusTime at = now;
    node.on_frame(at, CanFrame::make(0x080, {counter_}));
    send(encode(SyncStamp{.counter = counter_, .epoch = 1, .time = at}));
  }
  /// `wait`, with a SYNC every few milliseconds.
  void run(BusTime span) {
    for (const LocalTime end = now + span; now < end;) sync();
  }
  void broadcast(RateCommand::Kind kind, double rate = 0) {
    rate_counter_ = static_cast<std::uint8_t>((rate_counter_ + 1) & 0xF);
    send(encode(RateCommand{.kind = kind,
                            .counter = rate_counter_,
                            .rate_q15 = static_cast<std::uint16_t>(std::lround(rate * 32768)),
                            .full_ramp_2ms = 1,
                            .start = Bench::whole_us(now + 5ms)}));
    run(20ms);
  }
  void rate(double rate) { broadcast(RateCommand::Kind::kRate, rate); }
  void clear_stop() { broadcast(RateCommand::Kind::kClear); }
  bool stopped() const { return node.path().stop_latched(); }
  std::uint8_t stream_flags() {
    return decode_stream_status(static_cast<std::uint64_t>(read(0x2102, 0))).flags;
  }

  /// EMCY frames that it has sent of this code.
  int told(std::uint16_t code) const {
    return static_cast<int>(std::count_if(seen.begin(), seen.end(), [&](const CanFrame& frame) {
      return frame.id == 0x080u + node.node_id() && get_u16_le(frame.data) == code;
    }));
  }
  bool was_sent(std::string_view text) const {
    return std::any_of(seen.begin(), seen.end(),
                       [&](const CanFrame& frame) { return text_of(frame) == text; });
  }

  LocalTime now{1s};
  LoneNode node;
  std::vector<CanFrame> seen;  ///< all but the answers of its SDO server

 private:
  CanFrame about(std::size_t command, std::uint16_t index, std::uint8_t sub) const {
    CanFrame request{.id = 0x600u + node.node_id(), .length = 8};
    request.data[0] = static_cast<std::uint8_t>(command);
    put_u16_le(std::span(request.data).subspan(1), index);
    request.data[3] = sub;
    return request;
  }
  static std::uint32_t code_of(const CanFrame& reply) {
    if (reply.length == 0) return kNoAnswer;
    return reply.data[0] == 0x80 ? get_u32_le(std::span(reply.data).subspan(4)) : 0;
  }
  CanFrame ask(const CanFrame& request) {
    answer_.reset();
    send(request);
    return answer_.value_or(CanFrame{});
  }
  void pull() {
    while (const auto frame = node.next_frame()) {
      if (frame->id == 0x580u + node.node_id())
        answer_ = *frame;
      else
        seen.push_back(*frame);
    }
  }
  std::optional<CanFrame> answer_;
  std::uint8_t counter_ = 0, rate_counter_ = 0;
};

/// Both axes are on the stream, and its ramp is as short as it can be.
struct LoneStreamTest : testing::Test {
  LoneStreamTest() {
    lone.synchronise();
    EXPECT_EQ(lone.write(0x2113, 0, 2, 2), 0u);
    EXPECT_EQ(lone.write(0x2115, 0, 2, 0), 0u);
  }
  void follow() {
    for (const int axis : {0, 1}) {
      EXPECT_EQ(lone.write(static_cast<std::uint16_t>(0x6060 + axis * 0x800), 0, 1, 7), 0u);
      lone.power(axis);
      lone.control(0x0F, axis);
    }
  }
  void record(const Segment& segment) {
    Segment next = segment;
    next.sequence = sequence++;
    CanFrame frame{.id = 0x401, .length = 8};
    put_u64_le(frame.data, encode(next));
    lone.send(frame);
  }
  /// Records of 20 ms each, the first of them so far ahead of path time.
  void queue(const std::vector<std::int32_t>& accelerations, std::int64_t ahead_units = 100) {
    record({.control = SegmentControl::kStart,
            .start_units = lone.node.path_time(lone.now).count() / kPathTicksPerUnit + ahead_units});
    for (const std::int32_t a : accelerations) {
      state = advance(state, a, 1250, kDefaultAccelerationShift);
      record({.duration = 1250, .acceleration = {a, 0}});
    }
  }
  double counts(int axis = 0) {
    return std::ldexp(static_cast<double>(lone.node.position(lone.now, axis)), -32);
  }
  /// For so long nobody calls the node; then time is told to it.
  void stand_still(BusTime span) {
    lone.now += span;
    lone.node.on_time(lone.now);
    lone.wait(1ms);
  }

  Lone lone;
  std::uint8_t sequence = 0;
  AxisState state{};
};

}  // namespace kinebus::testing_bench
