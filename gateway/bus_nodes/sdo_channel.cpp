#include "gateway/bus_nodes/sdo_channel.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/node_objects.hpp"

namespace kinebus {

namespace {
/// The transfer itself went wrong, by a frame that was lost, doubled or came late: again, it will be good.
bool disturbed(AbortCode code) {
  return code == AbortCode::kToggleBit || code == AbortCode::kCommandSpecifier ||
         code == AbortCode::kSequenceNumber || code == AbortCode::kCrc;
}
}  // namespace

Sentence to_string(std::uint8_t node, const SdoResult& result) {
  const std::string object = printed("%04Xh:%u", static_cast<unsigned>(result.address.index),
                                     static_cast<unsigned>(result.address.subindex));
  return result.abort == AbortCode::kTimeout
             ? say("node %1, object %2: no answer", node, object)
             : say("node %1, object %2: %3", node, object, text(result.abort));
}

SdoChannel::SdoChannel(std::uint8_t node_id) : node_id_(node_id) {}

void SdoChannel::read(ObjectAddress address) {
  requests_.push_back({.address = address, .read = true, .apart = false, .size = 8, .bytes = {}});
}

void SdoChannel::glance(ObjectAddress address) {
  if (!idle()) return;
  requests_.push_back({.address = address, .read = true, .apart = true, .size = 8, .bytes = {}});
}

std::optional<SdoResult> SdoChannel::next_glance(ObjectAddress base) {
  if (!glanced_) return std::nullopt;
  const ObjectAddress second = on_axis(base, 1);
  if (glanced_->address != base && glanced_->address != second) return std::nullopt;
  return std::exchange(glanced_, std::nullopt);
}

void SdoChannel::write(const ParameterWrite& write) {
  Request request{.address = write.address, .read = false, .apart = false, .size = write.size, .bytes = {}};
  put_le(request.bytes, static_cast<std::uint64_t>(write.value), write.size);
  requests_.push_back(request);
}

void SdoChannel::write_apart(const ParameterWrite& write) {
  if (!idle()) return;
  this->write(write);
  requests_.back().apart = true;
}

std::optional<SdoResult> SdoChannel::next_result() {
  if (results_.empty()) return std::nullopt;
  const SdoResult result = results_.front();
  results_.pop_front();
  return result;
}

void SdoChannel::abandon() {
  if (client_.status() == SdoClient::Status::kBusy) client_.cancel();
  requests_.clear();
  results_.clear();
  glanced_.reset();
  attempts_ = 0;
}

void SdoChannel::begin(BusTime now) {
  const Request& request = requests_.front();
  ++attempts_;
  buffer_ = request.bytes;
  if (request.read)
    client_.upload(now, node_id_, request.address, buffer_);
  else
    client_.download(now, node_id_, request.address, std::span(buffer_).first(request.size));
}

/// Takes the result of a transfer that has ended.
void SdoChannel::settle() {
  if (requests_.empty() || attempts_ == 0 || client_.status() == SdoClient::Status::kBusy) return;
  const Request& request = requests_.front();
  SdoResult result{.address = request.address, .read = request.read};
  if (client_.status() == SdoClient::Status::kFailed) {
    result.abort = client_.abort_code();
    if (result.abort == AbortCode::kTimeout) {
      ++counters_.timeouts;
      if (attempts_ < kAttempts && !(request.read && request.apart)) return;  // next_frame() begins again
    } else if (disturbed(result.abort)) {
      ++counters_.aborts;
      if (attempts_ < kDisturbedAttempts) return;
    } else {
      ++counters_.aborts;
    }
  } else if (request.read) {
    const int slot = find_object(request.address);
    const std::uint64_t raw = get_le(buffer_, std::min<std::size_t>(client_.received(), buffer_.size()));
    result.value = slot < 0 ? static_cast<std::int64_t>(raw)
                            : value_of(kNodeObjects[static_cast<std::size_t>(slot)].type, raw);
  }
  if (request.apart)
    glanced_ = result;
  else
    results_.push_back(result);
  requests_.pop_front();
  attempts_ = 0;
}

void SdoChannel::on_frame(BusTime now, const CanFrame& frame) {
  client_.on_frame(now, frame);
  settle();
}

void SdoChannel::on_time(BusTime now) {
  client_.on_time(now);
  settle();
}

std::optional<CanFrame> SdoChannel::next_frame(BusTime now) {
  if (!requests_.empty() && client_.status() != SdoClient::Status::kBusy) begin(now);
  return client_.next_frame();
}

}  // namespace kinebus
