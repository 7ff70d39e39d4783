#pragma once
// THE object table of a Kinebus node: the SDO server, PDO mapping, gateway, EDS and DBC all read this one. To
// add an object, add a row in the order of addresses (checked at compile time). Rows of an axis are written
// once and appear for both axes, the second at +800h.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/object_rows.hpp"

namespace kinebus {
namespace object_table {

template <typename T>
constexpr void add_communication_objects(T& t) {
  t.var(0x1000, "Device type", kU32, kConst, kConstant,
        0xFFFF'0192);  // several CiA 402 axes: see 67FFh, 6FFFh
  t.var(0x1001, "Error register", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x1002, "Manufacturer status register", kU32, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.head(0x1003, "Pre-defined error field", ObjectCode::kArray, 0);
  t.rows[t.count - 1].name = "Number of errors";
  t.rows[t.count - 1].access = kReadWrite;  // writing 0 clears the history
  t.rows[t.count - 1].binding = kLive;
  for (std::uint8_t i = 0; i < kErrorHistoryLength; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kErrorFieldNames[i], kU32, kReadOnly, kLive);
  t.var(0x1005, "COB-ID SYNC message", kU32, kReadWrite, kParameter, 0x80);
  t.var(0x1006, "Communication cycle period", kU32, kReadWrite, kParameter, 50'000).in("us");
  t.var(0x1007, "Synchronous window length", kU32, kReadWrite, kParameter).in("us");
  t.string(0x1008, "Manufacturer device name", "Kinebus two-axis node");
  t.string(0x1009, "Manufacturer hardware version", "STM32F405");
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
  t.sub(2, "Product code", kU32, kReadOnly, kLive, kProductCode);
  t.sub(3, "Revision number", kU32, kReadOnly, kLive, kRevisionNumber);
  t.sub(4, "Serial number", kU32, kReadOnly, kLive);
  t.var(0x1019, "Synchronous counter overflow value", kU8, kReadWrite, kParameter, 240).between(0, 240);
  t.head(0x1029, "Error behaviour", ObjectCode::kArray, 1);
  // No change of NMT state: a lost gateway is answered by a stop on the path, after which positions stay in
  // use.
  t.sub(1, "Communication error", kU8, kReadWrite, kParameter, 1).between(0, 2);
  t.head(0x1200, "SDO server parameter", ObjectCode::kRecord, 2);
  t.sub(1, "COB-ID client to server", kU32, kConst, kConstant, 0x600).plus_node_id();
  t.sub(2, "COB-ID server to client", kU32, kConst, kConstant, 0x580).plus_node_id();
}

template <typename T>
constexpr void add_pdo_objects(T& t, const PdoDefault& pdo, std::string_view object, std::uint16_t index,
                               bool tpdo) {
  t.head(index, object, ObjectCode::kRecord, tpdo ? 6 : 5);
  auto& cob_id = t.sub(1, "COB-ID", kU32, kReadWrite, kParameter, pdo.cob_id);
  if (pdo.plus_node_id) cob_id.plus_node_id();
  t.sub(2, "Transmission type", kU8, kReadWrite, kParameter, pdo.type);
  t.sub(3, "Inhibit time", kU16, kReadWrite, kParameter, pdo.inhibit_100us).in("100us");
  t.sub(5, "Event timer", kU16, kReadWrite, kParameter, pdo.event_ms).in("ms");
  if (tpdo) t.sub(6, "SYNC start value", kU8, kReadWrite, kParameter).between(0, 240);
}

template <typename T>
constexpr void add_mapping_objects(T& t, const PdoDefault& pdo, std::string_view object,
                                   std::uint16_t index) {
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

/// CiA 302. 1F50h, the program itself, is the boot loader's: it answers on the same node id after 1F51h = 0.
template <typename T>
constexpr void add_program_objects(T& t) {
  t.head(0x1F51, "Program control", ObjectCode::kArray, 1);
  t.sub(1, "Program control 1", kU8, kReadWrite, kLive).between(0, 3);
  t.head(0x1F56, "Program software identification", ObjectCode::kArray, 1);
  t.sub(1, "Program software identification 1", kU32, kReadOnly, kLive);
  t.head(0x1F57, "Flash status identification", ObjectCode::kArray, 1);
  t.sub(1, "Flash status identification 1", kU32, kReadOnly, kLive);
}

template <typename T>
constexpr void add_manufacturer_objects(T& t) {
  // Packed records: protocol/motion/segment.hpp and broadcast.hpp say what their bits are.
  t.var(0x2100, "Segment record", kU64, kWriteOnly, kLive).maps(Mapping::kRpdo);
  t.var(0x2101, "Checkpoint", kU64, kWriteOnly, kLive).maps(Mapping::kRpdo);
  t.var(0x2102, "Stream status", kU64, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x2110, "Rate command", kU64, kWriteOnly, kLive).maps(Mapping::kRpdo);
  t.var(0x2111, "SYNC stamp", kU64, kWriteOnly, kLive).maps(Mapping::kRpdo);
  t.var(0x2112, "Path time", kU64, kReadWrite, kLive).maps(Mapping::kTpdo).in("1/16us");
  t.var(0x2113, "Stop ramp", kU16, kReadWrite, kParameter, 100).between(2, 510).in("ms");
  // 3.5 periods of the 20 Hz SYNC: two may be lost.
  t.var(0x2114, "SYNC loss timeout", kU16, kReadWrite, kParameter, 175).between(20, 5000).in("ms");
  t.var(0x2115, "Starvation margin", kU16, kReadWrite, kParameter, 50).between(0, 1000).in("ms");
  t.var(0x2116, "Configuration fingerprint", kU32, kReadOnly, kLive);
  t.head(0x2120, "Counters", ObjectCode::kRecord, static_cast<std::uint8_t>(NodeCounter::kLast));
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(NodeCounter::kLast); ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kCounterNames[i], kU32, kReadOnly, kLive);
  t.head(0x2130, "Switch input function", ObjectCode::kArray, kSwitchInputs);
  for (std::uint8_t i = 0; i < kSwitchInputs; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kInputNames[i], kU8, kReadWrite, kParameter, i < 2 ? i + 1 : 0)
        .between(0, static_cast<std::int64_t>(SwitchFunction::kProbe));
  t.head(0x2131, "Switch input polarity", ObjectCode::kArray,
         kSwitchInputs);  // 1: active when the pin is low
  for (std::uint8_t i = 0; i < kSwitchInputs; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kInputNames[i], kU8, kReadWrite, kParameter).between(0, 1);
  t.head(0x2132, "Switch input debounce", ObjectCode::kArray, kSwitchInputs);
  for (std::uint8_t i = 0; i < kSwitchInputs; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kInputNames[i], kU16, kReadWrite, kParameter, 500)
        .between(0, 50'000)
        .in("us");
  t.var(0x2133, "Switch inputs active", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);  // bit 0: input 1
}

template <typename T>
constexpr void add_manufacturer_axis_objects(T& t) {
  t.head(0x2140, "Axis", ObjectCode::kRecord, 10);
  t.sub(1, "Acceleration shift", kU8, kReadWrite, kParameter, 2).between(0, 7);
  t.sub(2, "Run current", kU16, kReadWrite, kParameter, 1500).between(0, 5000).in("mA");
  t.sub(3, "Hold current", kU16, kReadWrite, kParameter, 1000).between(0, 5000).in("mA");
  t.sub(4, "Direction inverted", kU8, kReadWrite, kParameter).between(0, 1);
  t.sub(5, "Counts per unit x1000", kU32, kReadWrite, kParameter,
        1'280'000);  // for people: the node does not use it
  t.sub(6, "Position known", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.sub(7, "Exact position", kI64, kReadOnly, kLive).maps(Mapping::kTpdo).in("2^-32 counts");
  t.sub(8, "Home latch position", kI64, kReadOnly, kLive).maps(Mapping::kTpdo).in("2^-32 counts");
  // Homing gives up after so far without the edge it looks for: towards the switch, and off it.
  t.sub(9, "Homing travel", kU32, kReadWrite, kParameter, 1'280'000).in("counts");
  t.sub(10, "Homing back-off travel", kU32, kReadWrite, kParameter, 64'000).in("counts");
  t.head(0x2150, "Motor", ObjectCode::kRecord, 10);
  // While it accelerates, when above the run current.
  t.sub(1, "Boost current", kU16, kReadWrite, kParameter, 0).between(0, 5000).in("mA");
  // 0: not measured yet.
  t.sub(2, "Phase resistance", kU16, kReadWrite, kParameter).between(0, 60'000).in("mOhm");
  t.sub(3, "Phase inductance", kU16, kReadWrite, kParameter).between(0, 60'000).in("uH");
  // Peak of the phase's back-EMF divided by the electrical angular frequency.
  t.sub(4, "Flux linkage", kU16, kReadWrite, kParameter, 0).between(0, 60'000).in("uVs");
  t.sub(5, "Current loop bandwidth", kU16, kReadWrite, kParameter, 1500).between(100, 3000).in("Hz");
  // 0: none; 1: watches for lost steps; 2: also keeps step by it. Plus 4: it counts the other way round.
  t.sub(6, "Encoder", kU8, kReadWrite, kParameter).between(0, 6);
  // The encoder's counts, modulo an electrical turn of 1024, where the motor's angle is 0; -1: not measured.
  t.sub(7, "Encoder offset", kI16, kReadWrite, kParameter, -1).between(-1, 1023).in("counts");
  t.sub(8, "Auto-tune", kU8, kReadWrite, kLive);  // write 1; reads 0 idle, 1 runs, 2 done, 3 failed
  t.sub(9, "Motor current", kI16, kReadOnly, kLive).maps(Mapping::kTpdo).in("mA");
  t.sub(10, "Power stage temperature", kI16, kReadOnly, kLive).maps(Mapping::kTpdo).in("0.1C");
}

// Defaults suit a carriage of the default machine: 1280 counts/mm; 450 mm/s, 5000 mm/s2 at most.
template <typename T>
constexpr void add_drive_objects(T& t) {
  constexpr std::int64_t i32_min = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t i32_max = std::numeric_limits<std::int32_t>::max();
  t.var(0x603F, "Error code", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x6040, "Controlword", kU16, kReadWrite, kVariable).maps(Mapping::kRpdo);
  t.var(0x6041, "Statusword", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  // Stops end with the motor holding: a platform on vertical rails falls when its drives let go.
  t.var(0x605A, "Quick stop option code", kI16, kReadWrite, kParameter, 6).between(0, 6);
  t.var(0x605B, "Shutdown option code", kI16, kReadWrite, kParameter, 1).between(0, 1);
  t.var(0x605C, "Disable operation option code", kI16, kReadWrite, kParameter, 1).between(0, 1);
  t.var(0x605D, "Halt option code", kI16, kReadWrite, kParameter, 1).between(1, 2);
  t.var(0x605E, "Fault reaction option code", kI16, kReadWrite, kParameter, 2).between(0, 2);
  t.var(0x6060, "Modes of operation", kI8, kReadWrite, kVariable).maps(Mapping::kRpdo);
  t.var(0x6061, "Modes of operation display", kI8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x6062, "Position demand value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x6064, "Position actual value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x6065, "Following error window", kU32, kReadWrite, kParameter, 1024).in("counts");
  t.var(0x6066, "Following error time out", kU16, kReadWrite, kParameter, 10).in("ms");
  t.var(0x606C, "Velocity actual value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts/s");
  t.var(0x6079, "DC link circuit voltage", kU32, kReadOnly, kLive).maps(Mapping::kTpdo).in("mV");
  t.var(0x607A, "Target position", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts");
  // The position is made equal to this at the edge of the home switch.
  t.var(0x607C, "Home offset", kI32, kReadWrite, kParameter).in("counts");
  t.head(0x607D, "Software position limit", ObjectCode::kArray, 2);
  t.sub(1, "Min position limit", kI32, kReadWrite, kParameter, i32_min).in("counts");
  t.sub(2, "Max position limit", kI32, kReadWrite, kParameter, i32_max).in("counts");
  t.var(0x607F, "Max profile velocity", kU32, kReadWrite, kParameter, 576'000).in("counts/s");
  t.var(0x6081, "Profile velocity", kU32, kReadWrite, kParameter, 128'000)
      .maps(Mapping::kRpdo)
      .in("counts/s");
  t.var(0x6083, "Profile acceleration", kU32, kReadWrite, kParameter, 1'280'000)
      .maps(Mapping::kRpdo)
      .in("counts/s2");
  t.var(0x6084, "Profile deceleration", kU32, kReadWrite, kParameter, 1'280'000)
      .maps(Mapping::kRpdo)
      .in("counts/s2");
  t.var(0x6085, "Quick stop deceleration", kU32, kReadWrite, kParameter, 6'400'000).in("counts/s2");
  t.var(0x6098, "Homing method", kI8, kReadWrite, kParameter, 0);
  t.head(0x6099, "Homing speeds", ObjectCode::kArray, 2);
  t.sub(1, "Speed during search for switch", kU32, kReadWrite, kParameter, 38'400).in("counts/s");
  t.sub(2, "Speed during search for zero", kU32, kReadWrite, kParameter, 3'840).in("counts/s");
  t.var(0x609A, "Homing acceleration", kU32, kReadWrite, kParameter, 1'280'000).in("counts/s2");
  t.var(0x60B0, "Position offset", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts");
  t.var(0x60B1, "Velocity offset", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts/s");
  t.var(0x60C0, "Interpolation sub mode select", kI16, kReadWrite, kVariable, -1).between(-1, 0);
  t.head(0x60C1, "Interpolation data record", ObjectCode::kArray, 1);
  t.sub(1, "Position set-point", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts");
  t.head(0x60C2, "Interpolation time period", ObjectCode::kRecord, 2);
  t.sub(1, "Interpolation time period value", kU8, kReadWrite, kParameter, 50);
  t.sub(2, "Interpolation time index", kI8, kReadWrite, kParameter, -3).between(-128, 63);
  t.head(0x60C4, "Interpolation data configuration", ObjectCode::kRecord, 6);
  t.sub(1, "Maximum buffer size", kU32, kReadOnly, kConstant, 120);
  t.sub(2, "Actual buffer size", kU32, kReadWrite, kLive, 120);
  t.sub(3, "Buffer organisation", kU8, kReadWrite, kVariable).between(0, 1);
  t.sub(4, "Buffer position", kU16, kReadWrite, kLive);
  t.sub(5, "Size of data record", kU8, kWriteOnly, kVariable, 8).between(8, 8);
  t.sub(6, "Buffer clear", kU8, kWriteOnly, kLive).between(0, 1);
  t.var(0x60C5, "Max acceleration", kU32, kReadWrite, kParameter, 6'400'000).in("counts/s2");
  t.var(0x60C6, "Max deceleration", kU32, kReadWrite, kParameter, 6'400'000).in("counts/s2");
  t.var(0x60F4, "Following error actual value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x60FD, "Digital inputs", kU32, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.head(0x60FE, "Digital outputs", ObjectCode::kArray, 2);
  t.sub(1, "Physical outputs", kU32, kReadWrite, kVariable).maps(Mapping::kRpdo);
  t.sub(2, "Bit mask", kU32, kReadWrite, kParameter);
  t.var(0x6402, "Motor type", kU16, kReadOnly, kConstant, 9);                // micro-step stepper
  t.var(0x6502, "Supported drive modes", kU32, kReadOnly, kConstant, 0xE1);  // pp, homing, ip, csp
  t.var(0x67FF, "Single device type", kU32, kReadOnly, kConstant, 0x0004'0192);
}

constexpr auto build() {
  Rows<512> t;
  add_communication_objects(t);
  for (std::uint16_t i = 0; i < kRpdoCount; ++i)
    add_pdo_objects(t, kRpdoDefaults[i], kRpdoNames[0][i], static_cast<std::uint16_t>(0x1400 + i), false);
  for (std::uint16_t i = 0; i < kRpdoCount; ++i)
    add_mapping_objects(t, kRpdoDefaults[i], kRpdoNames[1][i], static_cast<std::uint16_t>(0x1600 + i));
  for (std::uint16_t i = 0; i < kTpdoCount; ++i)
    add_pdo_objects(t, kTpdoDefaults[i], kTpdoNames[0][i], static_cast<std::uint16_t>(0x1800 + i), true);
  for (std::uint16_t i = 0; i < kTpdoCount; ++i)
    add_mapping_objects(t, kTpdoDefaults[i], kTpdoNames[1][i], static_cast<std::uint16_t>(0x1A00 + i));
  add_program_objects(t);
  add_manufacturer_objects(t);
  std::size_t from = t.count;
  add_manufacturer_axis_objects(t);
  t.for_both_axes(from);
  from = t.count;
  add_drive_objects(t);
  t.for_both_axes(from);
  return t;
}

inline constexpr auto kBuilt = build();
template <typename Part>
constexpr auto part_of_rows() {
  std::array<Part, kBuilt.count> parts;
  for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = kBuilt.rows[i];
  return parts;
}

}  // namespace object_table

inline constexpr auto kNodeObjects = object_table::part_of_rows<ObjectEntry>();
/// The same places, for programs that speak to people: an image that does not name it does not contain it.
inline constexpr auto kNodeObjectNames = object_table::part_of_rows<ObjectNames>();
inline constexpr std::size_t kNodeObjectCount = kNodeObjects.size();

namespace object_table {
constexpr bool is_sorted() {
  for (std::size_t i = 1; i < kNodeObjects.size(); ++i)
    if (!(kNodeObjects[i - 1].address < kNodeObjects[i].address)) return false;
  return true;
}
void no_such_object_in_the_table();  // not constexpr: its name is the compiler's message
static_assert(is_sorted(), "rows of the object table must be in the order of their addresses, each once");
}  // namespace object_table

/// Of an entry of kNodeObjects.
constexpr const ObjectNames& names_of(const ObjectEntry& entry) {
  return kNodeObjectNames[static_cast<std::size_t>(&entry - kNodeObjects.data())];
}

/// Place of an object in kNodeObjects, and of its value in the dictionary. Binary search; -1: no such object.
constexpr int find_slot(ObjectAddress address) {
  std::size_t low = 0, high = kNodeObjects.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (kNodeObjects[middle].address < address)
      low = middle + 1;
    else
      high = middle;
  }
  return low < kNodeObjects.size() && kNodeObjects[low].address == address ? static_cast<int>(low) : -1;
}

/// The same at compile time; an address that is not in the table does not compile.
struct ObjectSlot {
  std::uint16_t value = 0;
};
consteval ObjectSlot slot_of(ObjectAddress address) {
  const int slot = find_slot(address);
  if (slot < 0) object_table::no_such_object_in_the_table();
  return {static_cast<std::uint16_t>(slot)};
}

/// An object that both axes have: slot_of_axes(object::kControlword)[axis].
struct AxisSlots {
  std::array<ObjectSlot, 2> slots;
  constexpr ObjectSlot operator[](std::size_t axis) const { return slots[axis]; }
};
consteval AxisSlots slot_of_axes(ObjectAddress base) {
  return {{slot_of(base), slot_of({static_cast<std::uint16_t>(base.index + kAxisOffset), base.subindex})}};
}

}  // namespace kinebus
