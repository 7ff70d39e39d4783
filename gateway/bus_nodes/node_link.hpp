#pragma once
// What the gateway knows of one node, and what it tells it outside of streams: drive states, modes, SDO.

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "gateway/bus_nodes/sdo_channel.hpp"
#include "gateway/description/device_description.hpp"
#include "gateway/status/status.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/cia402.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/nmt.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class NodeLink {
 public:
  /// What the node does not have is neither heard nor told.
  explicit NodeLink(std::uint8_t id, NodeFunctions functions = {})
      : id_(id), functions_(functions), sdo_(id) {}

  /// Takes a frame of this node; false: it is not one, or none that is understood.
  bool on_frame(BusTime now, const CanFrame& frame);
  /// An NMT command on the bus, this gateway's own or another device's: a node may be in another state now.
  void on_nmt(const CanFrame& frame);
  void on_time(BusTime now) { sdo_.on_time(now); }
  /// Controlwords first, then SDO.
  std::optional<CanFrame> next_frame(BusTime now);

  std::uint8_t id() const { return id_; }
  const NodeFunctions& functions() const { return functions_; }
  SdoChannel& sdo() { return sdo_; }
  const SdoChannel& sdo() const { return sdo_; }

  // What it said.
  bool heard() const { return heard_; }
  BusTime last_heard() const { return last_heard_; }
  NmtState nmt_state() const { return nmt_state_; }
  std::uint16_t statusword(std::size_t axis) const { return statusword_[axis]; }
  cia402::State drive_state(std::size_t axis) const { return cia402::state_of(statusword_[axis]); }
  bool drive_known() const { return drive_heard_; }
  /// When its statuswords came last.
  BusTime drive_told() const { return drive_told_; }
  std::int8_t mode(std::size_t axis) const { return mode_[axis]; }
  std::uint32_t inputs() const { return inputs_; }
  const std::optional<StreamStatus>& stream() const { return stream_; }
  std::int32_t position_counts(std::size_t axis) const { return position_[axis]; }
  /// Commanded less measured, counts; empty: not told.
  const std::optional<std::array<std::int32_t, 2>>& following_error() const { return following_error_; }
  /// Position frames so far: a new one is there when it has changed.
  std::uint32_t position_frames() const { return position_frames_; }
  std::uint32_t emergencies() const { return emergency_count_; }

  /// Boot-ups since the last call: each means that the node has lost its position.
  bool take_boot_up() { return std::exchange(booted_, false); }
  /// Serial numbers that were told since forget(): a second one is another node's with the same id.
  const std::vector<std::uint32_t>& serial_numbers() const { return serial_numbers_; }
  /// Two of one id, once: it was operational, then not, then again, more than once (a single heartbeat may be
  /// anybody's), and nobody has commanded it. forget() keeps it: it is the next bring-up that says so.
  bool take_two_states() { return returns_ > 1 && std::exchange(returns_, 0) > 1; }
  std::optional<Emergency> next_emergency();
  /// The status frame that came last, once.
  std::optional<StreamStatus> take_stream() { return std::exchange(new_stream_, std::nullopt); }

  /// Its positions (TPDO3) come every so often; 0: no more. By 1802h:5, which is one of its parameters. With
  /// 0 it gets back what it was lent.
  void set_report_period(std::chrono::milliseconds period);
  /// While it reports a parameter may have another value than its `own`.
  void lend(const ParameterWrite& value, const ParameterWrite& own);
  /// Told to report, and not yet known to have ended: its fingerprint may be another meanwhile.
  bool reports() const { return reports_; }
  /// What it was told last has been answered: it reports no more.
  void reports_ended() {
    reports_ = false;
    lent_.clear();
  }

  // What it is told (RPDO1). Sent when it changes.
  void set_control(std::size_t axis, std::uint16_t controlword, std::int8_t mode);
  void set_control(std::size_t axis, std::uint16_t controlword) {
    set_control(axis, controlword, wanted_mode_[axis]);
  }
  std::uint16_t control(std::size_t axis) const { return control_[axis]; }
  /// Sends controlwords and modes again, changed or not.
  void repeat_control() { control_due_ = true; }

  /// Forgets all that was heard (before a bring-up).
  void forget();
  NodeStatus status(BusTime now, BusTime heartbeat_timeout) const;

 private:
  bool on_axis_frame(BusTime now, const CanFrame& frame);
  void on_status_words(const CanFrame& frame);
  void note_state(NmtState state);
  void note_serial_number(const CanFrame& reply);

  std::uint8_t id_;
  NodeFunctions functions_;
  SdoChannel sdo_;
  bool reports_ = false;
  std::vector<ParameterWrite> lent_;  ///< its own values
  bool heard_ = false, booted_ = false, drive_heard_ = false, control_due_ = false;
  BusTime last_heard_{0}, drive_told_{0};
  NmtState nmt_state_ = NmtState::kInitialising;
  // Since the last command, reset or boot-up.
  bool was_operational_ = false, left_operation_ = false;
  int returns_ = 0;  ///< into operation by itself
  std::array<std::uint16_t, 2> statusword_{}, control_{};
  std::array<std::int8_t, 2> mode_{}, wanted_mode_{};
  std::uint32_t inputs_ = 0;
  std::array<std::int32_t, 2> position_{};
  std::optional<std::array<std::int32_t, 2>> following_error_;
  std::uint32_t position_frames_ = 0, emergency_count_ = 0;
  std::optional<StreamStatus> stream_, new_stream_;
  std::deque<Emergency> emergencies_;
  std::vector<std::uint32_t> serial_numbers_;
};

}  // namespace kinebus
