#pragma once
// Node guarding, for masters that do not consume heartbeats, by CiA 301: a remote frame on 700h + node is
// answered with the NMT state and a bit that toggles. Life guarding: a master that has asked once, and then
// for the life time not, is lost.

#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

#include "protocol/canopen/heartbeat.hpp"

namespace kinebus {

class NodeGuard {
 public:
  /// From boot-up on the bit begins with 0 again, and nobody is missed.
  void reset() { *this = {}; }
  /// 100Ch times 100Dh; 0: nobody is missed.
  void set_life_time(std::chrono::milliseconds life_time) { life_time_ = life_time; }
  static bool asks(const CanFrame& frame, std::uint8_t node) {
    return frame.remote && !frame.extended && node != 0 && frame.id == cob_id::kHeartbeat + node;
  }
  void on_request(LocalTime now) {
    asked_ = true;
    lost_ = false;
    due_ = now + life_time_;
  }
  /// True once: the master is lost.
  bool take_lost(LocalTime now) {
    if (now < next_deadline()) return false;
    due_ = kNever;
    return lost_ = true;
  }
  bool lost() const { return lost_; }
  std::optional<CanFrame> next_frame(NmtState state, std::uint8_t node) {
    if (!std::exchange(asked_, false)) return std::nullopt;
    CanFrame answer = heartbeat_frame(state, node);
    if (std::exchange(toggle_, !toggle_)) answer.data[0] |= 0x80;
    return answer;
  }
  LocalTime next_deadline() const { return life_time_.count() == 0 ? kNever : due_; }

 private:
  std::chrono::milliseconds life_time_{0};
  LocalTime due_ = kNever;
  bool asked_ = false, toggle_ = false, lost_ = false;
};

}  // namespace kinebus
