#pragma once
// Nodes made of a few rules: they answer SDO, follow controlwords at once, home at once, take records as
// ideal nodes do. For tests that care about the gateway alone, and fast.

#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "gateway/bus_nodes/node_configuration.hpp"
#include "gateway/jobs/ideal_nodes.hpp"
#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "protocol/canopen/sdo_server.hpp"
#include "protocol/motion/path_clock.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

class FakeNode final : private SdoObjects {
 public:
  FakeNode(const MachineDescription& machine, std::uint8_t id)
      : id_(id), sdo_(*this), ideal_(id), fingerprint_(configure_node(machine, id).fingerprint.value()) {
    sdo_.reset(id);
    out_.push_back(heartbeat_frame(NmtState::kInitialising, id));
  }

  void on_frame(BusTime now, const CanFrame& frame) {
    now_ = now;
    if (const auto command = decode_nmt(frame, id_)) {
      state_ = *command == NmtCommand::kStart ? NmtState::kOperational : NmtState::kPreOperational;
      out_.push_back(heartbeat_frame(state_, id_));
      report();
    }
    sdo_.on_frame(now, frame);
    if (frame.id == cob_id::rpdo(1, id_) && frame.length == 6 && state_ == NmtState::kOperational)
      control(frame);
    if (frame.id == kRateCobId)
      if (const auto rate = decode_rate_command(frame, now)) clock_.apply(*rate, now);
    ideal_.on_frame(frame);
  }
  void on_time(BusTime now) {
    now_ = now;
    clock_.forget_before(now);
    sdo_.on_time(now);
    if (now >= heartbeat_due_) {
      heartbeat_due_ = now + std::chrono::milliseconds{500};
      out_.push_back(heartbeat_frame(state_, id_));
    }
    if (state_ == NmtState::kOperational && ideal_.on_time(now, clock_.tau(now))) {
      CanFrame frame{.id = cob_id::tpdo(2, id_), .length = 8};
      put_u64_le(frame.data, encode(status()));
      out_.push_back(frame);
    }
  }
  std::optional<CanFrame> next_frame() {
    if (!out_.empty()) {
      const CanFrame frame = out_.front();
      out_.pop_front();
      return frame;
    }
    return sdo_.next_frame();
  }

 private:
  StreamStatus status() const {
    StreamStatus s = ideal_.status(clock_.tau(now_));
    s.next_sequence =
        static_cast<std::uint8_t>((s.next_sequence + kSequenceModulus - cleared_at_) % kSequenceModulus);
    if (clock_.stop_latched()) s.flags |= StreamStatus::kStopped;
    return s;
  }
  void control(const CanFrame& frame) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const std::uint16_t word = get_u16_le(frame.bytes().subspan(2 * axis));
      mode_[axis] = static_cast<std::int8_t>(frame.data[4 + axis]);
      power_[axis].on_controlword(word, {});
      homing_[axis] = mode_[axis] == 6 && (word & 0x10) != 0;
    }
    report();
  }
  void report() {
    CanFrame frame{.id = cob_id::tpdo(1, id_), .length = 7};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (power_[axis].state() == cia402::State::kNotReadyToSwitchOn) power_[axis].on_initialised();
      const auto word = static_cast<std::uint16_t>(power_[axis].statusword() | (homing_[axis] ? 0x1400 : 0));
      put_u16_le(std::span(frame.data).subspan(2 * axis), word);
      frame.data[4 + axis] = static_cast<std::uint8_t>(mode_[axis]);
    }
    out_.push_back(frame);
  }
  AbortCode sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                     std::uint32_t& total) override {
    const int slot = find_object(address);
    if (slot < 0) return AbortCode::kNoObject;
    std::int64_t value = kNodeObjects[static_cast<std::size_t>(slot)].initial();
    const std::uint32_t base =
        address.key() & ~(address.index >= 0x2940 ? std::uint32_t{kAxisOffset} << 8 : 0u);
    if (address == object::kFingerprint) value = fingerprint_;
    if (address == object::kStreamStatus) value = static_cast<std::int64_t>(encode(status()));
    if (address == object::kPathTime) value = clock_.tau(now_).count();
    if (base == object::kPositionKnown.key()) value = 1;
    if (base == object::kStreamPosition.key()) value = std::int64_t{850 * 1280} << 32;
    std::array<std::uint8_t, 8> bytes{};
    put_u64_le(bytes, static_cast<std::uint64_t>(value));
    total = std::max<std::uint32_t>(1, kNodeObjects[static_cast<std::size_t>(slot)].size());
    for (std::uint32_t i = 0; i < out.size(); ++i)
      out[i] = offset + i < 8 ? bytes[offset + i] : std::uint8_t{0};
    return AbortCode::kNone;
  }
  AbortCode sdo_write(ObjectAddress address, std::uint32_t, std::span<const std::uint8_t> bytes,
                      bool) override {
    if (address == object::kPathTime && bytes.size() == 8)
      clock_.set_tau(PathTime{static_cast<std::int64_t>(get_u64_le(bytes) >> 1)}, now_);
    if (address == object::kBufferClear) cleared_at_ = ideal_.status(clock_.tau(now_)).next_sequence;
    return AbortCode::kNone;
  }

  std::uint8_t id_;
  SdoServer sdo_;
  IdealNode ideal_;
  std::uint32_t fingerprint_;
  PathClock clock_;
  NmtState state_ = NmtState::kPreOperational;
  std::array<cia402::PowerStateMachine, 2> power_{};
  std::array<std::int8_t, 2> mode_{};
  std::array<bool, 2> homing_{};
  std::uint8_t cleared_at_ = 0;
  BusTime now_{0}, heartbeat_due_{0};
  std::deque<CanFrame> out_;
};

}  // namespace kinebus
