#pragma once
// What every alarm means and what to do: the one place where codes have words. The literals here are English;
// tools/check/sentences demands each of them in every language of the desktop program.

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus {

/// Why a node asks all to stop, by StopReason; nullptr: it does not.
struct StopWords {
  const char* words;
  const char* advice;
};
inline constexpr std::array<StopWords, 12> kStopWords{{
    {nullptr, nullptr},
    {"its queue ran low", "clear and resume; when it comes again, check the load of gateway and bus"},
    {"a record was lost", "clear; when it comes again, check the bus for errors"},
    {"its position is not the gateway's",
     "clear: positions are read again; when it comes again, check the bus for errors"},
    {"a record broke its limits", "clear; check the machine file against the node's limits"},
    {"the emergency stop input", "release the emergency stop when it is safe, then clear"},
    {"a limit switch", "move the carriage off the switch, then clear and home again"},
    {"the gateway's heartbeat is missing", "check the gateway and the bus, then clear"},
    {"SYNC is missing", "check the gateway and the bus, then clear"},
    {"fault of a drive", "look at the drive's fault, then clear"},
    {"its drives were switched off in motion", "clear and enable again"},
    {"another node asked for it", "look at the other node's message"},
}};

struct AlarmRow {
  std::uint16_t code;
  const char* name;  ///< a headline
  const char*
      words;  ///< what has happened, as part of a sentence; nullptr: the gateway says it with the place
  const char* advice;  ///< what to do next
};

namespace alarm_table {
constexpr AlarmRow gateway(AlarmCode code, const char* name, const char* advice) {
  return {static_cast<std::uint16_t>(code), name, nullptr, advice};
}
constexpr AlarmRow stop(std::uint16_t code, std::size_t reason, const char* name) {
  return {code, name, kStopWords[reason].words, kStopWords[reason].advice};
}
constexpr const char* kWrongLength = "A frame on the bus has the wrong length";
constexpr const char* kCheckSensor = "check the sensor, its plug and its wires, then clear";
constexpr const char* kLookForMaster = "look for another master on the bus, update the node's firmware";
}  // namespace alarm_table

/// In the order of their codes.
inline constexpr std::array kAlarms{
    AlarmRow{emcy::kOverCurrent, "Too much current in a motor", "over-current in a motor phase",
             "check the motor and its cable for a short, then clear"},
    AlarmRow{emcy::kShortCircuit, "A motor phase is shorted", "a motor phase is shorted",
             "switch off, check the motor and its cable"},
    AlarmRow{emcy::kShortToGround, "A motor phase is shorted to ground", "a motor phase is shorted to ground",
             "switch off, check the motor and its cable"},
    AlarmRow{emcy::kShortToSupply, "A motor phase is shorted to the supply",
             "a motor phase is shorted to the supply", "switch off, check the motor and its cable"},
    AlarmRow{emcy::kPhaseOpen, "A motor phase is open", "a motor phase carries no current",
             "check the motor's plug and cable for a break, then clear"},
    AlarmRow{emcy::kOverVoltage, "The supply voltage is too high", "supply voltage too high",
             "check the power supply"},
    AlarmRow{emcy::kUnderVoltage, "The supply voltage is too low", "supply voltage too low",
             "check the power supply and its wiring"},
    AlarmRow{emcy::kHeaterTooHot, "A heater is too hot", "a heater is above its limit",
             "let it cool; check heater and sensor, then clear"},
    AlarmRow{emcy::kDeviceTemperature, "A node is too hot", "the node is too hot",
             "let it cool, check the fan"},
    AlarmRow{emcy::kDriveTemperature, "A drive is too hot", "a motor driver is too hot",
             "let it cool, lower the current, check the fan"},
    AlarmRow{emcy::kSensorOpen, "A temperature sensor is open", "a temperature sensor or its wire is open",
             alarm_table::kCheckSensor},
    AlarmRow{emcy::kSensorShort, "A temperature sensor is shorted", "a temperature sensor is shorted",
             alarm_table::kCheckSensor},
    AlarmRow{emcy::kSensorJump, "A temperature sensor jumps", "a temperature changed faster than it can",
             alarm_table::kCheckSensor},
    AlarmRow{emcy::kSensorSilent, "A temperature sensor is silent", "a temperature is not measured any more",
             alarm_table::kCheckSensor},
    AlarmRow{emcy::kHeatMissing, "A heater does not heat as it should",
             "a heater's power does not arrive at its sensor",
             "check that heater and sensor sit tight and are the right ones, then clear"},
    AlarmRow{emcy::kHeatUnasked, "A heater heats without being told to",
             "a heater's switch does not open: the contactor was opened",
             "switch off, let it cool, replace the heater's switch"},
    AlarmRow{emcy::kFanStalled, "A fan stands still", "a fan does not turn",
             "check the fan and its plug, then clear"},
    AlarmRow{emcy::kControlHardware, "A node's power stage does not work",
             "the power stage does not measure the motor's currents",
             "switch the node off and on; when it comes again, replace the board"},
    AlarmRow{emcy::kOtherBoard, "A node's program is for another board",
             "its program is for another board or chip: it drives nothing",
             "write the program for this board (kinebus-setup boards shows what it is)"},
    AlarmRow{emcy::kNoMotor, "A motor that a board does not have was switched on",
             "this board has no motor driver for that axis",
             "take the axis out of the machine file, or name the node that has it"},
    AlarmRow{emcy::kCrystal, "A board cannot measure its crystal",
             "the crystal was not measured: the board runs as with its own one",
             "check that the board is the one that the image is for"},
    AlarmRow{emcy::kDriverReset, "A motor driver has lost its settings",
             "a motor driver has lost its settings: its supply was gone",
             "check the motor supply, then clear and home again"},
    AlarmRow{emcy::kStorage, "A node's stored settings are damaged", "stored parameters are damaged",
             "bring up again: the gateway writes them anew"},
    AlarmRow{emcy::kSoftware, "A node's software has failed", "internal software fault",
             "switch the node off and on, report it"},
    AlarmRow{emcy::kEncoder, "An encoder has failed", "encoder fault", "check the encoder's cable"},
    AlarmRow{emcy::kIncrementalEncoder, "An encoder has failed", "encoder fault",
             "check the encoder's cable"},
    AlarmRow{emcy::kDriverSilent, "A motor driver does not answer",
             "a motor driver does not answer by UART or SPI",
             "check the motor supply, the driver's seat and its jumpers for UART or SPI, then clear"},
    AlarmRow{emcy::kCanOverrun, "A node has lost frames of the bus", "CAN frames were lost (overrun)",
             "check the load of the bus"},
    AlarmRow{emcy::kErrorPassive, "Many errors on the bus", "many CAN errors",
             "check cable and termination of the bus"},
    AlarmRow{emcy::kHeartbeat, "A node does not hear the gateway",
             "the gateway's heartbeat or SYNC was missed", "check the gateway and the bus, then clear"},
    AlarmRow{emcy::kBusOffRecovered, "A node was off the bus", "recovered from bus-off",
             "check cable and termination of the bus"},
    AlarmRow{emcy::kIdCollision, "Two nodes use the same id", "two nodes use the same id",
             "give one of them another id (kinebus-node-id)"},
    AlarmRow{emcy::kPdoRefused, "A frame on the bus has a wrong value",
             "a PDO had a value that is not allowed", alarm_table::kLookForMaster},
    AlarmRow{emcy::kPdoTooShort, alarm_table::kWrongLength, "a PDO was too short",
             alarm_table::kLookForMaster},
    AlarmRow{emcy::kPdoTooLong, alarm_table::kWrongLength, "a PDO was too long", alarm_table::kLookForMaster},
    AlarmRow{emcy::kSyncLength, alarm_table::kWrongLength, "a SYNC had the wrong length",
             alarm_table::kLookForMaster},
    AlarmRow{emcy::kRpdoTimeout, "A frame to a node did not come in time", "an expected PDO did not arrive",
             "check the load of the bus"},
    AlarmRow{emcy::kFollowingError, "A motor does not follow", "following error: the motor did not follow",
             "look for an obstacle, home again"},
    AlarmRow{emcy::kPositionLimit, "A position limit was reached", "a position limit was reached",
             "check the machine file's limits, home again"},
    AlarmRow{emcy::kSyncController, "A node has lost the common time", "clock synchronisation was lost",
             "check the bus, then clear"},

    alarm_table::stop(node_emcy::kStarved, 1, "A node's queue ran low"),
    alarm_table::stop(node_emcy::kSequence, 2, "A motion record was lost"),
    alarm_table::stop(node_emcy::kCheckpoint, 3, "A node is not where the gateway has sent it"),
    alarm_table::stop(node_emcy::kStream, 4, "A motion record broke a node's limits"),
    alarm_table::stop(node_emcy::kCommand, 10, "Drives were switched off in motion"),
    alarm_table::stop(node_emcy::kEmergencyStop, 5, "Emergency stop"),
    alarm_table::stop(node_emcy::kLimitSwitch, 6, "A limit switch was reached"),
    AlarmRow{node_emcy::kNotVouched, "A node has refused a frame of another device",
             "a frame without the session's check value was refused", alarm_table::kLookForMaster},
    AlarmRow{node_emcy::kHoming, "Homing has failed", "homing did not find the switch's edge",
             "check switch and wiring, then clear and home again"},

    alarm_table::gateway(
        AlarmCode::kNodeMissing, "A node does not answer",
        "check the node's power, its id (kinebus-node-id) and the bus cable, then bring up again"),
    alarm_table::gateway(AlarmCode::kWrongIdentity, "The wrong node is connected",
                         "connect the right node or update its firmware"),
    alarm_table::gateway(AlarmCode::kConfiguration, "A node refuses its settings",
                         "check the machine file against the node's limits"),
    alarm_table::gateway(AlarmCode::kEnableFailed, "A drive does not switch on",
                         "look at the drive's fault, clear, then bring up again"),
    alarm_table::gateway(AlarmCode::kSecondGateway, "There is a second gateway on the bus",
                         "switch one of the gateways off"),
    alarm_table::gateway(AlarmCode::kHeartbeatLost, "A node has gone silent",
                         "check the node's power and the bus cable, then clear and bring up again"),
    alarm_table::gateway(AlarmCode::kNodeRestarted, "A node has restarted",
                         "check the node's power, then clear, bring up and home again"),
    alarm_table::gateway(AlarmCode::kSyncError, "The clocks have drifted apart",
                         "check the bus for errors, then clear"),
    alarm_table::gateway(AlarmCode::kHomingFailed, "Homing has failed",
                         "check switch and wiring, then clear and home again"),
    alarm_table::gateway(AlarmCode::kHomingSpread, "The carriages are too far apart",
                         "check the switches of the carriages that went on, then clear and home again"),
    alarm_table::gateway(AlarmCode::kHomingTimeout, "Homing took too long",
                         "check switches and home speeds, then clear and home again"),
    alarm_table::gateway(AlarmCode::kStreamLost, "Motion was interrupted",
                         "clear: positions are known, the job can be run again"),
    alarm_table::gateway(AlarmCode::kPathTimeDiffers, "The nodes disagree about the path",
                         "clear; when it comes again, check the bus for lost frames"),
    alarm_table::gateway(AlarmCode::kBusFailure, "The bus has failed",
                         "check cable and termination of the bus, then clear and bring up again"),
    alarm_table::gateway(AlarmCode::kThermal, "A heater is not as it should be",
                         "check heater and sensor, then clear; a job that is held goes on by resume"),
    alarm_table::gateway(AlarmCode::kJobError, "The job went wrong", "correct the job, then clear"),
    alarm_table::gateway(AlarmCode::kEmergencyStop, "Stopped by the operator",
                         "clear when the machine is safe"),
    alarm_table::gateway(AlarmCode::kStopTimeout, "The machine did not come to rest",
                         "switch the machine off and on, home again"),
    alarm_table::gateway(
        AlarmCode::kIdTaken, "Two nodes use the same id",
        "give one of them another id (kinebus-node-id) or take it off the bus, then clear and "
        "bring up again"),
    alarm_table::gateway(AlarmCode::kNodeChanged, "Another device has changed a node",
                         "look for another master or tool on the bus, then clear"),
    alarm_table::gateway(AlarmCode::kFilament, "Filament does not come",
                         "put filament in, or free it on its way, then resume"),
};

/// Codes of CiA 301 that no part of Kinebus sends, by their first digit.
inline constexpr std::array kAlarmClasses{
    AlarmRow{0x1000, "A node reports a fault", "general fault", "look at the node's state, then clear"},
    AlarmRow{0x2000, "Too much current in a motor", "current fault", "check motor and cable"},
    AlarmRow{0x3000, "The supply voltage is wrong", "voltage fault", "check the power supply"},
    AlarmRow{0x4000, "A drive is too hot", "temperature fault", "let it cool"},
    AlarmRow{0x5000, "A node reports a fault", "hardware fault", "switch the node off and on"},
    AlarmRow{0x6000, "A node's software has failed", "software fault", "switch the node off and on"},
    AlarmRow{0x7000, "A node reports a fault", "fault of an additional module",
             "look at the node's state, then clear"},
    AlarmRow{0x8000, "Communication trouble on the bus", "monitoring fault", "check the bus, then clear"},
    AlarmRow{0xF000, "A node reports a fault", "additional function fault",
             "look at the node's state, then clear"},
};
inline constexpr AlarmRow kUnknownAlarm{0, "A node reports a fault", "unknown fault",
                                        "look at the node's state, then clear"};

/// The code's own row, else its class's; never nothing.
constexpr const AlarmRow& alarm_row(std::uint16_t code) {
  for (const AlarmRow& row : kAlarms)
    if (row.code == code) return row;
  for (const AlarmRow& row : kAlarmClasses)
    if (row.code == (code & 0xF000)) return row;
  return kUnknownAlarm;
}
constexpr const AlarmRow& alarm_row(AlarmCode code) {
  return alarm_row(static_cast<std::uint16_t>(code));
}

namespace alarm_table {
constexpr bool is_sorted() {
  for (std::size_t i = 1; i < kAlarms.size(); ++i)
    if (kAlarms[i - 1].code >= kAlarms[i].code) return false;
  return true;
}
static_assert(is_sorted(), "alarms stand in the order of their codes, each once");
}  // namespace alarm_table

}  // namespace kinebus
