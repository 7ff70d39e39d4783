#pragma once
// THE object table of a Kinebus node: the SDO server, PDO mapping, gateway, EDS and DBC all read this one. To
// add an object, add a row in the order of addresses (checked at compile time). Rows of an axis are written
// once and appear for both axes, the second at +800h.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/object.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {

inline constexpr std::uint32_t kVendorId = 0x4B49'4E45;  // "KINE": Kinebus has no number of CiA
inline constexpr std::uint32_t kProductCode = 0x0000'0402;
inline constexpr std::uint32_t kRevisionNumber = 0x0001'0000;
inline constexpr std::int64_t kSaveSignature = 0x6576'6173;  // "save", 1010h
inline constexpr std::int64_t kLoadSignature = 0x6461'6F6C;  // "load", 1011h
inline constexpr int kRpdoCount = 6;
inline constexpr int kTpdoCount = 4;
inline constexpr int kSwitchInputs = 7;
inline constexpr int kErrorHistoryLength = 8;

/// What a switch input does (2130h). Home inputs latch the position; limit and stop inputs stop everything on
/// the path.
enum class SwitchFunction : std::uint8_t {
  kNone = 0,
  kHomeA = 1,
  kHomeB = 2,
  kPositiveLimitA = 3,
  kPositiveLimitB = 4,
  kNegativeLimitA = 5,
  kNegativeLimitB = 6,
  kEmergencyStop = 7,
  kProbe = 8,  ///< latches the positions of both axes (2140h:8), stops nothing
};

/// Addresses that code names; axis objects at their base (first axis).
namespace object {
inline constexpr ObjectAddress kDeviceType{0x1000, 0}, kErrorRegister{0x1001, 0}, kErrorHistory{0x1003, 0},
    kSyncCobId{0x1005, 0}, kSyncPeriod{0x1006, 0}, kHighResolutionTime{0x1013, 0}, kEmcyCobId{0x1014, 0},
    kEmcyInhibitTime{0x1015, 0}, kConsumerHeartbeat{0x1016, 1}, kProducerHeartbeat{0x1017, 0},
    kVendorIdentity{0x1018, 1}, kProductIdentity{0x1018, 2}, kRevisionIdentity{0x1018, 3},
    kSerialIdentity{0x1018, 4}, kSyncCounterOverflow{0x1019, 0}, kStoreParameters{0x1010, 1},
    kRestoreParameters{0x1011, 1}, kErrorBehaviour{0x1029, 1};
inline constexpr ObjectAddress kSegmentRecord{0x2100, 0}, kCheckpoint{0x2101, 0}, kStreamStatus{0x2102, 0},
    kRateCommand{0x2110, 0}, kSyncStamp{0x2111, 0}, kPathTime{0x2112, 0}, kStopRamp{0x2113, 0},
    kSyncLossTimeout{0x2114, 0}, kStarvationMargin{0x2115, 0}, kFingerprint{0x2116, 0}, kCounters{0x2120, 0},
    kSwitchFunction{0x2130, 1}, kSwitchPolarity{0x2131, 1}, kSwitchDebounce{0x2132, 1},
    kSwitchLevels{0x2133, 0};
inline constexpr ObjectAddress kAccelerationShift{0x2140, 1}, kRunCurrent{0x2140, 2}, kHoldCurrent{0x2140, 3},
    kDirectionInvert{0x2140, 4}, kCountsPerUnit{0x2140, 5}, kPositionKnown{0x2140, 6},
    kStreamPosition{0x2140, 7}, kHomeLatch{0x2140, 8}, kHomingTravel{0x2140, 9}, kHomingBackOff{0x2140, 10};
inline constexpr ObjectAddress kErrorCode{0x603F, 0}, kControlword{0x6040, 0}, kStatusword{0x6041, 0},
    kQuickStopOption{0x605A, 0}, kShutdownOption{0x605B, 0}, kDisableOption{0x605C, 0},
    kHaltOption{0x605D, 0}, kFaultReactionOption{0x605E, 0}, kModeOfOperation{0x6060, 0},
    kModeDisplay{0x6061, 0}, kPositionDemand{0x6062, 0}, kPositionActual{0x6064, 0},
    kFollowingErrorWindow{0x6065, 0}, kFollowingErrorTimeout{0x6066, 0}, kVelocityActual{0x606C, 0},
    kTargetPosition{0x607A, 0}, kHomeOffset{0x607C, 0}, kMinPositionLimit{0x607D, 1},
    kMaxPositionLimit{0x607D, 2}, kMaxProfileVelocity{0x607F, 0}, kProfileVelocity{0x6081, 0},
    kProfileAcceleration{0x6083, 0}, kProfileDeceleration{0x6084, 0}, kQuickStopDeceleration{0x6085, 0},
    kHomingMethod{0x6098, 0}, kHomingFastSpeed{0x6099, 1}, kHomingSlowSpeed{0x6099, 2},
    kHomingAcceleration{0x609A, 0}, kPositionOffset{0x60B0, 0}, kVelocityOffset{0x60B1, 0},
    kInterpolationSubMode{0x60C0, 0}, kInterpolationData{0x60C1, 1}, kInterpolationPeriod{0x60C2, 1},
    kInterpolationIndex{0x60C2, 2}, kBufferMaximum{0x60C4, 1}, kBufferActual{0x60C4, 2},
    kBufferPosition{0x60C4, 4}, kBufferClear{0x60C4, 6}, kMaxAcceleration{0x60C5, 0},
    kMaxDeceleration{0x60C6, 0}, kFollowingError{0x60F4, 0}, kDigitalInputs{0x60FD, 0},
    kDigitalOutputs{0x60FE, 1}, kSupportedModes{0x6502, 0};
}  // namespace object

/// Counters of 2120h: everything that can go wrong, by subindex.
enum class NodeCounter : std::uint8_t {
  kRxMalformed = 1,
  kRxOverrun,
  kTxFull,
  kBusOff,
  kSyncLost,
  kStampLost,
  kClockOutOfBound,
  kSequenceErrors,
  kQueueOverflows,
  kUnderruns,
  kCheckpointErrors,
  kLateRateCommands,
  kDuplicateFrames,
  kPdoLengthErrors,
  kSdoAborts,
  kSwitchGlitches,
  kEmergencies,
  kStorageErrors,
  kWatchdogResets,
  kCoordinatedStops,
  kLateStops,
  kHomingErrors,
  kDriveFaults,
  kLast = kDriveFaults,
};

namespace object_table {

template <std::size_t kCapacity>
struct Rows {
  std::array<ObjectEntry, kCapacity> rows{};
  std::size_t count = 0;

  constexpr ObjectEntry& var(std::uint16_t index, std::string_view name, DataType type, Access access,
                             Binding binding, std::int64_t initial = 0) {
    return add({.address = {index, 0},
                .object = name,
                .name = name,
                .type = type,
                .access = access,
                .binding = binding,
                .initial = initial});
  }
  /// Subindex 0 of an array or record: the number of its highest subindex.
  constexpr ObjectEntry& head(std::uint16_t index, std::string_view object, ObjectCode code,
                              std::uint8_t highest) {
    return add({.address = {index, 0},
                .object = object,
                .name = "Highest sub-index supported",
                .code = code,
                .type = DataType::kU8,
                .access = Access::kConst,
                .initial = highest});
  }
  /// A further subindex of the object whose head came last.
  constexpr ObjectEntry& sub(std::uint8_t subindex, std::string_view name, DataType type, Access access,
                             Binding binding, std::int64_t initial = 0) {
    const ObjectEntry& last = rows[count - 1];
    return add({.address = {last.address.index, subindex},
                .object = last.object,
                .name = name,
                .code = last.code,
                .type = type,
                .access = access,
                .binding = binding,
                .initial = initial});
  }
  constexpr ObjectEntry& string(std::uint16_t index, std::string_view name, std::string_view text) {
    ObjectEntry& entry = var(index, name, DataType::kString, Access::kConst, Binding::kConstant);
    entry.text = text;
    return entry;
  }
  constexpr ObjectEntry& add(const ObjectEntry& entry) {
    rows[count] = entry;
    return rows[count++];
  }
  /// Gives the rows added since `from` to the first axis, and adds them again for the second.
  constexpr void for_both_axes(std::size_t from) {
    const std::size_t end = count;
    for (std::size_t i = from; i < end; ++i) rows[i].axis = 0;
    for (std::size_t i = from; i < end; ++i) {
      ObjectEntry entry = rows[i];
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
    {"Velocities",
     0x480 | kNoRtr | kPdoOff,
     true,
     254,
     100,
     0,
     {mapped(object::kVelocityActual, 32), mapped(object::kVelocityActual, 32, 1)}},
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
  ObjectEntry& count = t.rows[t.count - 1];
  count.name = "Number of mapped objects";
  count.access = kReadWrite;
  count.binding = kParameter;
  count.initial = used;
  count.between(0, 8);
  for (std::uint8_t i = 0; i < 8; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), kMappedNames[i], kU32, kReadWrite, kParameter, pdo.map[i]);
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
  for (std::uint8_t i = 0; i < kCounterNames.size(); ++i)
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
constexpr auto shrink() {
  std::array<ObjectEntry, kBuilt.count> rows;
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = kBuilt.rows[i];
  return rows;
}

}  // namespace object_table

inline constexpr auto kNodeObjects = object_table::shrink();
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
