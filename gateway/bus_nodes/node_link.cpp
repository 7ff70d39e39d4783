#include "gateway/bus_nodes/node_link.hpp"

#include <algorithm>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/node_objects.hpp"
#include "protocol/canopen/sdo.hpp"

namespace kinebus {
namespace {

constexpr std::size_t kMaxEmergencies = 32;
constexpr ObjectAddress kReportPeriod{0x1802, 5};

}  // namespace

bool NodeLink::on_frame(BusTime now, const CanFrame& frame) {
  if (frame.extended || frame.remote) return false;
  if (const auto heartbeat = decode_heartbeat(frame)) {
    if (heartbeat->node != id_) return false;
    note_state(heartbeat->state);
    if (nmt_state_ == NmtState::kInitialising) {
      booted_ = true;
      following_error_.reset();
    }
  } else if (const auto emergency = decode_emcy(frame)) {
    if (emergency->node != id_) return false;
    ++emergency_count_;
    if (emergencies_.size() < kMaxEmergencies) emergencies_.push_back(*emergency);
  } else if (frame.id == cob_id::kSdoReply + id_ && frame.length == 8) {
    note_serial_number(frame);
    sdo_.on_frame(now, frame);
  } else if (!functions_.has_axes() || !on_axis_frame(now, frame)) {
    return false;
  }
  heard_ = true;
  last_heard_ = now;
  return true;
}

void NodeLink::on_nmt(const CanFrame& frame) {
  if (decode_nmt(frame, id_)) was_operational_ = left_operation_ = false;
}

void NodeLink::note_state(NmtState state) {
  nmt_state_ = state;
  if (state == NmtState::kOperational) {
    if (left_operation_) returns_ = std::min(returns_ + 1, 2);
    was_operational_ = true;
    left_operation_ = false;
  } else {
    // After a boot-up it is another's command that brings it into operation.
    left_operation_ = state != NmtState::kInitialising && (was_operational_ || left_operation_);
    was_operational_ = false;
  }
}

/// The PDOs of a pair of axes.
bool NodeLink::on_axis_frame(BusTime now, const CanFrame& frame) {
  const auto data = frame.bytes();
  if (frame.id == cob_id::tpdo(1, id_) && frame.length >= 7) {
    on_status_words(frame);
    drive_told_ = now;
  } else if (frame.id == cob_id::tpdo(2, id_) && frame.length == 8) {
    stream_ = new_stream_ = decode_stream_status(get_u64_le(data));
  } else if (frame.id == cob_id::tpdo(3, id_) && frame.length == 8) {
    position_ = {get_i32_le(data), get_i32_le(data.subspan(4))};
    ++position_frames_;
  } else if (frame.id == cob_id::tpdo(4, id_) && frame.length == 8) {
    following_error_ = {get_i32_le(data), get_i32_le(data.subspan(4))};
  } else {
    return false;
  }
  return true;
}

void NodeLink::on_status_words(const CanFrame& frame) {
  const auto data = frame.bytes();
  statusword_ = {get_u16_le(data), get_u16_le(data.subspan(2))};
  mode_ = {static_cast<std::int8_t>(data[4]), static_cast<std::int8_t>(data[5])};
  inputs_ = data[6];
  drive_heard_ = true;
}

/// From every answer, also one that comes when the transfer has ended with that of the other node.
void NodeLink::note_serial_number(const CanFrame& reply) {
  constexpr std::uint8_t kFourBytes = 0x43, kSerialNumber = 4;
  const ObjectAddress serial{object::kVendorIdentity.index, kSerialNumber};
  if (reply.data[0] != kFourBytes || sdo::address_in(reply) != serial) return;
  const std::uint32_t number = get_u32_le(reply.bytes().subspan(4));
  const auto& known = serial_numbers_;
  if (known.size() < 2 && std::find(known.begin(), known.end(), number) == known.end())
    serial_numbers_.push_back(number);
}

void NodeLink::set_report_period(std::chrono::milliseconds period) {
  reports_ = reports_ || period.count() != 0;
  sdo_.write({kReportPeriod, 2, period.count()});
  if (period.count() == 0)
    for (const ParameterWrite& own : lent_) sdo_.write(own);
}

void NodeLink::lend(const ParameterWrite& value, const ParameterWrite& own) {
  if (std::none_of(lent_.begin(), lent_.end(),
                   [&own](const ParameterWrite& w) { return w.address == own.address; }))
    lent_.push_back(own);
  sdo_.write(value);
}

std::optional<Emergency> NodeLink::next_emergency() {
  if (emergencies_.empty()) return std::nullopt;
  const Emergency emergency = emergencies_.front();
  emergencies_.pop_front();
  return emergency;
}

void NodeLink::set_control(std::size_t axis, std::uint16_t controlword, std::int8_t mode) {
  if (control_[axis] == controlword && wanted_mode_[axis] == mode) return;
  control_[axis] = controlword;
  wanted_mode_[axis] = mode;
  control_due_ = true;
}

std::optional<CanFrame> NodeLink::next_frame(BusTime now) {
  if (std::exchange(control_due_, false) && functions_.has_axes()) {
    CanFrame frame{.id = cob_id::rpdo(1, id_), .length = 6};
    put_u16_le(frame.data, control_[0]);
    put_u16_le(std::span(frame.data).subspan(2), control_[1]);
    frame.data[4] = static_cast<std::uint8_t>(wanted_mode_[0]);
    frame.data[5] = static_cast<std::uint8_t>(wanted_mode_[1]);
    return frame;
  }
  return sdo_.next_frame(now);
}

void NodeLink::forget() {
  heard_ = booted_ = drive_heard_ = control_due_ = was_operational_ = left_operation_ = false;
  nmt_state_ = NmtState::kInitialising;
  statusword_ = control_ = {};
  mode_ = wanted_mode_ = {};
  stream_.reset();
  new_stream_.reset();
  following_error_.reset();
  emergencies_.clear();
  serial_numbers_.clear();
  sdo_.abandon();
}

NodeStatus NodeLink::status(BusTime now, BusTime heartbeat_timeout) const {
  NodeStatus status;
  status.id = id_;
  status.has_axes = functions_.has_axes();
  if (!status.has_axes) status.queue_capacity = 0;
  status.present = heard_ && now - last_heard_ < heartbeat_timeout;
  status.nmt_state = static_cast<std::uint8_t>(nmt_state_);
  status.statusword = statusword_;
  status.inputs = inputs_;
  status.emergencies = emergency_count_;
  if (stream_) {
    status.synchronised = (stream_->flags & StreamStatus::kSynchronised) != 0;
    status.sync_error_us = stream_->sync_error_us;
    status.queue_records = std::max(0, status.queue_capacity - static_cast<int>(stream_->free_records));
    status.stopped = (stream_->flags & StreamStatus::kStopped) != 0;
  }
  return status;
}

}  // namespace kinebus
