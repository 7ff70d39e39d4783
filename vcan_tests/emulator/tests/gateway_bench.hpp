#pragma once
// The gateway's side of a bus with nodes under test, be they virtual or emulated: SYNC and stamps, SDO, drive
// states, rate broadcasts and streams, frame by frame.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "protocol/bytes.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "tools/simulation/bus/node_machine.hpp"

namespace kinebus::emulator {

using namespace std::chrono_literals;

class GatewayBench {
 public:
  struct Seen {
    BusTime at{0};
    CanFrame frame;
  };
  explicit GatewayBench(NodeMachine& nodes) : nodes_(nodes) {}

  /// Lets time pass; `look`, if set, every `every`.
  void run(BusTime span, BusTime every = 1h, const std::function<void()>& look = {}) {
    const BusTime end = now + span;
    BusTime next_look = now + every;
    while (now < end) {
      const BusTime next = std::min({end, next_look, sync_period_ > 0ns ? std::max(next_sync_, now) : end});
      const bool done = nodes_.advance(next);
      while (const auto got = nodes_.receive()) {
        now = std::max(now, got->when);
        if (!got->own)
          seen.push_back({got->when, got->frame});
        else if (got->frame.id == 0x080)
          waiting_.push_back(encode(SyncStamp{.counter = got->frame.data[0], .epoch = 1, .time = got->when}));
      }
      if (done) now = next;
      if (sync_period_ > 0ns && now >= next_sync_) {
        next_sync_ += sync_period_;
        sync_counter_ = static_cast<std::uint8_t>(sync_counter_ % 240 + 1);
        waiting_.insert(waiting_.begin(), CanFrame::make(0x080, {sync_counter_}));
      }
      push();
      if (look && now >= next_look) {
        look();
        next_look += every;
      }
    }
  }
  void send(const CanFrame& frame) {
    waiting_.push_back(frame);
    push();
  }
  void start_sync(BusTime period = 50ms) {
    sync_period_ = period;
    next_sync_ = now + 1ms;
  }
  void stop_sync() { sync_period_ = 0ns; }
  /// SYNC has a counter (1019h), and mode 7 is the stream (60C0h).
  void tell_stream_and_counter(std::uint8_t id) {
    write(id, 0x1019, 0, 1, 240);
    write(id, 0x60C0, 0, 2, -1);
    write(id, 0x68C0, 0, 2, -1);
  }
  /// Clocks synchronised, all nodes operational, mode 7 is the stream.
  void bring_up(std::initializer_list<std::uint8_t> ids) {
    for (const std::uint8_t id : ids) tell_stream_and_counter(id);
    send(nmt_frame(NmtCommand::kStart, kAllNodes));
    start_sync(5ms);
    run(1s);
    start_sync();
    run(100ms);
  }

  void rate(double rate, BusTime ahead = 5ms, std::uint8_t ramp_2ms = 50) {
    command({.kind = RateCommand::Kind::kRate,
             .rate_q15 = static_cast<std::uint16_t>(std::lround(rate * 32768)),
             .full_ramp_2ms = ramp_2ms},
            ahead);
  }
  void command(RateCommand::Kind kind, BusTime ahead = 5ms) { command(RateCommand{.kind = kind}, ahead); }
  /// As it was sent, with its counter and start.
  RateCommand command(RateCommand rate_command, BusTime ahead) {
    counter_ = static_cast<std::uint8_t>((counter_ + 1) & 0xF);
    rate_command.counter = counter_;
    rate_command.start = BusTime{(now + ahead).count() / 1000 * 1000};
    send(encode(rate_command));
    return rate_command;
  }

  /// The abort code, 0: good, 1: no answer.
  std::uint32_t try_write(std::uint8_t id, std::uint16_t index, std::uint8_t sub, int size,
                          std::int64_t value) {
    CanFrame request{.id = 0x600u + id, .length = 8};
    request.data[0] = static_cast<std::uint8_t>(0x23 | ((4 - size) << 2));
    put_u16_le(std::span(request.data).subspan(1), index);
    request.data[3] = sub;
    put_le(std::span(request.data).subspan(4), static_cast<std::uint32_t>(value));
    const CanFrame reply = transfer(request);
    if (reply.length == 0) return 1;
    return reply.data[0] == 0x80 ? get_u32_le(std::span(reply.data).subspan(4)) : 0;
  }
  void write(std::uint8_t id, std::uint16_t index, std::uint8_t sub, int size, std::int64_t value) {
    EXPECT_EQ(try_write(id, index, sub, size, value), 0u) << std::hex << index << ":" << int{sub};
  }
  /// The answer to an upload request, whole.
  CanFrame upload(std::uint8_t id, std::uint16_t index, std::uint8_t sub) {
    CanFrame request{.id = 0x600u + id, .length = 8};
    request.data[0] = 0x40;
    put_u16_le(std::span(request.data).subspan(1), index);
    request.data[3] = sub;
    return transfer(request);
  }
  std::int64_t read(std::uint8_t id, std::uint16_t index, std::uint8_t sub) {
    const CanFrame reply = upload(id, index, sub);
    EXPECT_EQ(reply.data[0] & 0xE0, 0x40) << std::hex << index << ":" << int{sub};
    const int slot = find_object({index, sub});
    return slot < 0 ? 0
                    : value_of(kNodeObjects[static_cast<std::size_t>(slot)].type,
                               get_u32_le(std::span(reply.data).subspan(4)));
  }
  /// An object of 64 bits, by segmented upload.
  std::int64_t read_long(std::uint8_t id, std::uint16_t index) {
    EXPECT_EQ(upload(id, index, 0).data[0], 0x41);
    std::array<std::uint8_t, 14> bytes{};
    for (std::uint8_t part = 0; part < 2; ++part) {
      CanFrame request{.id = 0x600u + id, .length = 8};
      request.data[0] = static_cast<std::uint8_t>(0x60 | part << 4);
      const CanFrame reply = transfer(request);
      for (std::size_t i = 0; i < 7; ++i) bytes[part * 7u + i] = reply.data[i + 1];
    }
    return static_cast<std::int64_t>(get_u64_le(bytes));
  }
  std::uint16_t statusword(std::uint8_t id, int axis) {
    return static_cast<std::uint16_t>(read(id, static_cast<std::uint16_t>(0x6041 + axis * 0x800), 0));
  }
  /// Operation enabled in a mode, by SDO alone.
  void enable(std::uint8_t id, int axis, int mode) {
    const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
    write(id, at(0x6060), 0, 1, mode);
    for (const int word : {0x06, 0x07, 0x0F}) {
      write(id, at(0x6040), 0, 2, word);
      run(5ms);
    }
    // The power stage ramps its current before the drive takes commands.
    for (int i = 0; i < 100 && (statusword(id, axis) & 0x6F) != 0x27; ++i) run(10ms);
    EXPECT_EQ(statusword(id, axis) & 0x6F, 0x27);
  }
  /// Profile position: begins a move to `counts` of 6064h.
  void move(std::uint8_t id, int axis, std::int64_t counts, std::int64_t speed, std::int64_t acceleration) {
    const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
    write(id, at(0x6081), 0, 4, speed);
    write(id, at(0x6083), 0, 4, acceleration);
    write(id, at(0x6084), 0, 4, acceleration);
    write(id, at(0x607A), 0, 4, counts);
    write(id, at(0x6040), 0, 2, 0x1F);
    write(id, at(0x6040), 0, 2, 0x0F);
  }
  bool reached(std::uint8_t id, int axis) { return (statusword(id, axis) & 0x0400) != 0; }

  const CanFrame* last(std::uint32_t id) const {
    for (auto s = seen.rbegin(); s != seen.rend(); ++s)
      if (s->frame.id == id) return &s->frame;
    return nullptr;
  }
  /// EMCY codes of a node since frame number `from` of `seen`, resets left out.
  std::vector<std::uint16_t> emergencies(std::uint8_t id, std::size_t from = 0) const {
    std::vector<std::uint16_t> codes;
    for (std::size_t i = from; i < seen.size(); ++i)
      if (seen[i].frame.id == 0x080u + id && get_u16_le(seen[i].frame.data) != 0)
        codes.push_back(get_u16_le(seen[i].frame.data));
    return codes;
  }

  std::vector<Seen> seen;
  BusTime now{0};

 private:
  void push() {
    while (!waiting_.empty() && nodes_.can_send()) {
      nodes_.send(now, waiting_.front());
      waiting_.erase(waiting_.begin());
    }
  }
  CanFrame transfer(const CanFrame& request) {
    const std::size_t before = seen.size();
    send(request);
    for (int i = 0; i < 100; ++i) {
      run(500us);
      for (std::size_t k = before; k < seen.size(); ++k)
        if (seen[k].frame.id == request.id - 0x80) return seen[k].frame;
    }
    ADD_FAILURE() << "no answer to " << to_text(request).view();
    return {};
  }

  NodeMachine& nodes_;
  std::vector<CanFrame> waiting_;
  BusTime sync_period_{0}, next_sync_{0};
  std::uint8_t sync_counter_ = 0, counter_ = 0;
};

/// The gateway's side of one node's stream: exact states and sequence.
struct StreamFeed {
  std::uint8_t id = 1;
  std::uint8_t sequence = 0;
  std::array<AxisState, 2> state{};
  std::int64_t begin_units = 0;
  struct Piece {
    std::array<AxisState, 2> from{};
    std::array<std::int32_t, 2> acceleration{};
    std::int64_t begin_units = 0, units = 0;
  };
  std::vector<Piece> pieces{};

  CanFrame start(std::int64_t units) {
    begin_units = units;
    return frame(
        encode(Segment{.sequence = next(), .control = SegmentControl::kStart, .start_units = units}));
  }
  CanFrame end() { return frame(encode(Segment{.sequence = next(), .control = SegmentControl::kEnd})); }
  CanFrame segment(std::uint16_t units, std::int32_t a, std::int32_t b) {
    pieces.push_back({state, {a, b}, begin_units, units});
    state[0] = advance(state[0], a, units, kDefaultAccelerationShift);
    state[1] = advance(state[1], b, units, kDefaultAccelerationShift);
    begin_units += units;
    return frame(encode(Segment{.sequence = next(), .duration = units, .acceleration = {a, b}}));
  }
  /// Where the axis is at path time `ticks`, 32 fractional bits: the definition, evaluated on its own.
  std::int64_t position(int axis, std::int64_t ticks) const {
    const auto a = static_cast<std::size_t>(axis);
    for (const Piece& p : pieces) {
      const std::int64_t into = ticks - p.begin_units * kPathTicksPerUnit;
      if (into < 0) return p.from[a].position;
      if (into < p.units * kPathTicksPerUnit)
        return position_at(p.from[a], p.acceleration[a], into, kDefaultAccelerationShift);
    }
    return state[a].position;
  }

 private:
  std::uint8_t next() {
    const std::uint8_t n = sequence;
    sequence = static_cast<std::uint8_t>((sequence + 1) % kSequenceModulus);
    return n;
  }
  CanFrame frame(std::uint64_t raw) const {
    CanFrame f{.id = 0x400u + id, .length = 8};
    put_u64_le(f.data, raw);
    return f;
  }
};

}  // namespace kinebus::emulator
