#pragma once
// A heat node with its plant in virtual time, and a master who speaks to it by frames alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "node_firmware/port/host/heat_plant.hpp"
#include "protocol/bytes.hpp"

namespace kinebus::heat {

using namespace std::chrono_literals;

class HeatNodeBench {
 public:
  static constexpr std::uint8_t kId = 20;
  static constexpr std::uint32_t kSerial = 4711;

  explicit HeatNodeBench(std::span<const std::uint8_t> image = {})
      : node({.node_id = kId, .serial = kSerial}, LocalTime{1s}, image) {
    run(0.2);
  }

  /// The hot end and the bed, described; `measured`: with a model, as a tuning of this plant finds it.
  void set_up(bool measured = true) {
    for (const int n : {1, 2, 3}) {
      // The plant's thermistor: 100 kOhm, beta 3950, on 4.7 kOhm.
      EXPECT_EQ(write({0x220A, sub(n)}, -50, 2), 0u);
      EXPECT_EQ(write({0x6110, sub(n)}, 10'100, 2), 0u);
    }
    if (measured) {
      const std::array<std::array<std::uint32_t, 4>, 2> models{
          {{3006, 5340, 1423, 1998}, {234, 1527, 7806, 5202}}};
      for (int n = 1; n <= 2; ++n)
        for (int i = 0; i < 4; ++i)
          EXPECT_EQ(write({static_cast<std::uint16_t>(0x2218 + i), sub(n)},
                          models[static_cast<std::size_t>(n - 1)][static_cast<std::size_t>(i)], 4),
                    0u);
    }
    EXPECT_EQ(write({0x2211, 2}, 1300, 2), 0u);
    EXPECT_EQ(write({0x221E, 2}, 60, 2), 0u);  // a bed is slow
    EXPECT_EQ(write({0x2210, 3}, 0, 1), 0u);   // the chamber's air has no heater
    confirm();
    run(0.3);
    nmt(NmtCommand::kStart);
  }

  /// The master means this node.
  void confirm() { EXPECT_EQ(write({0x2243, 0}, kSerial, 4), 0u); }

  /// A master that lives asks something every second.
  void run(double seconds, bool master = true) {
    const auto steps = static_cast<int>(seconds * 100 + 0.5);
    for (int i = 0; i < steps; ++i) {
      now += HeatPlant::kPeriod;
      if (master && ++idle_ % 100 == 0) static_cast<void>(read({0x1001, 0}));
      node.on_time(now);
      plant.step(node, now);
      collect();
    }
  }
  /// False: not within so many seconds.
  template <typename Condition>
  bool run_until(double seconds, const Condition& condition) {
    for (double t = 0; t < seconds; t += 0.1) {
      if (condition()) return true;
      run(0.1);
    }
    return condition();
  }

  void nmt(NmtCommand command) { send(nmt_frame(command, kId)); }
  void send(const CanFrame& frame) {
    node.on_frame(now, frame);
    collect();
  }
  /// 0: written; otherwise the abort code.
  std::uint32_t write(ObjectAddress a, std::uint32_t value, int bytes) {
    CanFrame request{.id = 0x600u + kId, .length = 8};
    request.data[0] = static_cast<std::uint8_t>(0x23 | (4 - bytes) << 2);
    put_u16_le(std::span(request.data).subspan(1), a.index);
    request.data[3] = a.subindex;
    put_u32_le(std::span(request.data).subspan(4), value);
    const auto reply = ask(request);
    if (!reply) return 1;
    return reply->data[0] == 0x60 ? 0 : get_u32_le(std::span(reply->data).subspan(4));
  }
  std::uint32_t write_set_point(int heater, int tenths) {
    return write({0x7402, sub(heater)}, static_cast<std::uint32_t>(tenths), 2);
  }
  /// nullopt: refused.
  std::optional<std::uint32_t> read(ObjectAddress a) {
    CanFrame request{.id = 0x600u + kId, .length = 8};
    request.data[0] = 0x40;
    put_u16_le(std::span(request.data).subspan(1), a.index);
    request.data[3] = a.subindex;
    const auto reply = ask(request);
    if (!reply || reply->data[0] == 0x80) return std::nullopt;
    const int bytes = 4 - (reply->data[0] >> 2 & 3);
    return static_cast<std::uint32_t>(
        get_le(std::span(reply->data).subspan(4), static_cast<std::size_t>(bytes)));
  }
  /// Emergencies with that code since the last forget().
  std::vector<CanFrame> emergencies(std::uint16_t code) const {
    std::vector<CanFrame> found;
    for (const CanFrame& frame : seen)
      if (frame.id == 0x080u + kId && get_u16_le(frame.data) == code) found.push_back(frame);
    return found;
  }
  void forget() { seen.clear(); }

  LocalTime now{1s};
  HeatNode node;
  HeatPlant plant;
  std::vector<CanFrame> seen;
  std::vector<std::uint8_t> stored;

 private:
  static std::uint8_t sub(int n) { return static_cast<std::uint8_t>(n); }
  std::optional<CanFrame> ask(const CanFrame& request) {
    const std::size_t before = seen.size();
    send(request);
    const auto reply = std::find_if(seen.begin() + static_cast<std::ptrdiff_t>(before), seen.end(),
                                    [](const CanFrame& frame) { return frame.id == 0x580u + kId; });
    if (reply == seen.end()) return std::nullopt;
    return *reply;
  }
  void collect() {
    for (bool more = true; more;) {
      while (const auto frame = node.next_frame()) seen.push_back(*frame);
      const auto image = node.image_to_store();
      more = !image.empty();
      if (!more) continue;
      stored.assign(image.begin(), image.end());
      node.on_image_stored(true);
    }
  }

  int idle_ = 0;
};

}  // namespace kinebus::heat
