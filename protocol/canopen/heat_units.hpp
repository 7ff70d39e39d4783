#pragma once
// The units of a heat node's table: temperature inputs and controllers after CiA 404, outputs after CiA 401.
// Temperatures on the bus are tenths of a degree Celsius.

#include "protocol/canopen/object_units.hpp"

namespace kinebus {

inline constexpr int kHeatSensors = 6;
inline constexpr int kHeaters = 4;
inline constexpr int kFans = 6;
inline constexpr int kFilamentSensors = 2;
/// 2277h: so many bands of energy, from 0 Hz on.
inline constexpr int kVibrationBands = 320;
/// 2227h: so many steps of so long.
inline constexpr int kFlowSteps = 4;
inline constexpr int kFlowStepMs = 400;

/// Addresses that a heat node's code names; of arrays, those of the first subindex.
namespace heat_object {
inline constexpr ObjectAddress kFingerprint{0x2116, 0};
// Inputs, a subindex a sensor.
inline constexpr ObjectAddress kSensorPath{0x2200, 1}, kReference{0x2201, 1}, kNominalResistance{0x2202, 1},
    kBeta{0x2203, 1}, kPointTemperature1{0x2204, 1}, kPointResistance1{0x2205, 1},
    kPointTemperature2{0x2206, 1}, kPointResistance2{0x2207, 1}, kPointTemperature3{0x2208, 1},
    kPointResistance3{0x2209, 1}, kLowestPlausible{0x220A, 1}, kHighestPlausible{0x220B, 1},
    kRatio{0x220C, 1}, kSensorWires{0x220D, 1}, kMains{0x220E, 0}, kSensorType{0x6110, 1},
    kInputStatus{0x6150, 1}, kInputI16{0x7130, 1}, kInputI32{0x9130, 1};
// Heaters.
inline constexpr ObjectAddress kHeaterSensor{0x2210, 1}, kLimit{0x2211, 1}, kHighestSetPoint{0x2212, 1},
    kControlKind{0x2213, 1}, kOutputKind{0x2214, 1}, kMostPower{0x2215, 1}, kNominalPower{0x2216, 1},
    kNominalSupply{0x2217, 1}, kModelRate{0x2218, 1}, kModelLoss{0x2219, 1}, kModelLag{0x221A, 1},
    kModelDead{0x221B, 1}, kMostMissing{0x221C, 1}, kMostUnasked{0x221D, 1}, kRiseTime{0x221E, 1},
    kSafeSetPoint{0x221F, 1}, kSafeTime{0x2220, 1}, kHeaterState{0x2221, 1}, kHeaterFault{0x2222, 1},
    kFeedForward{0x2223, 1}, kTune{0x2224, 1}, kTuneState{0x2225, 1}, kFaultReset{0x2226, 1},
    kFlowPower{0x2227, 1}, kFlowHeater{0x2228, 0}, kFlowLead{0x2229, 0}, kOnOff{0x6422, 1},
    kSetPoint{0x7402, 1}, kEffectiveOutput{0x7410, 1}, kProportionalBand{0x7450, 1}, kIntegralTime{0x7452, 1},
    kDerivativeTime{0x7454, 1};
// Fans.
inline constexpr ObjectAddress kFanFunction{0x2230, 1}, kFanHeater{0x2231, 1}, kFanKick{0x2232, 1},
    kFanLeast{0x2233, 1}, kFanPulses{0x2234, 1}, kFanSpeed{0x2235, 1}, kFanOutput{0x6411, 1};
// Filament sensors.
inline constexpr ObjectAddress kFilamentKind{0x2250, 1}, kFilamentInverted{0x2251, 1},
    kFilamentPerEdge{0x2252, 1}, kFilamentStands{0x2253, 1}, kFilamentSlips{0x2254, 1},
    kFilamentLeast{0x2255, 1}, kFilamentCommanded{0x2256, 1}, kFilamentSeen{0x2257, 1},
    kFilamentState{0x2258, 1}, kFilamentReset{0x2259, 1};
// A probe with a pin.
inline constexpr ObjectAddress kPinProbe{0x2260, 0}, kPinCommand{0x2261, 0}, kPinState{0x2262, 0},
    kServoPulse{0x2263, 0}, kProbeLine{0x2264, 0};
// An accelerometer.
inline constexpr ObjectAddress kVibrationState{0x2270, 0}, kVibrationCommand{0x2271, 0},
    kVibrationRate{0x2272, 0}, kVibrationWindows{0x2273, 0}, kVibrationClipped{0x2274, 0},
    kVibrationCount{0x2275, 0}, kVibrationBand{0x2276, 0}, kVibrationEnergy{0x2277, 1},
    kVibrationExponent{0x2278, 1}, kAcceleration{0x2279, 1};
inline constexpr ObjectAddress kContactor{0x2240, 0}, kSupply{0x2241, 0}, kMasterLost{0x2242, 0},
    kConfirmedSerial{0x2243, 0}, kFramesRefused{0x2244, 0};
}  // namespace heat_object

namespace object_table {

inline constexpr std::array<std::string_view, kHeatSensors> kSensorNames = {
    "Sensor 1", "Sensor 2", "Sensor 3", "Sensor 4", "Sensor 5", "Sensor 6"};
inline constexpr std::array<std::string_view, kHeaters> kHeaterNames = {"Heater 1", "Heater 2", "Heater 3",
                                                                        "Heater 4"};
inline constexpr std::array<std::string_view, kFlowSteps> kFlowNames = {"0 to 0.4 s", "0.4 to 0.8 s",
                                                                        "0.8 to 1.2 s", "1.2 to 1.6 s"};
inline constexpr std::array<std::string_view, kFilamentSensors> kFilamentNames = {"Filament sensor 1",
                                                                                  "Filament sensor 2"};
inline constexpr std::array<std::string_view, 3> kDirectionNames = {"X", "Y", "Z"};
inline constexpr std::array<std::string_view, kFans> kFanNames = {"Fan 1", "Fan 2", "Fan 3",
                                                                  "Fan 4", "Fan 5", "Fan 6"};

/// An array with one entry a name, all as `row` says.
constexpr void array_of(Rows& t, std::uint16_t index, std::string_view object,
                        std::span<const std::string_view> names, const ObjectRow& row) {
  t.head(index, object, ObjectCode::kArray, static_cast<std::uint8_t>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    ObjectRow entry = row;
    entry.address = {index, static_cast<std::uint8_t>(i + 1)};
    entry.code = ObjectCode::kArray;
    entry.object = object;
    entry.name = names[i];
    t.add(entry);
  }
}
constexpr ObjectRow entry_of(DataType type, Access access, Binding binding, std::int64_t initial = 0) {
  return {{.type = type, .access = access, .binding = binding, .initial = initial}, {}};
}
constexpr ObjectRow setting(DataType type, std::int64_t initial, std::int64_t low, std::int64_t high) {
  return entry_of(type, kReadWrite, kParameter, initial).between(low, high);
}
constexpr ObjectRow state(DataType type) {
  return entry_of(type, kReadOnly, kLive).maps(Mapping::kTpdo);
}

/// CiA 404, analogue inputs, and how the manufacturer's sensors are described.
constexpr void temperature_inputs(Rows& t) {
  constexpr std::int64_t most_mohm = 2'000'000'000;
  const std::span<const std::string_view> names = kSensorNames;
  // 0: from a divider, 1: MAX31865.
  array_of(t, 0x2200, "Sensor path", names, setting(kU8, 0, 0, 1));
  array_of(t, 0x2201, "Sensor reference resistor", names,
           setting(kU32, 4'700'000, 10'000, most_mohm).in("mOhm"));
  array_of(t, 0x2202, "Thermistor resistance at 25 C", names,
           setting(kU32, 100'000'000, 1'000, most_mohm).in("mOhm"));
  array_of(t, 0x2203, "Thermistor beta", names, setting(kU16, 3950, 1000, 10'000).in("K"));
  array_of(t, 0x2204, "Thermistor point 1 temperature", names, setting(kI16, 250, -500, 6000).in("0.1C"));
  array_of(t, 0x2205, "Thermistor point 1 resistance", names,
           setting(kU32, 100'000'000, 1, most_mohm).in("mOhm"));
  array_of(t, 0x2206, "Thermistor point 2 temperature", names, setting(kI16, 1500, -500, 6000).in("0.1C"));
  array_of(t, 0x2207, "Thermistor point 2 resistance", names,
           setting(kU32, 1'770'000, 1, most_mohm).in("mOhm"));
  array_of(t, 0x2208, "Thermistor point 3 temperature", names, setting(kI16, 2500, -500, 6000).in("0.1C"));
  array_of(t, 0x2209, "Thermistor point 3 resistance", names,
           setting(kU32, 230'000, 1, most_mohm).in("mOhm"));
  array_of(t, 0x220A, "Lowest plausible temperature", names, setting(kI16, -100, -500, 6000).in("0.1C"));
  array_of(t, 0x220B, "Highest plausible temperature", names, setting(kI16, 3500, -500, 6000).in("0.1C"));
  array_of(t, 0x220C, "Sensor ratio", names, state(kU32).in("2^-20"));
  // Of a MAX31865: wires that lead to the element, and the hum that their filters take away, 50 or 60.
  array_of(t, 0x220D, "Sensor wires", names, setting(kU8, 2, 2, 4));
  t.var(0x220E, "Mains frequency", kU8, kReadWrite, kParameter, 50).between(50, 60).in("Hz");
  // 0: none. 30, 33: Pt100, Pt1000; thermistors have the manufacturer's numbers.
  array_of(t, 0x6110, "AI sensor type", names, setting(kU16, 0, 0, 10'101));
  array_of(t, 0x6131, "AI physical unit PV", names, entry_of(kU32, kConst, kConstant, 0x002D'0000));
  array_of(t, 0x6132, "AI decimal digits PV", names, entry_of(kU8, kConst, kConstant, 1));
  // Bit 0: not valid; bits 1, 2: above, below what can be measured.
  array_of(t, 0x6150, "AI status", names, state(kU8));
  array_of(t, 0x7130, "AI input PV", names, state(kI16).in("0.1C"));
  array_of(t, 0x9130, "AI input PV (32 bit)", names, state(kI32).in("0.1C"));
}

/// CiA 404, closed-loop controllers. Settings can be changed with all heaters off only, before NMT start.
constexpr void heaters(Rows& t) {
  const std::span<const std::string_view> names = kHeaterNames;
  t.head(0x2210, "Heater's sensor", ObjectCode::kArray, kHeaters);  // 0: none, the heater is not used
  for (std::uint8_t i = 0; i < kHeaters; ++i)
    t.sub(static_cast<std::uint8_t>(i + 1), names[i], kU8, kReadWrite, kParameter, i + 1)
        .between(0, kHeatSensors);
  array_of(t, 0x2211, "Heater limit", names, setting(kI16, 2800, 300, 5500).in("0.1C"));
  array_of(t, 0x2212, "Heater highest set point", names, setting(kI16, 2650, 0, 5300).in("0.1C"));
  array_of(t, 0x2213, "Heater control", names, setting(kU8, 1, 0, 1));  // 0: PID, 1: by the model
  array_of(t, 0x2214, "Heater output", names, setting(kU8, 0, 0, 1));   // 0: PWM, 1: relay for mains
  array_of(t, 0x2215, "Heater most power", names, setting(kU8, 100, 1, 100).in("%"));
  array_of(t, 0x2216, "Heater nominal power", names, setting(kU32, 40'000, 100, 5'000'000).in("mW"));
  // 0: the heater hangs on a supply that is not measured.
  array_of(t, 0x2217, "Heater nominal supply", names, setting(kU16, 24'000, 0, 60'000).in("mV"));
  // All 0: not measured yet.
  array_of(t, 0x2218, "Heater model rate", names, setting(kU32, 0, 0, 50'000).in("mK/s"));
  array_of(t, 0x2219, "Heater model loss", names, setting(kU32, 0, 0, 100'000).in("1e-6/s"));
  array_of(t, 0x221A, "Heater model lag", names, setting(kU32, 0, 0, 60'000).in("ms"));
  array_of(t, 0x221B, "Heater model dead time", names, setting(kU32, 0, 0, 12'000).in("ms"));
  array_of(t, 0x221C, "Heat that may be missing", names, setting(kU8, 50, 10, 100).in("%"));
  array_of(t, 0x221D, "Heat that may come unasked", names, setting(kU8, 25, 5, 100).in("%"));
  array_of(t, 0x221E, "Heater rise time", names, setting(kU16, 20, 5, 300).in("s"));
  array_of(t, 0x221F, "Heater safe set point", names, setting(kI16, 0, 0, 5300).in("0.1C"));
  array_of(t, 0x2220, "Heater safe set point time", names, setting(kU16, 0, 0, 7200).in("s"));
  // 0 off, 1 heating, 2 at its target, 3 tuning, 4 fault.
  array_of(t, 0x2221, "Heater state", names, state(kU8));
  array_of(t, 0x2222, "Heater fault", names, state(kU8));
  array_of(t, 0x2223, "Heater feed-forward", names,
           entry_of(kI16, kReadWrite, kLive).maps(Mapping::kRpdo).in("10mW"));
  // Writing the temperature that it shall be good at begins to measure the heater.
  array_of(t, 0x2224, "Heater tune", names, entry_of(kI16, kWriteOnly, kLive).in("0.1C"));
  // Low nibble: 0 idle, 1 heating, 2 coasting, 3 fitting, 4 done, 5 failed; high nibble: why.
  array_of(t, 0x2225, "Heater tune state", names, state(kU8));
  array_of(t, 0x2226, "Heater fault reset", names, entry_of(kU8, kWriteOnly, kLive).between(1, 1));
  // What the filament to come will take of heater 2228h: means over steps of 0.4 s, the first from now. Told
  // again four times a second and when it changes; after 1.6 s it is 0. 2229h: given so much ahead.
  array_of(t, 0x2227, "Flow power ahead", kFlowNames,
           entry_of(kI16, kReadWrite, kLive).maps(Mapping::kRpdo).in("10mW"));
  t.var(0x2228, "Heater of the flow", kU8, kReadWrite, kParameter, 1).between(1, kHeaters);
  t.var(0x2229, "Flow lead", kU16, kReadWrite, kParameter, 500).between(0, 1000).in("ms");
  array_of(t, 0x6406, "CO physical unit W and X", names, entry_of(kU32, kConst, kConstant, 0x002D'0000));
  array_of(t, 0x6407, "CO decimal digits W and X", names, entry_of(kU8, kConst, kConstant, 1));
  array_of(t, 0x6422, "CO on/off", names,
           entry_of(kU8, kReadWrite, kLive).between(0, 1).maps(Mapping::kRpdo));
  array_of(t, 0x7402, "CO set point W", names,
           entry_of(kI16, kReadWrite, kLive).maps(Mapping::kRpdo).in("0.1C"));
  array_of(t, 0x7410, "CO effective output Y", names, state(kI16).in("0.1%"));
  array_of(t, 0x7450, "CO proportional band Xp", names, setting(kI16, 300, 10, 30'000).in("0.1K"));
  array_of(t, 0x7452, "CO integral time Tn", names, setting(kI16, 400, 0, 30'000).in("0.1s"));
  array_of(t, 0x7454, "CO derivative time Tv", names, setting(kI16, 40, 0, 30'000).in("0.1s"));
}

/// CiA 401, analogue outputs: fans.
constexpr void fans(Rows& t) {
  const std::span<const std::string_view> names = kFanNames;
  array_of(t, 0x2230, "Fan function", names, setting(kU8, 0, 0, 1));  // 0: free, 1: of a hot end
  array_of(t, 0x2231, "Fan's heater", names, setting(kU8, 1, 1, kHeaters));
  array_of(t, 0x2232, "Fan kick", names, setting(kU16, 200, 0, 5000).in("ms"));
  array_of(t, 0x2233, "Fan least duty", names, setting(kU8, 15, 0, 100).in("%"));
  array_of(t, 0x2234, "Fan pulses per turn", names, setting(kU8, 0, 0, 20));  // 0: no tacho
  array_of(t, 0x2235, "Fan speed", names, state(kU16).in("1/min"));
  array_of(t, 0x6411, "Write analogue output 16-bit", names,
           entry_of(kI16, kReadWrite, kLive).maps(Mapping::kRpdo));
}

/// What tells whether filament is there, and whether it goes where the extruder turns. Lengths are of
/// filament.
constexpr void filament_sensors(Rows& t) {
  const std::span<const std::string_view> names = kFilamentNames;
  array_of(t, 0x2250, "Filament sensor kind", names, setting(kU8, 0, 0, 2));  // 0: none, 1: switch, 2: motion
  array_of(t, 0x2251, "Filament switch inverted", names, setting(kU8, 0, 0, 1));  // 1: low is filament
  array_of(t, 0x2252, "Filament for an edge", names, setting(kU32, 2880, 10, 20'000).in("um"));
  // So much commanded and no edge but the one that may be near: it stands.
  array_of(t, 0x2253, "Filament stands after", names, setting(kU32, 7000, 500, 200'000).in("um"));
  // Over so much commanded less than the share was seen: it slips.
  array_of(t, 0x2254, "Filament slip window", names, setting(kU32, 30'000, 2000, 1'000'000).in("um"));
  array_of(t, 0x2255, "Filament least share", names, setting(kU8, 60, 10, 95).in("%"));
  // Where the extruder is by the master, every 0.1 s while it turns; it may begin and wrap anywhere.
  array_of(t, 0x2256, "Filament commanded", names,
           entry_of(kI32, kReadWrite, kLive).maps(Mapping::kRpdo).in("um"));
  // Both ways: what is drawn back counts, too.
  array_of(t, 0x2257, "Filament seen", names, state(kI32).in("um"));
  // 0 in order, 1 no filament, 2 stands, 3 slips; 2 and 3 stay until 2259h.
  array_of(t, 0x2258, "Filament state", names, state(kU8));
  array_of(t, 0x2259, "Filament reset", names, entry_of(kU8, kWriteOnly, kLive).between(1, 1));
}

/// A probe with a pin, which pulses of a servo's signal move (BLTouch), and whose line the node reads.
constexpr void pin_probe(Rows& t) {
  t.var(0x2260, "Pin probe", kU8, kReadWrite, kParameter, 0).between(0, 1);  // 1: fitted
  // 1 deploy, 2 stow, 3 self test, 4 reset and stow.
  t.var(0x2261, "Pin probe command", kU8, kWriteOnly, kLive).between(1, 4);
  // 0 unknown, 1 stowed, 2 deployed, 3 moves, 4 has not come out, 5 has not come in, 6 alarm, 7 self test.
  t.var(0x2262, "Pin probe state", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  // What is written is put out until the next command; 0: no pulses.
  t.var(0x2263, "Servo pulse", kU16, kReadWrite, kLive).between(0, 2500).in("us");
  t.var(0x2264, "Pin probe line", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
}

/// An accelerometer of the tool, whose vibration the node sums up as energy over frequency. A band is 1/8192
/// of the rate wide (0.39 Hz of 3200), the first is 0 Hz. Directions are the chip's.
constexpr void accelerometer(Rows& t) {
  // 0 none, 1 ready, 2 measures, 3 its chip does not answer.
  t.var(0x2270, "Accelerometer state", kU8, kReadOnly, kLive);
  // 1 forgets what was found and measures, 2 ends that.
  t.var(0x2271, "Vibration command", kU8, kWriteOnly, kLive).between(1, 2);
  // As the node has counted them; 0 within the first second.
  t.var(0x2272, "Accelerometer readings", kU32, kReadOnly, kLive).in("mHz");
  t.var(0x2273, "Vibration windows", kU16, kReadOnly, kLive);      // summed up so far
  t.var(0x2274, "Accelerometer clipped", kU16, kReadOnly, kLive);  // readings at the end of its range
  t.var(0x2275, "Accelerometer count", kU32, kReadOnly, kLive).in("um/s2");
  t.var(0x2276, "Vibration band", kU16, kReadWrite, kLive).between(0, kVibrationBands - 1);
  // Of that band, times 2 to the power of 2278h. A sine of one count gives 2^24 in each window.
  array_of(t, 0x2277, "Vibration energy", kDirectionNames, entry_of(kU32, kReadOnly, kLive));
  array_of(t, 0x2278, "Vibration exponent", kDirectionNames, entry_of(kU8, kReadOnly, kLive));
  array_of(t, 0x2279, "Acceleration", kDirectionNames, entry_of(kI16, kReadOnly, kLive));
}

/// The node as a whole.
constexpr void heat_supervision(Rows& t) {
  t.var(0x2116, "Configuration fingerprint", kU32, kReadOnly, kLive);
  session_key(t);
  t.var(0x2240, "Contactor", kU8, kReadOnly, kLive).maps(Mapping::kTpdo);
  t.var(0x2241, "Supply voltage", kU16, kReadOnly, kLive).maps(Mapping::kTpdo).in("mV");
  // After so long without a sign of life of the master, set points become the safe ones.
  t.var(0x2242, "Master lost time", kU16, kReadWrite, kParameter, 5000).between(500, 60'000).in("ms");
  // Nothing heats before the master has written the serial number of the node that it means, 1018h:4: after
  // every start and NMT reset node. Another number is refused, and what heats goes off. 0: not confirmed.
  t.var(0x2243, "Confirmed serial number", kU32, kReadWrite, kLive);
  t.var(0x2244, "Frames that nobody vouched for", kU32, kReadOnly, kLive);
}

inline constexpr std::uint32_t mapped_nth(ObjectAddress first, int bits, int nth) {
  return mapped({first.index, static_cast<std::uint8_t>(first.subindex + nth)}, bits);
}
constexpr std::array<std::uint32_t, 8> four_of(ObjectAddress first, int bits) {
  return {mapped_nth(first, bits, 0), mapped_nth(first, bits, 1), mapped_nth(first, bits, 2),
          mapped_nth(first, bits, 3)};
}
inline constexpr std::array<PdoDefault, 4> kHeatRpdos{{
    {"SetPoints", 0x200, true, 255, 0, 0, four_of(heat_object::kSetPoint, 16)},
    {"Fans", 0x300, true, 255, 0, 0, four_of(heat_object::kFanOutput, 16)},
    {"Filament",
     0x400,
     true,
     255,
     0,
     0,
     {mapped_nth(heat_object::kFilamentCommanded, 32, 0),
      mapped_nth(heat_object::kFilamentCommanded, 32, 1)}},
    {"FlowAhead", 0x500, true, 255, 0, 0, four_of(heat_object::kFlowPower, 16)},
}};
// The state at once when it changes; the rest four times a second.
inline constexpr std::array<PdoDefault, 4> kHeatTpdos{{
    {"State",
     0x180 | kNoRtr,
     true,
     255,
     100,
     1000,
     {mapped_nth(heat_object::kHeaterState, 8, 0), mapped_nth(heat_object::kHeaterState, 8, 1),
      mapped_nth(heat_object::kHeaterState, 8, 2), mapped_nth(heat_object::kHeaterState, 8, 3),
      mapped(heat_object::kContactor, 8), mapped_nth(heat_object::kFilamentState, 8, 0),
      mapped_nth(heat_object::kFilamentState, 8, 1), mapped(heat_object::kPinState, 8)}},
    {"Temperatures", 0x280 | kNoRtr, true, 254, 0, 250, four_of(heat_object::kInputI16, 16)},
    {"Outputs", 0x380 | kNoRtr, true, 254, 0, 250, four_of(heat_object::kEffectiveOutput, 16)},
    {"MoreTemperatures",
     0x480 | kNoRtr,
     true,
     254,
     0,
     1000,
     {mapped_nth(heat_object::kInputI16, 16, 4), mapped_nth(heat_object::kInputI16, 16, 5),
      mapped(heat_object::kSupply, 16)}},
}};
inline constexpr PdoSet kHeatPdos{kHeatRpdos, kHeatTpdos};

}  // namespace object_table
}  // namespace kinebus
