#pragma once
// The units of an object table that are CANopen's own, of every node: identity, PDOs, guarding, download (CiA
// 301, 302), and the session's key.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/board_facts.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/object_rows.hpp"

namespace kinebus {

namespace object_table {

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
inline constexpr std::array<std::string_view, kErrorHistoryLength> kErrorFieldNames = {
    "Standard error field 1", "Standard error field 2", "Standard error field 3", "Standard error field 4",
    "Standard error field 5", "Standard error field 6", "Standard error field 7", "Standard error field 8"};

/// CiA 301: what every node has, but its PDOs.
constexpr void communication(Rows& t, const BoardFacts& board) {
  t.var(0x1000, "Device type", kU32, kConst, kConstant, board.device_type);
  t.var(0x1001, "Error register", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x1002, "Manufacturer status register", kU32, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.head(0x1003, "Pre-defined error field", ObjectCode::kArray, 0);
  t.rows[t.count - 1].name = "Number of errors";
  t.rows[t.count - 1].access = kReadWrite;  // writing 0 clears the history
  t.rows[t.count - 1].binding = kLive;
  for (std::uint8_t i = 0; i < kErrorHistoryLength; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kErrorFieldNames[i], kU32, kReadOnly, kLive);
  t.var(0x1005, "COB-ID SYNC message", kU32, kReadWrite, kParameter, 0x80);
  t.var(0x1006, "Communication cycle period", kU32, kReadWrite, kParameter).in("us");
  t.var(0x1007, "Synchronous window length", kU32, kReadWrite, kParameter).in("us");
  t.string(0x1008, "Manufacturer device name", board.device_name);
  t.string(0x1009, "Manufacturer hardware version", board.hardware_version);
  t.string(0x100A, "Manufacturer software version", "0.1.0");
  t.head(0x1010, "Store parameters", ObjectCode::kArray, 1);
  t.sub(1, "Save all parameters", kU32, kReadWrite, kLive);
  t.head(0x1011, "Restore default parameters", ObjectCode::kArray, 1);
  t.sub(1, "Restore all default parameters", kU32, kReadWrite, kLive);
  t.var(0x1013, "High resolution time stamp", kU32, kReadOnly, kLive).maps(Mapping::kTpdo).in("us");
  t.var(0x1014, "COB-ID EMCY", kU32, kReadWrite, kParameter, 0x80).plus_node_id();
  t.var(0x1015, "Inhibit time EMCY", kU16, kReadWrite, kParameter).in("100us");
  t.head(0x1016, "Consumer heartbeat time", ObjectCode::kArray, 2);
  t.sub(1, "Consumer heartbeat time 1", kU32, kReadWrite, kParameter);
  t.sub(2, "Consumer heartbeat time 2", kU32, kReadWrite, kParameter);
  t.var(0x1017, "Producer heartbeat time", kU16, kReadWrite, kParameter, 500).in("ms");
  t.head(0x1018, "Identity object", ObjectCode::kRecord, 4);
  // A board tells its own; these are what a standard one says.
  t.sub(1, "Vendor-ID", kU32, kReadOnly, kLive, kVendorId);
  t.sub(2, "Product code", kU32, kReadOnly, kLive, board.product_code);
  t.sub(3, "Revision number", kU32, kReadOnly, kLive, board.revision);
  t.sub(4, "Serial number", kU32, kReadOnly, kLive);
  t.var(0x1019, "Synchronous counter overflow value", kU8, kReadWrite, kParameter).between(0, 240);
  t.head(0x1029, "Error behaviour", ObjectCode::kArray, 1);
  // No change of NMT state: a lost gateway is answered by a stop on the path, after which positions stay in
  // use.
  t.sub(1, "Communication error", kU8, kReadWrite, kParameter, 1).between(0, 2);
  t.head(0x1200, "SDO server parameter", ObjectCode::kRecord, 2);
  t.sub(1, "COB-ID client to server", kU32, kConst, kConstant, 0x600).plus_node_id();
  t.sub(2, "COB-ID server to client", kU32, kConst, kConstant, 0x580).plus_node_id();
}

constexpr void pdo_parameters(Rows& t, const PdoDefault& pdo, std::string_view object, std::uint16_t index,
                              bool tpdo) {
  t.head(index, object, ObjectCode::kRecord, tpdo ? 6 : 5);
  auto& cob_id = t.sub(1, "COB-ID", kU32, kReadWrite, kParameter, pdo.cob_id);
  if (pdo.plus_node_id) cob_id.plus_node_id();
  t.sub(2, "Transmission type", kU8, kReadWrite, kParameter, pdo.type);
  t.sub(3, "Inhibit time", kU16, kReadWrite, kParameter, pdo.inhibit_100us).in("100us");
  t.sub(5, "Event timer", kU16, kReadWrite, kParameter, pdo.event_ms).in("ms");
  if (tpdo) t.sub(6, "SYNC start value", kU8, kReadWrite, kParameter).between(0, 240);
}

constexpr void pdo_mapping(Rows& t, const PdoDefault& pdo, std::string_view object, std::uint16_t index) {
  std::uint8_t used = 0;
  while (used < 8 && pdo.map[used] != 0) ++used;
  t.head(index, object, ObjectCode::kRecord, 8);
  ObjectRow& count = t.rows[t.count - 1];
  count.name = "Number of mapped objects";
  count.access = kReadWrite;
  count.binding = kParameter;
  count.initial = used;
  count.between(0, 8);
  for (std::uint8_t i = 0; i < 8; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kMappedNames[i], kU32, kReadWrite, kParameter, pdo.map[i]);
}

/// CiA 301: the node's PDOs, all of them can be mapped anew.
constexpr void pdos(Rows& t, const PdoSet& set) {
  for (std::size_t i = 0; i < set.rpdos.size(); ++i)
    pdo_parameters(t, set.rpdos[i], kRpdoNames[0][i], static_cast<std::uint16_t>(0x1400 + i), false);
  for (std::size_t i = 0; i < set.rpdos.size(); ++i)
    pdo_mapping(t, set.rpdos[i], kRpdoNames[1][i], static_cast<std::uint16_t>(0x1600 + i));
  for (std::size_t i = 0; i < set.tpdos.size(); ++i)
    pdo_parameters(t, set.tpdos[i], kTpdoNames[0][i], static_cast<std::uint16_t>(0x1800 + i), true);
  for (std::size_t i = 0; i < set.tpdos.size(); ++i)
    pdo_mapping(t, set.tpdos[i], kTpdoNames[1][i], static_cast<std::uint16_t>(0x1A00 + i));
}

/// What every board has first.
constexpr void device(Rows& t, const BoardFacts& board, const PdoSet& set) {
  communication(t, board);
  pdos(t, set);
}

/// CiA 301: what masters may rely on in place of heartbeats (1017h = 0).
constexpr void node_guarding(Rows& t) {
  t.var(0x100C, "Guard time", kU16, kReadWrite, kVariable).in("ms");
  t.var(0x100D, "Life time factor", kU8, kReadWrite, kVariable);
}

/// CiA 302. 1F50h, the program itself, is the boot loader's: it answers on the same node id after 1F51h = 0.
constexpr void program_download(Rows& t) {
  t.head(0x1F51, "Program control", ObjectCode::kArray, 1);
  t.sub(1, "Program control 1", kU8, kReadWrite, kLive).between(0, 3);
  t.head(0x1F56, "Program software identification", ObjectCode::kArray, 1);
  t.sub(1, "Program software identification 1", kU32, kReadOnly, kLive);
  t.head(0x1F57, "Flash status identification", ObjectCode::kArray, 1);
  t.sub(1, "Flash status identification 1", kU32, kReadOnly, kLive);
}

/// The session's check value: protocol/motion/session_guard.hpp.
constexpr void session_key(Rows& t) {
  constexpr std::array<std::string_view, 4> kParts = {"Key 1", "Key 2", "Key 3", "Key 4"};
  t.head(0x2117, "Session key", ObjectCode::kRecord, 5);
  std::uint8_t sub = 0;
  for (const std::string_view part : kParts) t.sub(++sub, part, kU32, kWriteOnly, kLive);
  t.sub(5, "Session in force", kU8, kReadWrite, kLive).between(0, 1);
}

}  // namespace object_table

}  // namespace kinebus
