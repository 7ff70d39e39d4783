#include "protocol/bytes.hpp"
#include "protocol/canopen/lss.hpp"

namespace kinebus {

bool LssMaster::begin(LocalTime now, Service service) {
  if (status_ == Status::kBusy) return false;
  status_ = Status::kBusy;
  service_ = service;
  request_count_ = request_at_ = 0;
  error_code_ = 0;
  due_ = now + options_.timeout;
  return true;
}

void LssMaster::send(LocalTime now, std::uint8_t command, std::uint32_t data, LocalTime wait) {
  CanFrame frame{.id = cob_id::kLssRequest, .length = 8};
  frame.data[0] = command;
  put_u32_le(std::span(frame.data).subspan(1), data);
  requests_[request_count_++] = frame;
  expected_ = command;
  due_ = now + wait;
}

bool LssMaster::switch_all(LocalTime now, bool configuration) {
  if (!begin(now, Service::kSwitchAll)) return false;
  send(now, lss::kSwitchGlobal, configuration ? 1 : 0, options_.scan_wait);
  return true;
}

bool LssMaster::select(LocalTime now, const LssIdentity& identity) {
  if (!begin(now, Service::kSelect)) return false;
  identity_ = identity;
  for (std::uint8_t part = 0; part < 4; ++part)
    send(now, static_cast<std::uint8_t>(lss::kSelectVendor + part), identity[part], options_.timeout);
  expected_ = lss::kSelected;
  return true;
}

bool LssMaster::configure_node_id(LocalTime now, std::uint8_t node_id) {
  if (!begin(now, Service::kConfigureNodeId)) return false;
  send(now, lss::kConfigureNodeId, node_id, options_.timeout);
  return true;
}

bool LssMaster::store(LocalTime now) {
  if (!begin(now, Service::kStore)) return false;
  send(now, lss::kStore, 0, options_.timeout * 10);  // memories take their time
  return true;
}

bool LssMaster::inquire_node_id(LocalTime now) {
  if (!begin(now, Service::kInquire)) return false;
  send(now, lss::kInquireNodeId, 0, options_.timeout);
  return true;
}

bool LssMaster::inquire_identity(LocalTime now, int part) {
  if (part < 0 || part > 3 || !begin(now, Service::kInquire)) return false;
  send(now, static_cast<std::uint8_t>(lss::kInquireVendor + part), 0, options_.timeout);
  return true;
}

bool LssMaster::fastscan(LocalTime now) {
  if (!begin(now, Service::kFastscan)) return false;
  identity_ = {};
  scan_part_ = 0;
  scan_bit_ = 128;
  confirming_ = false;
  send_scan(now);
  return true;
}

void LssMaster::send_scan(LocalTime now) {
  request_count_ = request_at_ = 0;
  answered_ = false;
  send(now, lss::kFastscan, identity_[scan_part_], options_.scan_wait);
  CanFrame& frame = requests_[0];
  frame.data[5] = scan_bit_;
  frame.data[6] = scan_part_;
  // On confirmation the nodes that match go on to the next part; back to 0 after the last means:
  // configuration.
  frame.data[7] = confirming_ ? static_cast<std::uint8_t>((scan_part_ + 1) % 4) : scan_part_;
}

/// Every bit is first tried as 0; silence means 1. The confirmation of a part tests its last bit too.
void LssMaster::next_scan(LocalTime now, bool answered) {
  if (scan_bit_ == 128) {
    if (!answered) {
      status_ = Status::kNotFound;
      return;
    }
    scan_bit_ = 31;
    return send_scan(now);
  }
  if (confirming_) {
    confirming_ = false;
    if (!answered) {
      status_ = Status::kNotFound;
      return;
    }
    if (++scan_part_ == 4) {
      status_ = Status::kDone;
      return;
    }
    scan_bit_ = 31;
    return send_scan(now);
  }
  if (!answered) identity_[scan_part_] |= std::uint32_t{1} << scan_bit_;
  if (scan_bit_ > 0)
    --scan_bit_;
  else
    confirming_ = true;
  send_scan(now);
}

void LssMaster::on_frame(const CanFrame& frame) {
  if (status_ != Status::kBusy || frame.id != cob_id::kLssReply || frame.extended || frame.length != 8)
    return;
  if (request_at_ < request_count_) return;  // an answer to what was not asked yet
  if (service_ == Service::kFastscan) {
    // Several nodes may answer, one after another: their answers are awaited, so that none counts for the
    // next scan.
    if (frame.data[0] == lss::kIdentified) answered_ = true;
    return;
  }
  if (frame.data[0] != expected_) return;
  status_ = Status::kDone;
  if (service_ == Service::kInquire) value_ = get_u32_le(std::span(frame.data).subspan(1));
  if ((service_ == Service::kConfigureNodeId || service_ == Service::kStore) && frame.data[1] != 0) {
    error_code_ = frame.data[1];
    status_ = Status::kRefused;
  }
}

void LssMaster::on_time(LocalTime now) {
  if (status_ != Status::kBusy || now < due_) return;
  switch (service_) {
    case Service::kFastscan:
      return next_scan(now, answered_);
    case Service::kSwitchAll:
      status_ = Status::kDone;
      return;  // unconfirmed
    case Service::kSelect:
      status_ = Status::kNotFound;
      return;
    default:
      status_ = Status::kTimeout;
  }
}

std::optional<CanFrame> LssMaster::next_frame() {
  if (request_at_ == request_count_) return std::nullopt;
  return requests_[request_at_++];
}

}  // namespace kinebus
