#pragma once
// How an object table is written: rows, added unit by unit, and put in order by the compiler. Only units,
// boards and printers of a table need this.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "protocol/canopen/object.hpp"

namespace kinebus {

namespace object_table {

/// What a row says of its object.
struct ObjectDefinition {
  ObjectAddress address{};
  ObjectCode code = ObjectCode::kVar;
  DataType type = DataType::kU32;
  Access access = Access::kReadOnly;
  Mapping mapping = Mapping::kNone;
  Binding binding = Binding::kConstant;
  std::int8_t axis = -1;
  bool node_id_relative = false;
  bool limited = false;
  std::uint16_t slot = 0;
  std::int64_t initial = 0;
  std::int64_t low = 0, high = 0;
  std::string_view text{};

  constexpr ObjectLimits limits() const { return {ObjectEntry::bits(low), ObjectEntry::bits(high)}; }
  /// What does not come out as it went in fails BoardObjects' checks. Its limits are the board's to keep.
  constexpr explicit operator ObjectEntry() const {
    ObjectEntry entry;
    entry.address = address;
    entry.slot = slot & 0x1FFF;
    entry.type = type;
    entry.code = code;
    entry.access = access;
    entry.mapping = mapping;
    entry.axis = axis < 0 ? -1 : axis == 0 ? 0 : 1;
    entry.binding = binding;
    entry.node_id_relative = node_id_relative;
    entry.limited = limited;
    entry.initial_bits = ObjectEntry::bits(initial);
    if (type == DataType::kString) {
      entry.initial_bits = static_cast<std::uint32_t>(text.size());
      entry.text_begin = text.data();
    }
    return entry;
  }
};

/// One row of the table; reads as one sentence.
struct ObjectRow : ObjectDefinition, ObjectNames {
  constexpr ObjectRow& between(std::int64_t lowest, std::int64_t highest) {
    limited = true;
    low = lowest;
    high = highest;
    return *this;
  }
  constexpr ObjectRow& in(std::string_view unit_text) {
    unit = unit_text;
    return *this;
  }
  constexpr ObjectRow& maps(Mapping kind) {
    mapping = kind;
    return *this;
  }
  constexpr ObjectRow& plus_node_id() {
    node_id_relative = true;
    return *this;
  }
};

struct Rows {
  static constexpr std::size_t kCapacity = 640;
  std::array<ObjectRow, kCapacity> rows{};
  std::size_t count = 0;

  constexpr ObjectRow& var(std::uint16_t index, std::string_view name, DataType type, Access access,
                           Binding binding, std::int64_t initial = 0) {
    return add(
        {{.address = {index, 0}, .type = type, .access = access, .binding = binding, .initial = initial},
         {.object = name, .name = name}});
  }
  /// Subindex 0 of an array or record: the number of its highest subindex.
  constexpr ObjectRow& head(std::uint16_t index, std::string_view object, ObjectCode code,
                            std::uint8_t highest) {
    return add({{.address = {index, 0},
                 .code = code,
                 .type = DataType::kU8,
                 .access = Access::kConst,
                 .initial = highest},
                {.object = object, .name = "Highest sub-index supported"}});
  }
  /// A further subindex of the object whose head came last.
  constexpr ObjectRow& sub(std::uint8_t subindex, std::string_view name, DataType type, Access access,
                           Binding binding, std::int64_t initial = 0) {
    const ObjectRow& last = rows[count - 1];
    return add({{.address = {last.address.index, subindex},
                 .code = last.code,
                 .type = type,
                 .access = access,
                 .binding = binding,
                 .initial = initial},
                {.object = last.object, .name = name}});
  }
  constexpr ObjectRow& string(std::uint16_t index, std::string_view name, std::string_view text) {
    ObjectRow& entry = var(index, name, DataType::kString, Access::kConst, Binding::kConstant);
    entry.text = text;
    return entry;
  }
  constexpr ObjectRow& add(const ObjectRow& entry) {
    rows[count] = entry;
    rows[count].slot = static_cast<std::uint16_t>(count);
    return rows[count++];
  }
  /// Gives the rows added since `from` to the first axis, and adds them again for the second.
  constexpr void for_both_axes(std::size_t from) {
    const std::size_t end = count;
    for (std::size_t i = from; i < end; ++i) rows[i].axis = 0;
    for (std::size_t i = from; i < end; ++i) {
      ObjectRow entry = rows[i];
      entry.address.index = static_cast<std::uint16_t>(entry.address.index + kAxisOffset);
      entry.axis = 1;
      add(entry);
    }
  }
  /// Places of the rows in the order of their addresses. Units come nearly in order: few of them move.
  constexpr std::array<std::uint16_t, kCapacity> order() const {
    std::array<std::uint16_t, kCapacity> places{};
    for (std::uint16_t i = 0; i < count; ++i) {
      std::size_t at = i;
      for (; at > 0 && rows[i].address < rows[places[at - 1]].address; --at) places[at] = places[at - 1];
      places[at] = i;
    }
    return places;
  }
};

using enum DataType;
using enum Access;
using enum Binding;

/// Default PDO mapping: {index, subindex, bits} of each mapped object, as 1600h/1A00h hold them.
constexpr std::uint32_t mapped(ObjectAddress a, int bits, int axis = 0) {
  return ((static_cast<std::uint32_t>(a.index) + static_cast<std::uint32_t>(axis * kAxisOffset)) << 16) |
         (static_cast<std::uint32_t>(a.subindex) << 8) | static_cast<std::uint32_t>(bits);
}
struct PdoDefault {
  std::string_view name;
  std::uint32_t cob_id;
  bool plus_node_id;
  std::uint8_t type;
  std::uint16_t inhibit_100us;
  std::uint16_t event_ms;
  std::array<std::uint32_t, 8> map;  ///< up to the first 0
};
/// A node's PDOs as it comes, 1400h and 1800h on.
struct PdoSet {
  std::span<const PdoDefault> rpdos, tpdos;
};
inline constexpr std::uint32_t kPdoOff = 0x8000'0000, kNoRtr = 0x4000'0000;

}  // namespace object_table
}  // namespace kinebus
