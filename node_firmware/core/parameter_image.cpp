#include "node_firmware/core/parameter_image.hpp"

#include <algorithm>

#include "protocol/bytes.hpp"
#include "protocol/canopen/crc.hpp"

namespace kinebus {
namespace {

constexpr std::uint32_t kMagic = 0x4950'424B;  // "KBPI"

std::uint32_t crc_of(std::span<const std::uint8_t> bytes) {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

std::int64_t relative_part(const ObjectEntry& entry, std::uint8_t node_id) {
  return entry.node_id_relative ? node_id : 0;
}

}  // namespace

ParameterBytes::Load ParameterBytes::adopt(std::span<const std::uint8_t> stored) {
  clear(0);
  if (stored.empty()) return Load::kEmpty;
  if (stored.size() < kHeader + kTail) return Load::kDamaged;
  const std::size_t entries = get_u16_le(stored.subspan(6));
  const std::size_t size = kHeader + entries * kEntry + kTail;
  // Flash is read as a whole page: what follows the image does not matter.
  if (get_u32_le(stored) != kMagic || get_u16_le(stored.subspan(4)) != kVersion || size > stored.size() ||
      size > room_.size())
    return Load::kDamaged;
  if (crc_of(stored.first(size - kTail)) != get_u32_le(stored.subspan(size - kTail))) return Load::kDamaged;
  std::copy_n(stored.begin(), size, room_.begin());
  return Load::kGood;
}

void ParameterBytes::clear(std::uint8_t node_id) {
  begin(node_id);
  finish(0);
}

void ParameterBytes::save(const ObjectDictionary& objects, std::uint8_t node_id, std::uint8_t kept_node_id) {
  begin(kept_node_id);
  std::size_t entries = 0;
  for (const ObjectEntry& entry : objects.table().entries) {
    if (entry.binding != Binding::kParameter) continue;
    const std::int64_t value = objects.value(entry.value_slot()) - relative_part(entry, node_id);
    if (value == entry.initial()) continue;
    const auto place = room_.subspan(kHeader + entries * kEntry);
    put_u32_le(place, entry.address.key());
    put_u64_le(place.subspan(4), static_cast<std::uint64_t>(value));
    ++entries;
  }
  finish(entries);
}

void ParameterBytes::apply(ObjectDictionary& objects, std::uint8_t node_id, std::uint32_t end_index) const {
  const std::size_t entries = get_u16_le(room_.subspan(6));
  for (std::size_t i = 0; i < entries; ++i) {
    const auto bytes = room_.subspan(kHeader + i * kEntry);
    const std::uint32_t key = get_u32_le(bytes);
    const auto value = static_cast<std::int64_t>(get_u64_le(bytes.subspan(4)));
    const int place =
        objects.place_of({static_cast<std::uint16_t>(key >> 8), static_cast<std::uint8_t>(key & 0xFF)});
    if (place < 0 || key >> 8 >= end_index) continue;
    const ObjectEntry& entry = objects.table()[place];
    const bool allowed = !entry.limited || (value >= entry.low() && value <= entry.high());
    if (entry.binding == Binding::kParameter && allowed)
      objects.set_value(entry.value_slot(), value + relative_part(entry, node_id));
  }
}

void ParameterBytes::set_node_id(std::uint8_t node_id) {
  room_[8] = node_id;
  finish(get_u16_le(room_.subspan(6)));
}

std::uint8_t ParameterBytes::node_id() const {
  return room_[8] <= 127 ? room_[8] : std::uint8_t{0};
}

std::span<const std::uint8_t> ParameterBytes::bytes() const {
  if (get_u32_le(room_) != kMagic) return {};
  return room_.first(kHeader + get_u16_le(room_.subspan(6)) * kEntry + kTail);
}

void ParameterBytes::begin(std::uint8_t node_id) {
  std::fill(room_.begin(), room_.end(), std::uint8_t{0});
  put_u32_le(room_, kMagic);
  put_u16_le(room_.subspan(4), kVersion);
  room_[8] = node_id;
}

void ParameterBytes::finish(std::size_t entries) {
  put_u16_le(room_.subspan(6), static_cast<std::uint16_t>(entries));
  const std::size_t end = kHeader + entries * kEntry;
  put_u32_le(room_.subspan(end), crc_of(room_.first(end)));
}

}  // namespace kinebus
