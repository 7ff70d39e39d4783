#pragma once
// A board under load: a master that speaks plain CANopen and stamps its SYNC, both motors in profile position
// and closed loop on their encoders, and a stranger who fills the bus.

#include <cmath>
#include <deque>
#include <stdexcept>

#include "protocol/bytes.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/sdo_client.hpp"
#include "protocol/motion/broadcast.hpp"
#include "vcan_tests/emulator/emulated_machine.hpp"

namespace kinebus::emulator {

class Load {
 public:
  explicit Load(const ElfImage& image)
      : machine_(image, {EmulatedNodeOptions{.board = {.unique_id = {1, 2, 3}}, .node_id = 1}}, 3) {}

  Board& board() { return machine_.board(0); }

  void bring_up() {
    machine_.send(now_, nmt_frame(NmtCommand::kStart, kAllNodes));
    write(0x1019, 0, 1, 240);
    for (const std::uint16_t base : {std::uint16_t{0x6000}, std::uint16_t{0x6800}}) {
      const auto at = [&](int index) { return static_cast<std::uint16_t>(base + index); };
      write(at(0x7F), 0, 4, kFast);
      write(at(0x81), 0, 4, kFast);
      write(at(0x83), 0, 4, 6'400'000);
      write(at(0x84), 0, 4, 6'400'000);
      const StepperParameters& motor = board().motor(base == 0x6000 ? 0 : 1).parameters();
      const auto own = static_cast<std::uint16_t>(base - 0x6000 + 0x2150);
      write(own, 2, 2, std::lround(motor.resistance_ohm * 1e3));
      write(own, 3, 2, std::lround(motor.inductance_h * 1e6));
      write(own, 4, 2, std::lround(motor.torque_nm_per_a / motor.pole_pairs * 1e6));
      write(own, 6, 1, 2);
      write(at(0x60), 0, 1, 1);
      for (const int word : {0x06, 0x07, 0x0F}) write(at(0x40), 0, 2, word);
    }
    run(std::chrono::milliseconds{150});
  }
  /// Until the node's window of SYNCs is full, so that a fit of its clock takes the longest.
  void synchronise() {
    next_sync_ = now_;
    run(kSyncPeriod * 520);
  }
  void move_both() {
    busy_ = true;
    for (const std::uint16_t base : {std::uint16_t{0x6000}, std::uint16_t{0x6800}}) {
      const auto at = [&](int index) { return static_cast<std::uint16_t>(base + index); };
      write(at(0x7A), 0, 4, kWay);
      write(at(0x40), 0, 2, 0x1F);
    }
    run(std::chrono::milliseconds{400});
    busy_ = false;
  }
  /// 2120h:2.
  std::uint32_t receive_overruns() {
    std::array<std::uint8_t, 4> bytes{};
    client_.upload(now_, 1, {0x2120, 2}, bytes);
    finish();
    return get_u32_le(bytes);
  }
  double worst_following_counts() const { return worst_; }
  std::uint32_t stack_used() {
    return board().image().symbol("stack_top").value_or(0) - board().cpu().lowest_stack();
  }

 private:
  static constexpr std::int64_t kFast = 400'000;  // counts/s, 7.8 rev/s
  static constexpr std::int64_t kWay = 100'000;
  static constexpr BusTime kSyncPeriod = std::chrono::milliseconds{5};  // the shortest

  void run(BusTime span) {
    const BusTime end = now_ + span;
    while (now_ < end) {
      now_ += std::chrono::microseconds{busy_ ? 200 : 500};
      if (now_ >= next_sync_) {
        next_sync_ += kSyncPeriod;
        counter_ = static_cast<std::uint8_t>(counter_ % 240 + 1);
        ahead_.push_back(CanFrame::make(cob_id::kSync, {counter_}));
      }
      while (!machine_.advance(now_)) drain();
      drain();
      for (; !ahead_.empty() && machine_.can_send(); ahead_.pop_front()) machine_.send(now_, ahead_.front());
      // What every node has to take: EMCYs of a stranger, which ask for nothing. No gap between them.
      while (busy_ && ahead_.empty() && !stamping_ && machine_.can_send())
        machine_.send(now_, CanFrame::make(0x0C1 + (++stranger_ % 8), {0, 0, 0, 0, 0, 0, 0, 0}));
      for (int axis = 0; axis < 2; ++axis)
        if (const auto wanted = machine_.commanded(0, axis))
          worst_ = std::max(worst_, std::abs(static_cast<double>(*wanted) / 4294967296.0 - rotor(axis)));
    }
  }
  void drain() {
    while (const auto got = machine_.receive()) {
      if (!got->own) client_.on_frame(now_, got->frame);
      if (got->own && got->frame.id == kSyncStampCobId) stamping_ = false;
      if (!got->own || got->frame.id != cob_id::kSync) continue;
      // A clock that grows warm, by half a ppm a second, and stamps that are up to 20 us early.
      const double s = to_seconds(got->when);
      const BusTime warm{std::llround(250.0 * s * s) - static_cast<std::int64_t>(counter_ * 7919u % 20011u)};
      stamping_ = true;
      ahead_.push_back(
          encode(SyncStamp{.counter = got->frame.data[0], .epoch = 1, .time = got->when + warm}));
    }
  }
  double rotor(int axis) { return board().true_counts(axis) - start_[static_cast<std::size_t>(axis)]; }
  void write(std::uint16_t index, std::uint8_t sub, int size, std::int64_t value) {
    std::array<std::uint8_t, 8> bytes{};
    put_le(std::span(bytes), value);
    client_.download(now_, 1, {index, sub}, std::span(bytes).first(static_cast<std::size_t>(size)));
    finish();
  }
  void finish() {
    while (client_.status() == SdoClient::Status::kBusy) {
      while (const auto frame = client_.next_frame()) {
        while (!machine_.can_send()) run_only();
        machine_.send(now_, *frame);
      }
      run_only();
      client_.on_time(now_);
    }
    if (client_.status() != SdoClient::Status::kDone)
      throw std::runtime_error("the node does not answer as it should");
  }
  void run_only() {
    now_ += std::chrono::microseconds{200};
    while (!machine_.advance(now_)) drain();
    drain();
  }

  EmulatedMachine machine_;
  BusTime now_{0};
  SdoClient client_;
  bool busy_ = false;
  std::uint32_t stranger_ = 0;
  BusTime next_sync_ = BusTime::max();
  std::uint8_t counter_ = 0;
  bool stamping_ = false;       // a stamp is on its way, and the stranger's frames are more urgent
  std::deque<CanFrame> ahead_;  // SYNCs and stamps that wait for the bus
  double worst_ = 0;
  std::array<double, 2> start_{};
};

}  // namespace kinebus::emulator
