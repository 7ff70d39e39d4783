#pragma once
// Drivers without a chip behind them, for the tests of this folder.

#include <deque>
#include <utility>
#include <vector>

#include "node_firmware/board/bridge_motors.hpp"
#include "node_firmware/board/drivers.hpp"
#include "node_firmware/board/local_clock.hpp"

namespace kinebus::fake {

struct Counter {
  static inline PlanCounts now = 0;
  static PlanCounts counts() { return now; }
};
inline void pass_time(LocalTime time) {
  Counter::now += static_cast<PlanCounts>(time / kPlanCount);
}

/// Frames that were sent are on the bus at once.
class Can {
 public:
  struct Received {
    std::uint32_t counts = 0;
    CanFrame content;
    CanFrame frame() const { return content; }
  };
  void arrive(const CanFrame& frame, std::uint32_t counts = Counter::now) { in.push_back({counts, frame}); }
  const Received* front() const { return in.empty() ? nullptr : &in.front(); }
  void drop() { in.pop_front(); }
  TransmitQueue& queue() { return queue_; }
  void serve_mailboxes() {
    for (auto action = queue_.next(); action.kind == TransmitQueue::Action::Kind::kLoad;
         action = queue_.next()) {
      sent.push_back(action.frame);
      queue_.on_empty(action.mailbox, true);
    }
  }
  void accept(std::span<const CanAccept> filters) { accepted.assign(filters.begin(), filters.end()); }
  const CanEvents& events() const { return seen; }
  bool bus_off() const { return off; }

  bool heard(int id) const {
    for (const CanAccept& a : accepted)
      if ((id & a.mask) == a.value) return true;
    return false;
  }
  bool told(std::uint16_t emcy_code) const {
    for (const CanFrame& frame : sent)
      if ((frame.id & 0x780) == 0x080 && frame.length == 8 &&
          (frame.data[0] | frame.data[1] << 8) == emcy_code)
        return true;
    return false;
  }

  std::deque<Received> in;
  std::vector<CanFrame> sent;
  std::vector<CanAccept> accepted;
  CanEvents seen;
  bool off = false;

 private:
  TransmitQueue queue_;
};

struct Switches {
  const SwitchEdge* front() const { return in.empty() ? nullptr : &in.front(); }
  void drop() { in.pop_front(); }
  std::deque<SwitchEdge> in;
};

struct Watchdog {
  void feed() { ++feeds; }
  void allow_flash() { ++patient, ++allowed; }
  void back_to_normal() { --patient; }
  int feeds = 0, patient = 0, allowed = 0;
};

/// What a test wants to be measured; one, as a board has one.
struct Stage {
  static constexpr BridgeFacts kBridges{0.01F, 20'000};
  static constexpr float kCurrentZero = 2048, kMostZeroError = 100;

  static inline std::array<std::array<std::uint32_t, 2>, 2> steps{};
  static inline BridgeReadings measured{24, {25, 25}};
  static inline std::array<motor::AxisOutputs, 2> applied{};
  static inline std::array<motor::Vector, 2> zero{};
  static inline void (*control)() = nullptr;  ///< the control interrupt, while the main loop waits for it
  static inline int breaks = 0;
  static void forget() {
    steps = {{{2048, 2048}, {2048, 2048}}};
    measured = {24, {25, 25}};
    applied = {};
    zero = {};
    control = nullptr;
    breaks = 0;
  }

  void start() {}
  void wait_for_control() const {
    if (control != nullptr) control();
  }
  static std::uint32_t cycles() { return 168 * Counter::now / 4; }
  static PlanCounts counts() { return Counter::now; }
  static void acknowledge_control() {}
  static std::array<std::uint32_t, 2> raw(int axis) { return steps[static_cast<std::size_t>(axis)]; }
  motor::Vector currents(int axis) const {
    const auto i = static_cast<std::size_t>(axis);
    return {(static_cast<float>(steps[i][0]) - zero[i].x) / 256,
            (static_cast<float>(steps[i][1]) - zero[i].y) / 256};
  }
  void set_zero(int axis, float a, float b) { zero[static_cast<std::size_t>(axis)] = {a, b}; }
  void serve_slow() {}
  const BridgeReadings& readings() const { return measured; }
  static std::uint16_t take_encoder(int) { return 0xFFFF; }
  static void begin_encoder(int) {}
  void apply(int axis, const motor::AxisOutputs& outputs) {
    applied[static_cast<std::size_t>(axis)] = outputs;
  }
  bool dark() const { return !applied[0].power && !applied[1].power; }
  void on_break(int axis) {
    ++breaks;
    broken[static_cast<std::size_t>(axis)] = true;
  }
  bool take_break(int axis) { return std::exchange(broken[static_cast<std::size_t>(axis)], false); }
  std::array<bool, 2> broken{};
};

/// Operation enabled by SDO, as a master would.
inline void enable(Node& node, LocalTime& now, int axis) {
  const auto write = [&](std::uint16_t index, std::uint16_t value) {
    CanFrame frame = CanFrame::make(0x600u + node.node_id(), {0x2B, 0, 0, 0, 0, 0, 0, 0});
    if (index == 0x6060) frame.data[0] = 0x2F;
    const auto at = static_cast<std::uint16_t>(index + 0x800 * axis);
    frame.data[1] = static_cast<std::uint8_t>(at);
    frame.data[2] = static_cast<std::uint8_t>(at >> 8);
    frame.data[4] = static_cast<std::uint8_t>(value);
    node.on_frame(now, frame);
    while (node.next_frame()) {
    }
  };
  node.on_frame(now, CanFrame::make(0x000, {1, node.node_id()}));
  write(0x6060, 1);
  for (const std::uint16_t word : {std::uint16_t{6}, std::uint16_t{7}, std::uint16_t{15}})
    write(0x6040, word);
}

}  // namespace kinebus::fake
