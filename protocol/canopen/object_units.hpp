#pragma once
// The units that object tables are composed of. A board (boards/) names its units; to add an object, add a
// row to its unit. Units that a board shares with another come first and in the same order in both, so that
// the values of their objects are at the same places and one core serves both (shares_slots in
// board_objects.hpp).

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "protocol/canopen/communication_units.hpp"
#include "protocol/canopen/object_addresses.hpp"
#include "protocol/motion/broadcast.hpp"

namespace kinebus {

namespace object_table {

inline constexpr std::array<std::string_view, kSwitchInputs> kInputNames = {
    "Input 1", "Input 2", "Input 3", "Input 4", "Input 5", "Input 6", "Input 7"};
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
  // Bit 0: follows rate commands of smooth ramps; bit 1: knows 2119h.
  t.var(0x2118, "Stream functions", kU32, kConst, kConstant, kFollowsSmoothRamps | kTellsTailCheck);
  // 1: the stream status tells a check of the queue's tail in place of path time's highest byte.
  t.var(0x2119, "Tail check", kU8, kReadWrite, kVariable).between(0, 1);
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
  t.var(0x606B, "Velocity demand value", kI32, kReadOnly, kLive).maps(Mapping::kTpdo).in("counts/s");
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
  t.var(0x60FF, "Target velocity", kI32, kReadWrite, kVariable).maps(Mapping::kRpdo).in("counts/s");
  t.var(0x6402, "Motor type", kU16, kReadOnly, kConstant, 9);                // micro-step stepper
  t.var(0x6502, "Supported drive modes", kU32, kReadOnly, kConstant, 0xE5);  // pp, pv, homing, ip, csp
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

/// Linear scales on what the motors move, apart from the encoders on the motors' shafts: counters of
/// quadrature, or scales that tell where they are (SSI).
/// What a scale is like is told by the master at every start and not stored: 2116h does not cover it.
constexpr void linear_scales(Rows& t) {
  const std::size_t from = t.count;
  t.head(0x2160, "Linear scale", ObjectCode::kRecord, 9);
  // 0: none; 1: quadrature; 8 to 30: absolute, by SSI, with so many bits. Plus 32: in Gray code.
  t.sub(1, "Scale fitted", kU8, kReadWrite, kVariable).between(0, 62);
  // By it the node knows how far an absolute scale can have gone between two readings.
  t.sub(2, "Scale counts per unit x1000", kU32, kReadWrite, kVariable).in("1/1000");
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

/// Stepper drivers that are chips of their own, behind step and direction pins, and are spoken to (TMC2209 by
/// UART; TMC5160, TMC2130 by SPI); on boards without them nothing comes of it.
constexpr void stepper_drivers(Rows& t) {
  const std::size_t from = t.count;
  t.head(0x2170, "Stepper driver", ObjectCode::kRecord, 9);
  t.sub(1, "Driver", kU8, kReadWrite, kParameter, 1).between(0, 1);  // 0: stands alone; 1: is spoken to
  // StealthChop below, SpreadCycle above; 0: always SpreadCycle.
  t.sub(2, "SpreadCycle above", kU32, kReadWrite, kParameter).in("counts/s");
  // Homing (mode 6) by StallGuard: load at which DIAG says stall, 255 the lightest; 0: not. From 4 on.
  t.sub(3, "StallGuard threshold", kU8, kReadWrite, kParameter);
  t.sub(4, "StallGuard above", kU32, kReadWrite, kParameter).in("counts/s");
  // 0 stands alone, 1 not asked yet, 2 has its settings, 3 is being told, 4 does not answer.
  t.sub(5, "Driver state", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.sub(6, "Driver status", kU32, kReadOnly, kLive).maps(Mapping::kTpdo);  // DRV_STATUS
  t.sub(7, "StallGuard result", kU16, kReadOnly, kLive).maps(Mapping::kTpdo);
  // Of the driver's module; 0: as it is on most of its kind.
  t.sub(8, "Sense resistor", kU16, kReadWrite, kParameter).between(0, 1000).in("mOhm");
  t.sub(9, "Driver found", kU16, kReadOnly, kLive);  // 2209, 5160, 2130; 0: none yet, or none
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
