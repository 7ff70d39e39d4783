#pragma once
// The units that object tables are composed of. A board (boards/) names its units; to add an object, add a
// row to its unit. Units that a board shares with another come first and in the same order in both, so that
// the values of their objects are at the same places and one core serves both (shares_slots in
// board_objects.hpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "protocol/canopen/board_facts.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/canopen/object_rows.hpp"
#include "protocol/motion/broadcast.hpp"

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
    "Drive faults",
    "Records put in order",
    "Frames that nobody vouched for"};

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

/// Path time, the stream along it, and the stops that all nodes make together.
constexpr void stream(Rows& t) {
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
  session_key(t);
}

/// What can go wrong, counted.
constexpr void counters(Rows& t) {
  t.head(0x2120, "Counters", ObjectCode::kRecord, static_cast<std::uint8_t>(NodeCounter::kLast));
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(NodeCounter::kLast); ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kCounterNames[i], kU32, kReadOnly, kLive);
}

/// Why the processor has begun anew, and where the program was then (node_firmware/core/reset_report.hpp).
constexpr void last_reset(Rows& t) {
  t.head(0x2121, "Last reset", ObjectCode::kRecord, 7);
  t.sub(1, "Cause", kU8, kReadOnly, kLive);
  t.sub(2, "Fault reason", kU16, kReadOnly, kLive);
  t.sub(3, "Program counter", kU32, kReadOnly, kLive);
  t.sub(4, "Link register", kU32, kReadOnly, kLive);
  t.sub(5, "Configurable fault status", kU32, kReadOnly, kLive);
  t.sub(6, "Hard fault status", kU32, kReadOnly, kLive);
  t.sub(7, "Bus fault address", kU32, kReadOnly, kLive);
}

/// Switches of the axes, stop buttons, a probe.
constexpr void switch_inputs(Rows& t) {
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

constexpr void axis_record(Rows& t) {
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
}

// Defaults suit a carriage of the default machine: 1280 counts/mm; 450 mm/s, 5000 mm/s2 at most.
constexpr void cia402_axis(Rows& t) {
  constexpr std::int64_t i32_min = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t i32_max = std::numeric_limits<std::int32_t>::max();
  // NMT stop, pre-operational and reset communication in motion: 0 goes on, 1 fault, 2 power off, 3 quick
  // stop.
  t.var(0x6007, "Abort connection option code", kI16, kReadWrite, kVariable, 3).between(0, 3);
  t.var(0x603F, "Error code", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x6040, "Controlword", kU16, kReadWrite, kVariable).maps(Mapping::kRpdo);
  t.var(0x6041, "Statusword", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  // Stops end with the motor holding: a platform on vertical rails falls when its drives let go.
  t.var(0x605A, "Quick stop option code", kI16, kReadWrite, kParameter, 6).between(0, 8);
  t.var(0x605B, "Shutdown option code", kI16, kReadWrite, kParameter, 1).between(0, 1);
  t.var(0x605C, "Disable operation option code", kI16, kReadWrite, kParameter, 1).between(0, 1);
  t.var(0x605D, "Halt option code", kI16, kReadWrite, kParameter, 1).between(1, 4);
  t.var(0x605E, "Fault reaction option code", kI16, kReadWrite, kParameter, 2).between(0, 4);
  t.var(0x6060, "Modes of operation", kI8, kReadWrite, kVariable).maps(Mapping::kRpdo);
  t.var(0x6061, "Modes of operation display", kI8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x6062, "Position demand value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x6064, "Position actual value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x6065, "Following error window", kU32, kReadWrite, kParameter, 1024).in("counts");
  t.var(0x6066, "Following error time out", kU16, kReadWrite, kParameter, 10).in("ms");
  t.var(0x606C, "Velocity actual value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts/s");
  t.var(0x6079, "DC link circuit voltage", kU32, kReadOnly, kLive).maps(Mapping::kTpdo).in("mV");
  t.var(0x607A, "Target position", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts");
  // As IEC 61800-7-201: zero is the edge of the home switch plus this; the edge has its negative.
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
  // 0: a set-point a SYNC; -1: the stream.
  t.var(0x60C0, "Interpolation sub mode select", kI16, kReadWrite, kParameter).between(-1, 0);
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

/// Two CiA 402 axes, the second at +800h.
constexpr void axis_pair(Rows& t) {
  const std::size_t from = t.count;
  axis_record(t);
  cia402_axis(t);
  t.for_both_axes(from);
}

/// The motors of an axis pair whose currents the board itself controls.
constexpr void motors(Rows& t) {
  const std::size_t from = t.count;
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
  t.for_both_axes(from);
}

/// Linear scales on what the motors move: quadrature counters, apart from the encoders on the motors' shafts.
/// What a scale is like is told by the master at every start and not stored: 2116h does not cover it.
constexpr void linear_scales(Rows& t) {
  const std::size_t from = t.count;
  t.head(0x2160, "Linear scale", ObjectCode::kRecord, 9);
  t.sub(1, "Scale fitted", kU8, kReadWrite, kVariable).between(0, 1);
  t.sub(2, "Scale counts per unit x1000", kU32, kReadWrite, kVariable)
      .in("1/1000");  // for people: the node does not use it
  t.sub(3, "Scale direction inverted", kU8, kReadWrite, kVariable).between(0, 1);
  // From wherever it stood at power-up; by 5 both can be compared with the axis' coordinates.
  t.sub(4, "Position by scale", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.sub(5, "Position by scale at home", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  // The motor is led to where the scale has the axis; 7 = 0: it is not.
  t.sub(6, "Motor counts per scale count x65536", kI32, kReadWrite, kVariable);
  t.sub(7, "Correction by scale at most", kU32, kReadWrite, kVariable).in("counts");
  t.sub(8, "Correction by scale rate", kU32, kReadWrite, kVariable).in("counts/s");
  t.sub(9, "Correction by scale", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.for_both_axes(from);
}

/// Stepper drivers that are chips of their own, behind step and direction pins, and are spoken to (TMC2209);
/// on boards without them nothing comes of it.
constexpr void stepper_drivers(Rows& t) {
  const std::size_t from = t.count;
  t.head(0x2170, "Stepper driver", ObjectCode::kRecord, 7);
  t.sub(1, "Driver", kU8, kReadWrite, kParameter, 1).between(0, 1);  // 0: stands alone; 1: TMC2209 by UART
  // StealthChop below, SpreadCycle above; 0: always SpreadCycle.
  t.sub(2, "SpreadCycle above", kU32, kReadWrite, kParameter).in("counts/s");
  // Homing (mode 6) by StallGuard: load at which DIAG says stall, 255 the lightest; 0: not. From 4 on.
  t.sub(3, "StallGuard threshold", kU8, kReadWrite, kParameter);
  t.sub(4, "StallGuard above", kU32, kReadWrite, kParameter).in("counts/s");
  // 0 stands alone, 1 not asked yet, 2 has its settings, 3 is being told, 4 does not answer.
  t.sub(5, "Driver state", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.sub(6, "Driver status", kU32, kReadOnly, kLive).maps(Mapping::kTpdo);  // DRV_STATUS
  t.sub(7, "StallGuard result", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.for_both_axes(from);
}

/// Touch probe 1 of each axis: the switch inputs that have the probe function. Edges count from when they
/// happened, in bus time, so that a master knows where every other axis was.
constexpr void touch_probes(Rows& t) {
  const std::size_t from = t.count;
  t.var(0x60B8, "Touch probe function", kU16, kReadWrite, kVariable);
  t.var(0x60B9, "Touch probe status", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x60BA, "Touch probe 1 positive edge", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x60BB, "Touch probe 1 negative edge", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts");
  t.var(0x60D1, "Touch probe 1 positive edge time stamp", kU32, kReadOnly, kLive)
      .maps(Mapping::kTpdo)
      .in("ns");
  t.var(0x60D2, "Touch probe 1 negative edge time stamp", kU32, kReadOnly, kLive)
      .maps(Mapping::kTpdo)
      .in("ns");
  t.for_both_axes(from);
}

}  // namespace object_table
}  // namespace kinebus
