#pragma once
// How rows of the object table are written, the PDOs of a node as it comes, and lists of names. Only
// node_objects.hpp and printers of the table need this.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "protocol/canopen/object_addresses.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {

namespace object_table {

/// One row of the table; reads as one sentence.
struct ObjectRow : ObjectEntry, ObjectNames {
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

template <std::size_t kCapacity>
struct Rows {
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
inline constexpr std::uint32_t kPdoOff = 0x8000'0000, kNoRtr = 0x4000'0000;

inline constexpr std::array<PdoDefault, kRpdoCount> kRpdoDefaults{{
    {"Control",
     0x200,
     true,
     255,
     0,
     0,
     {mapped(object::kControlword, 16), mapped(object::kControlword, 16, 1),
      mapped(object::kModeOfOperation, 8), mapped(object::kModeOfOperation, 8, 1)}},
    {"Targets",
     0x300,
     true,
     1,
     0,
     0,
     {mapped(object::kTargetPosition, 32), mapped(object::kTargetPosition, 32, 1)}},
    {"Segment", 0x400, true, 255, 0, 0, {mapped(object::kSegmentRecord, 64)}},
    {"Checkpoint", 0x500, true, 255, 0, 0, {mapped(object::kCheckpoint, 64)}},
    {"Rate", kRateCobId, false, 255, 0, 0, {mapped(object::kRateCommand, 64)}},
    {"SyncStamp", kSyncStampCobId, false, 255, 0, 0, {mapped(object::kSyncStamp, 64)}},
}};
// TPDO1 and TPDO3 go by the device profile's event (a mapped value changed) or timer; TPDO2 when the stream
// says so.
inline constexpr std::array<PdoDefault, kTpdoCount> kTpdoDefaults{{
    {"Status",
     0x180 | kNoRtr,
     true,
     255,
     100,
     1000,
     {mapped(object::kStatusword, 16), mapped(object::kStatusword, 16, 1), mapped(object::kModeDisplay, 8),
      mapped(object::kModeDisplay, 8, 1), mapped(object::kSwitchLevels, 8)}},
    {"Stream", 0x280 | kNoRtr, true, 254, 20, 0, {mapped(object::kStreamStatus, 64)}},
    {"Positions",
     0x380 | kNoRtr,
     true,
     254,
     100,
     0,
     {mapped(object::kPositionActual, 32), mapped(object::kPositionActual, 32, 1)}},
    {"FollowingErrors",
     0x480 | kNoRtr | kPdoOff,
     true,
     254,
     100,
     0,
     {mapped(object::kFollowingError, 32), mapped(object::kFollowingError, 32, 1)}},
}};

inline constexpr std::array<std::string_view, kRpdoCount> kRpdoNames[2] = {
    {"RPDO1 communication parameter", "RPDO2 communication parameter", "RPDO3 communication parameter",
     "RPDO4 communication parameter", "RPDO5 communication parameter", "RPDO6 communication parameter"},
    {"RPDO1 mapping parameter", "RPDO2 mapping parameter", "RPDO3 mapping parameter",
     "RPDO4 mapping parameter", "RPDO5 mapping parameter", "RPDO6 mapping parameter"}};
inline constexpr std::array<std::string_view, kTpdoCount> kTpdoNames[2] = {
    {"TPDO1 communication parameter", "TPDO2 communication parameter", "TPDO3 communication parameter",
     "TPDO4 communication parameter"},
    {"TPDO1 mapping parameter", "TPDO2 mapping parameter", "TPDO3 mapping parameter",
     "TPDO4 mapping parameter"}};
inline constexpr std::array<std::string_view, 8> kMappedNames = {
    "Mapped object 1", "Mapped object 2", "Mapped object 3", "Mapped object 4",
    "Mapped object 5", "Mapped object 6", "Mapped object 7", "Mapped object 8"};
inline constexpr std::array<std::string_view, kSwitchInputs> kInputNames = {
    "Input 1", "Input 2", "Input 3", "Input 4", "Input 5", "Input 6", "Input 7"};
inline constexpr std::array<std::string_view, kErrorHistoryLength> kErrorFieldNames = {
    "Standard error field 1", "Standard error field 2", "Standard error field 3", "Standard error field 4",
    "Standard error field 5", "Standard error field 6", "Standard error field 7", "Standard error field 8"};
/// In the order of NodeCounter.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(NodeCounter::kLast)> kCounterNames = {
    "Malformed frames received",
    "Receive overruns",
    "Transmit queue full",
    "Bus off",
    "SYNC lost",
    "SYNC stamp lost",
    "Clock out of bound",
    "Stream sequence errors",
    "Stream queue overflows",
    "Stream underruns",
    "Checkpoint errors",
    "Late rate commands",
    "Duplicate frames",
    "PDO length errors",
    "SDO aborts",
    "Switch glitches rejected",
    "Emergencies",
    "Storage CRC failures",
    "Watchdog resets",
    "Stops on the path",
    "Stops heard too late",
    "Homing errors",
    "Drive faults"};

}  // namespace object_table
}  // namespace kinebus
