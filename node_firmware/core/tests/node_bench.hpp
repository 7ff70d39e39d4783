#pragma once
// Nodes on a small bus in virtual time, each with a crystal of its own, for the tests of this folder. The
// bench plays the gateway: SYNC and stamps, rate broadcasts, SDO and NMT. A frame takes 130 us; receive
// interrupts are late by up to 20 us; switches are the rails' of AxisPlant.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "node_firmware/core/node.hpp"
#include "node_firmware/port/host/axis_plant.hpp"
#include "protocol/bytes.hpp"
#include "protocol/can/candump.hpp"
#include "protocol/motion/voucher.hpp"

namespace kinebus::testing_bench {

using namespace std::chrono_literals;

inline std::string text_of(const CanFrame& frame) {
  return std::string(to_text(frame).view());
}
inline CanFrame frame_of(std::string_view text) {
  const auto frame = parse_frame(text);
  EXPECT_TRUE(frame) << text;
  return frame.value_or(CanFrame{});
}

struct NodeSetup {
  std::uint8_t id = 1;
  double drift_ppm = 0;
  BusTime offset{0};
  std::array<AxisPlantOptions, 2> plant{};
  std::vector<std::uint8_t> stored{};
  bool told = true;  ///< what a gateway tells a node before it moves; otherwise it is as it comes
};

class Bench {
 public:
  struct Seen {
    BusTime at{0};
    CanFrame frame;
  };

  explicit Bench(const std::vector<NodeSetup>& setups, unsigned seed = 1) : random_(seed) {
    for (const NodeSetup& setup : setups) nodes_.push_back(std::make_unique<Station>(setup));
    settle();
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (setups[i].told) tell_what_a_gateway_tells(i);
  }

  Node& node(std::size_t i = 0) { return nodes_[i]->core; }
  LocalTime local(std::size_t i = 0) const { return nodes_[i]->local(now); }
  LocalTime local_at(std::size_t i, BusTime t) const { return nodes_[i]->local(t); }
  std::int64_t position(std::size_t i, int axis) { return node(i).position(local(i), axis); }

  /// Lets time pass. `look`: called every `every`.
  void run(BusTime span, BusTime every = 1h, const std::function<void()>& look = {}) {
    const BusTime end = now + span;
    BusTime next_look = now + every;
    for (;;) {
      BusTime next = std::min(end, next_look);
      if (!wire_.empty()) next = std::min(next, wire_.front().at);
      if (sync_period_ > 0ns) next = std::min(next, next_sync_);
      for (const auto& station : nodes_) {
        next = std::min(next, station->deadline);
        next = std::min(next, station->next_plant);
        if (!station->inbox.empty()) next = std::min(next, station->inbox.front().at);
      }
      now = std::max(next, now);
      step();
      if (look && now >= next_look) {
        look();
        next_look += every;
      }
      if (now >= end) return;
    }
  }

  /// Of the master, who vouches for it in a session.
  void send(const CanFrame& frame) {
    if (vouches && wants_voucher(frame)) stranger_sends(vouches->vouch_for(frame));
    stranger_sends(frame);
  }
  void stranger_sends(const CanFrame& frame) {
    BusTime start = std::max(now, bus_free_);
    bus_free_ = start + 130us;
    wire_.push_back({bus_free_, frame, -1});
  }
  const CanFrame& last_sent() const { return wire_.back().frame; }
  void send(std::string_view text) { send(frame_of(text)); }
  /// Gives all nodes a session's key.
  void begin_session() {
    const SipHashKey key{0x0706050403020100, 0x0f0e0d0c0b0a0908};
    for (std::uint8_t id = 1; id <= nodes_.size(); ++id) {
      for (std::uint8_t i = 0; i < 4; ++i)
        write(id, 0x2117, static_cast<std::uint8_t>(i + 1), 4,
              static_cast<std::uint32_t>((i < 2 ? key.low : key.high) >> (i % 2 * 32)));
      write(id, 0x2117, 5, 1, 1);
    }
    vouches.emplace(key);
  }
  void start_sync(BusTime period = 50ms) {
    sync_period_ = period;
    next_sync_ = now + 1ms;
  }
  void stop_sync() { sync_period_ = 0ns; }
  /// The gateway's clock starts anew: its time is the bench's and `ahead` from now on.
  void start_epoch(std::uint8_t epoch, BusTime ahead) {
    epoch_ = epoch;
    epoch_shift_ = ahead;
  }

  /// Clocks synchronised, nodes operational.
  void bring_up() {
    send(nmt_frame(NmtCommand::kStart, kAllNodes));
    start_sync(5ms);
    run(1s);
    stop_sync();
    start_sync();
    run(200ms);
  }
  void rate(double rate, BusTime ahead = 5ms, std::uint8_t ramp_2ms = 50) {
    counter_ = static_cast<std::uint8_t>((counter_ + 1) & 0xF);
    send(encode(RateCommand{.kind = RateCommand::Kind::kRate,
                            .counter = counter_,
                            .rate_q15 = static_cast<std::uint16_t>(std::lround(rate * 32768)),
                            .full_ramp_2ms = ramp_2ms,
                            .start = whole_us(now + epoch_shift_ + ahead)}));
  }
  void command(RateCommand::Kind kind, BusTime ahead = 5ms) {
    counter_ = static_cast<std::uint8_t>((counter_ + 1) & 0xF);
    send(encode(
        RateCommand{.kind = kind, .counter = counter_, .start = whole_us(now + epoch_shift_ + ahead)}));
  }
  static BusTime whole_us(BusTime t) { return BusTime{t.count() / 1000 * 1000}; }

  /// Writes by SDO and expects the answer to be good.
  void write(std::uint8_t id, std::uint16_t index, std::uint8_t sub, int size, std::int64_t value) {
    EXPECT_EQ(try_write(id, index, sub, size, value), 0u) << std::hex << index << ":" << int{sub};
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
  std::int64_t read(std::uint8_t id, std::uint16_t index, std::uint8_t sub) {
    CanFrame request{.id = 0x600u + id, .length = 8};
    request.data[0] = 0x40;
    put_u16_le(std::span(request.data).subspan(1), index);
    request.data[3] = sub;
    const CanFrame reply = transfer(request);
    EXPECT_EQ(reply.data[0] & 0xE0, 0x40) << text_of(reply);
    const int slot = find_object({index, sub});
    return slot < 0 ? 0
                    : value_of(kNodeObjects[static_cast<std::size_t>(slot)].type,
                               get_u32_le(std::span(reply.data).subspan(4)));
  }
  std::uint16_t statusword(std::uint8_t id, int axis) {
    return static_cast<std::uint16_t>(read(id, static_cast<std::uint16_t>(0x6041 + axis * 0x800), 0));
  }
  /// Operation enabled in a mode, by SDO alone.
  void enable(std::uint8_t id, int axis, int mode) {
    const auto at = [&](int index) { return static_cast<std::uint16_t>(index + axis * 0x800); };
    write(id, at(0x6060), 0, 1, mode);
    for (const int word : {0x06, 0x07, 0x0F}) write(id, at(0x6040), 0, 2, word);
    EXPECT_EQ(statusword(id, axis) & 0x6F, 0x27);
  }

  /// Frames that the nodes have sent, oldest first.
  std::vector<Seen> seen;
  bool was_seen(std::uint32_t id, std::size_t from = 0) const {
    return std::any_of(seen.begin() + static_cast<std::ptrdiff_t>(from), seen.end(),
                       [&](const Seen& s) { return s.frame.id == id; });
  }
  const CanFrame* last(std::uint32_t id) const {
    for (auto s = seen.rbegin(); s != seen.rend(); ++s)
      if (s->frame.id == id) return &s->frame;
    return nullptr;
  }
  BusTime now{0};
  bool plant_on = true;
  /// Frames to this COB-ID do not arrive at this node (a lost SYNC, for example).
  std::function<bool(std::size_t node, const CanFrame&)> lose;
  std::optional<VoucherWriter> vouches;  ///< the master is in a session

 private:
  struct Wire {
    BusTime at{0};
    CanFrame frame;
    int from = -1;
  };
  struct Station {
    explicit Station(const NodeSetup& s)
        : setup(s),
          plant{AxisPlant(s.plant[0]), AxisPlant(s.plant[1])},
          core({.identity = {.serial = s.id},
                .node_id = s.id,
                .scale_inputs = {plant[0].has_scale() ? ScaleInput::kQuadrature : ScaleInput::kNone,
                                 plant[1].has_scale() ? ScaleInput::kQuadrature : ScaleInput::kNone},
                .may_fit_scale = &Node::may_fit_scale},
               local(BusTime{0}), s.stored) {}
    LocalTime local(BusTime t) const {
      return t + setup.offset +
             LocalTime{std::llround(static_cast<double>(t.count()) * setup.drift_ppm * 1e-6)};
    }
    BusTime bus(LocalTime t) const {
      if (t == LocalTime::max()) return BusTime::max();
      const double since = static_cast<double>((t - setup.offset).count());
      return BusTime{static_cast<std::int64_t>(std::ceil(since / (1 + setup.drift_ppm * 1e-6))) + 1};
    }
    NodeSetup setup;
    std::array<AxisPlant, 2> plant;
    LoneNode core;
    std::deque<Wire> inbox;
    BusTime deadline{0};
    BusTime next_plant{0};
  };

  CanFrame transfer(const CanFrame& request) {
    const std::size_t before = seen.size();
    send(request);
    for (int i = 0; i < 50; ++i) {
      run(500us);
      for (std::size_t k = before; k < seen.size(); ++k)
        if (seen[k].frame.id == request.id - 0x80) return seen[k].frame;
    }
    ADD_FAILURE() << "no answer to " << text_of(request);
    return {};
  }

  /// SYNC with a counter (1019h), and mode 7 is the stream (60C0h). Not by the bus: at once.
  void tell_what_a_gateway_tells(std::size_t i) {
    Station& station = *nodes_[i];
    for (const char* data : {"2F191000F0000000", "2BC06000FFFF0000", "2BC06800FFFF0000"}) {
      CanFrame request = frame_of(std::string("600#") + data);
      request.id += station.setup.id;
      station.core.on_frame(station.local(now), request);
      while (station.core.next_frame()) {
      }
    }
  }
  void settle() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) pull(i);
  }
  void pull(std::size_t i) {
    Station& station = *nodes_[i];
    while (const auto frame = station.core.next_frame()) {
      const BusTime start = std::max(now, bus_free_);
      bus_free_ = start + 130us;
      wire_.push_back({bus_free_, *frame, static_cast<int>(i)});
    }
    station.deadline = std::max(station.bus(station.core.next_deadline()), now + 1us);
  }
  void step() {
    if (sync_period_ > 0ns && now >= next_sync_) {
      next_sync_ += sync_period_;
      sync_counter_ = static_cast<std::uint8_t>(sync_counter_ % 240 + 1);
      send(CanFrame::make(0x080, {sync_counter_}));
    }
    while (!wire_.empty() && wire_.front().at <= now) {
      const Wire item = wire_.front();
      wire_.pop_front();
      if (item.from >= 0) seen.push_back({item.at, item.frame});
      if (item.from < 0 && item.frame.id == 0x080)
        send(encode(
            SyncStamp{.counter = item.frame.data[0], .epoch = epoch_, .time = item.at + epoch_shift_}));
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (static_cast<int>(i) == item.from || (lose && lose(i, item.frame))) continue;
        auto& inbox = nodes_[i]->inbox;
        BusTime at = item.at + BusTime{static_cast<std::int64_t>(random_() % 20'000)};
        if (!inbox.empty()) at = std::max(at, inbox.back().at);
        inbox.push_back({at, item.frame, item.from});
      }
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      Station& station = *nodes_[i];
      while (!station.inbox.empty() && station.inbox.front().at <= now) {
        station.core.on_frame(station.local(station.inbox.front().at), station.inbox.front().frame);
        station.inbox.pop_front();
      }
      if (now >= station.next_plant && plant_on) {
        for (int axis = 0; axis < 2; ++axis) {
          const auto edge = station.plant[static_cast<std::size_t>(axis)].on_position(
              station.local(now), station.core.position(station.local(now), axis));
          station.core.set_scale(axis, station.plant[static_cast<std::size_t>(axis)].scale_counts());
          if (edge) station.core.on_switch(edge->at, edge->input, edge->level);
        }
        station.next_plant = now + (station.core.moving(station.local(now)) ? 1ms : 5ms);
      } else if (!plant_on) {
        station.next_plant = BusTime::max();
      }
      if (now >= station.deadline) station.core.on_time(station.local(now));
      pull(i);
    }
  }

  std::vector<std::unique_ptr<Station>> nodes_;
  std::deque<Wire> wire_;
  BusTime bus_free_{0};
  BusTime sync_period_{0}, next_sync_{0};
  std::uint8_t sync_counter_ = 0;
  std::uint8_t counter_ = 0;
  std::uint8_t epoch_ = 1;
  BusTime epoch_shift_{0};
  std::mt19937 random_;
};

}  // namespace kinebus::testing_bench
