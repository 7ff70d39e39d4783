#include "protocol/canopen/object_dictionary.hpp"

#include <algorithm>
#include <cstdlib>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {

ObjectDictionary::ObjectDictionary(ObjectOwner& owner, const ObjectTable& table,
                                   std::span<std::int64_t> values, std::uint8_t node_id)
    : owner_(owner), table_(table), values_(values.data()) {
  if (values.size() < table.entries.size()) std::abort();
  restore(node_id);
}

void ObjectDictionary::restore(std::uint8_t node_id) {
  node_id_ = node_id;
  for (const ObjectEntry& entry : table_.entries)
    values_[entry.slot] = entry.initial() + (entry.node_id_relative ? node_id : 0);
}

AbortCode ObjectDictionary::read_value(int place, std::int64_t& value) {
  const ObjectEntry& entry = table_[place];
  if (entry.binding == Binding::kLive) return owner_.read(entry, value);
  value = values_[entry.slot];
  return AbortCode::kNone;
}

AbortCode ObjectDictionary::check_value(int place, std::int64_t value) const {
  const ObjectEntry& entry = table_[place];
  if (entry.limited && value > entry.high()) return AbortCode::kTooHigh;
  if (entry.limited && value < entry.low()) return AbortCode::kTooLow;
  return owner_.check(entry, value);
}

AbortCode ObjectDictionary::write_value(int place, std::int64_t value) {
  const ObjectEntry& entry = table_[place];
  AbortCode refused = check_value(place, value);
  if (refused == AbortCode::kNone) refused = owner_.write(entry, value);
  if (refused == AbortCode::kNone && entry.binding != Binding::kLive) values_[entry.slot] = value;
  return refused;
}

AbortCode ObjectDictionary::read(ObjectAddress address, std::span<std::uint8_t> bytes, std::size_t& length) {
  int place = 0;
  if (const AbortCode missing = locate(address, place); missing != AbortCode::kNone) return missing;
  const ObjectEntry& entry = table_[place];
  if (!entry.readable()) return AbortCode::kWriteOnly;
  length = entry.size();
  if (length > bytes.size()) return AbortCode::kOutOfMemory;
  if (entry.type == DataType::kString) {
    std::ranges::copy(entry.text(), bytes.begin());
    return AbortCode::kNone;
  }
  std::int64_t value = 0;
  const AbortCode refused = read_value(place, value);
  if (refused == AbortCode::kNone) put_le(bytes, static_cast<std::uint64_t>(value), length);
  return refused;
}

AbortCode ObjectDictionary::write(ObjectAddress address, std::span<const std::uint8_t> bytes) {
  int place = 0;
  if (const AbortCode missing = locate(address, place); missing != AbortCode::kNone) return missing;
  const ObjectEntry& entry = table_[place];
  if (!entry.writable()) return AbortCode::kReadOnly;
  if (bytes.size() > entry.size()) return AbortCode::kTooLong;
  if (bytes.size() < entry.size()) return AbortCode::kTooShort;
  return write_value(place, value_of(entry.type, get_le(bytes, bytes.size())));
}

AbortCode ObjectDictionary::sdo_read(ObjectAddress address, std::uint32_t offset, std::span<std::uint8_t> out,
                                     std::uint32_t& total) {
  std::array<std::uint8_t, 64> bytes{};
  std::size_t length = 0;
  if (const AbortCode refused = read(address, bytes, length); refused != AbortCode::kNone) return refused;
  total = static_cast<std::uint32_t>(length);
  if (offset < length)
    std::copy_n(bytes.begin() + offset, std::min<std::size_t>(out.size(), length - offset), out.begin());
  return AbortCode::kNone;
}

AbortCode ObjectDictionary::sdo_write(ObjectAddress address, std::uint32_t offset,
                                      std::span<const std::uint8_t> bytes, bool last) {
  return offset == 0 && last ? write(address, bytes) : AbortCode::kTooLong;
}

std::size_t ObjectDictionary::sdo_size(ObjectAddress address) const {
  const int place = place_of(address);
  return place < 0 || table_[place].type == DataType::kString ? 4 : table_[place].size();
}

std::uint32_t ObjectDictionary::fingerprint() const {
  Crc32 crc;
  for (const ObjectEntry& entry : table_.entries) {
    if (entry.binding != Binding::kParameter) continue;
    std::array<std::uint8_t, 12> bytes{};
    put_u32_le(bytes, entry.address.key());
    const std::int64_t value = values_[entry.slot] - (entry.node_id_relative ? node_id_ : 0);
    put_u64_le(std::span(bytes).subspan(4), static_cast<std::uint64_t>(value));
    crc.add(bytes);
  }
  return crc.value();
}

// One copy of the search: an image has no room for one at every call.
[[gnu::noinline]] int ObjectDictionary::place_of(ObjectAddress address) const {
  return table_.find(address);
}

AbortCode ObjectDictionary::locate(ObjectAddress address, int& place) const {
  place = place_of(address);
  if (place >= 0) return AbortCode::kNone;
  // Every object has a subindex 0.
  return place_of({address.index, 0}) >= 0 ? AbortCode::kNoSubindex : AbortCode::kNoObject;
}

}  // namespace kinebus
