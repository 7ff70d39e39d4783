#include "protocol/canopen/emcy.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"

namespace kinebus {

CanFrame encode(const Emergency& emergency) {
  CanFrame frame{.id = cob_id::kEmcy + emergency.node, .length = 8};
  put_u16_le(frame.data, emergency.code);
  frame.data[2] = emergency.error_register;
  std::copy(emergency.vendor.begin(), emergency.vendor.end(), frame.data.begin() + 3);
  return frame;
}

std::optional<Emergency> decode_emcy(const CanFrame& frame) {
  const std::uint8_t node = cob_id::node_of(frame.id, cob_id::kEmcy);
  if (node == 0 || frame.extended || frame.remote || frame.length != 8) return std::nullopt;
  Emergency emergency{.node = node, .code = get_u16_le(frame.data), .error_register = frame.data[2]};
  std::copy(frame.data.begin() + 3, frame.data.end(), emergency.vendor.begin());
  return emergency;
}

void EmcyProducer::raise(std::uint16_t code, std::array<std::uint8_t, 5> vendor, bool urgent) {
  if (!active(code))
    if (const auto free = std::find(active_.begin(), active_.end(), 0); free != active_.end()) *free = code;
  std::copy_backward(history_.begin(), history_.end() - 1, history_.end());
  history_[0] =
      code | (static_cast<std::uint32_t>(vendor[0]) << 16) | (static_cast<std::uint32_t>(vendor[1]) << 24);
  history_length_ = static_cast<std::uint8_t>(std::min<std::size_t>(history_length_ + 1u, kHistory));
  queue({code, error_register(), vendor, urgent});
}

void EmcyProducer::clear(std::uint16_t code) {
  const auto place = std::find(active_.begin(), active_.end(), code);
  if (code == 0 || place == active_.end()) return;
  *place = 0;
  // CiA 301: as long as another error is present, the register in the message says so.
  queue({emcy::kNoError, error_register(), {}, false});
}

void EmcyProducer::clear_all() {
  if (error_register() == 0) return;
  active_.fill(0);
  queue({emcy::kNoError, 0, {}, false});
}

void EmcyProducer::queue(const Item& item) {
  if (count_ == kQueue) {
    ++lost_;
    if (!item.urgent) return;
    --count_;  // the newest of the others makes room
  }
  std::size_t place = count_;
  if (item.urgent)
    while (place > 0 && !items_[place - 1].urgent) items_[place] = items_[place - 1], --place;
  items_[place] = item;
  ++count_;
}

std::optional<CanFrame> EmcyProducer::next_frame(LocalTime now, std::uint8_t node) {
  if (count_ == 0 || (!items_[0].urgent && now < allowed_)) return std::nullopt;
  const Item item = items_[0];
  std::copy(items_.begin() + 1, items_.begin() + static_cast<std::ptrdiff_t>(count_), items_.begin());
  --count_;
  allowed_ = now + inhibit_;
  ++sent_;
  return encode(Emergency{node, item.code, item.error_register, item.vendor});
}

LocalTime EmcyProducer::next_deadline() const {
  if (count_ == 0) return LocalTime::max();
  // The first one of all is allowed since ever, and not urgent for that.
  return items_[0].urgent ? LocalTime::min() : std::max(allowed_, LocalTime{0});
}

std::uint8_t EmcyProducer::error_register() const {
  unsigned bits = 0;
  for (const std::uint16_t code : active_) bits |= emcy::register_bits(code);
  return static_cast<std::uint8_t>(bits);
}

bool EmcyProducer::active(std::uint16_t code) const {
  return code != 0 && std::find(active_.begin(), active_.end(), code) != active_.end();
}

}  // namespace kinebus
