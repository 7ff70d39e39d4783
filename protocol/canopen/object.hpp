#pragma once
// What is known of one entry of an object dictionary before any node exists: address, type, access, limits;
// and what it is called.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace kinebus {

struct ObjectAddress {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;

  /// For switch statements and sorting: index << 8 | subindex.
  constexpr std::uint32_t key() const { return (static_cast<std::uint32_t>(index) << 8) | subindex; }
  friend constexpr bool operator==(const ObjectAddress&, const ObjectAddress&) = default;
  friend constexpr bool operator<(const ObjectAddress& a, const ObjectAddress& b) {
    return a.key() < b.key();
  }
};

/// Offset of the second axis' objects (CiA 402 for 0x6000 ff., and the same for the manufacturer's 0x2140
/// ff.).
inline constexpr std::uint16_t kAxisOffset = 0x800;

/// Numbers are those of CiA 301, as EDS files and dummy mapping use them.
enum class DataType : std::uint8_t {
  kBoolean = 0x01,
  kI8 = 0x02,
  kI16 = 0x03,
  kI32 = 0x04,
  kU8 = 0x05,
  kU16 = 0x06,
  kU32 = 0x07,
  kString = 0x09,
  kI64 = 0x15,
  kU64 = 0x1B,
};

/// Bytes on the wire; 0 for a string, whose length is that of its text.
constexpr std::uint8_t size_of(DataType type) {
  switch (type) {
    case DataType::kBoolean:
    case DataType::kI8:
    case DataType::kU8:
      return 1;
    case DataType::kI16:
    case DataType::kU16:
      return 2;
    case DataType::kI32:
    case DataType::kU32:
      return 4;
    case DataType::kI64:
    case DataType::kU64:
      return 8;
    case DataType::kString:
      return 0;
  }
  return 0;
}

constexpr bool is_signed(DataType type) {
  return type == DataType::kI8 || type == DataType::kI16 || type == DataType::kI32 || type == DataType::kI64;
}

/// The value that these raw wire bits mean: sign extended for signed types, else zero extended. A u64 above
/// 2^63-1 keeps its bits and so appears negative; u64 objects are packed records, never compared.
constexpr std::int64_t value_of(DataType type, std::uint64_t raw) {
  const int unused = 64 - 8 * size_of(type);
  if (unused >= 64) return 0;
  if (is_signed(type)) return static_cast<std::int64_t>(raw << unused) >> unused;
  return static_cast<std::int64_t>((raw << unused) >> unused);
}

enum class Access : std::uint8_t { kConst, kReadOnly, kWriteOnly, kReadWrite };

/// Whether, and into which kind of PDO, an object may be mapped.
enum class Mapping : std::uint8_t { kNone = 0, kRpdo = 1, kTpdo = 2, kBoth = 3 };

/// Where the value of an object is.
enum class Binding : std::uint8_t {
  kConstant,   ///< in the table: the default (or `text`), node-id relative if so marked
  kParameter,  ///< in the dictionary's values; kept by "store parameters" (1010h) and part of the fingerprint
               ///< (2116h)
  kVariable,   ///< in the dictionary's values; gone at reset
  kLive,       ///< with the dictionary's owner, asked on every access
};

enum class ObjectCode : std::uint8_t { kVar = 7, kArray = 8, kRecord = 9 };

/// Where the value of an object is in its dictionary.
struct ObjectSlot {
  std::uint16_t value = 0;
};

/// What a value has to be within, as ObjectEntry::bits.
struct ObjectLimits {
  std::uint32_t low = 0, high = 0;
  friend constexpr bool operator==(const ObjectLimits&, const ObjectLimits&) = default;
};

/// One (index, subindex), as small as a node keeps it: boards with two nodes have little flash.
struct ObjectEntry {
  ObjectAddress address{};
  std::uint16_t slot : 13 = 0;        ///< of its value: the objects' order in the board's units
  std::int8_t axis : 2 = -1;          ///< 0, 1; -1: belongs to the node as a whole
  bool node_id_relative : 1 = false;  ///< the value at reset is `initial` + node id
  DataType type : 5 = DataType::kU32;
  Access access : 2 = Access::kReadOnly;
  bool limited : 1 = false;  ///< low and high are narrower than the type
  ObjectCode code : 4 = ObjectCode::kVar;
  Mapping mapping : 2 = Mapping::kNone;
  Binding binding : 2 = Binding::kConstant;
  std::uint32_t initial_bits = 0;  ///< of a string: its length
  union {
    const ObjectLimits* limits = nullptr;  ///< when limited; many entries have the same
    const char* text_begin;                ///< of a string
  };

  /// The lower half of a value of this type, and the value again: none of a table needs more.
  static constexpr std::uint32_t bits(std::int64_t value) { return static_cast<std::uint32_t>(value); }
  constexpr std::int64_t value(std::uint32_t bits) const {
    return is_signed(type) ? std::int64_t{static_cast<std::int32_t>(bits)} : std::int64_t{bits};
  }
  constexpr std::int64_t initial() const { return value(initial_bits); }
  // When limited.
  constexpr std::int64_t low() const { return value(limits->low); }
  constexpr std::int64_t high() const { return value(limits->high); }
  /// Of a string.
  constexpr std::string_view text() const { return {text_begin, initial_bits}; }

  /// The address with the second axis' offset taken off: what code for either axis switches on.
  constexpr ObjectAddress base() const {
    return {static_cast<std::uint16_t>(axis == 1 ? address.index - kAxisOffset : address.index),
            address.subindex};
  }
  constexpr ObjectSlot value_slot() const { return {slot}; }
  constexpr bool readable() const { return access != Access::kWriteOnly; }
  constexpr bool writable() const { return access == Access::kReadWrite || access == Access::kWriteOnly; }
  constexpr bool maps_to(Mapping kind) const {
    return (static_cast<unsigned>(mapping) & static_cast<unsigned>(kind)) != 0;
  }
  constexpr std::uint8_t size() const {
    return type == DataType::kString ? static_cast<std::uint8_t>(initial_bits) : size_of(type);
  }
};

/// The objects of one kind of node, in the order of their addresses, each once.
struct ObjectTable {
  std::span<const ObjectEntry> entries;

  /// Place in `entries`. Binary search; -1: no such object.
  constexpr int find(ObjectAddress address) const {
    std::size_t low = 0, high = entries.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (entries[middle].address < address)
        low = middle + 1;
      else
        high = middle;
    }
    return low < entries.size() && entries[low].address == address ? static_cast<int>(low) : -1;
  }
  constexpr const ObjectEntry& operator[](int place) const {
    return entries[static_cast<std::size_t>(place)];
  }
};

/// What people and their files (EDS, DBC) are told of an entry; a node carries none of it.
struct ObjectNames {
  std::string_view object{};  ///< name of the whole object; the same in all rows of an index
  std::string_view name{};    ///< name of this entry; equals `object` for a plain variable
  std::string_view unit{};    ///< "counts", "ms", ...
};

}  // namespace kinebus
