#include "gateway/machine/alarm.hpp"

#include <array>
#include <cstdio>

namespace kinebus {
namespace {

struct EmergencyRow {
  std::uint16_t code;
  const char* words;
  const char* advice;
};
constexpr std::array kEmergencies{
    EmergencyRow{0x2310, "over-current in a motor phase",
                 "check the motor and its cable for a short, then clear"},
    EmergencyRow{0x2320, "a motor phase is shorted", "switch off, check the motor and its cable"},
    EmergencyRow{0x3210, "supply voltage too high", "check the power supply"},
    EmergencyRow{0x3220, "supply voltage too low", "check the power supply and its wiring"},
    EmergencyRow{0x4210, "the node is too hot", "let it cool, check the fan"},
    EmergencyRow{0x4310, "a motor driver is too hot", "let it cool, lower the current, check the fan"},
    EmergencyRow{0x5530, "stored parameters are damaged", "bring up again: the gateway writes them anew"},
    EmergencyRow{0x6100, "internal software fault", "switch the node off and on, report it"},
    EmergencyRow{0x6200, "user software fault", "switch the node off and on, report it"},
    EmergencyRow{0x7300, "encoder fault", "check the encoder's cable"},
    EmergencyRow{0x7305, "encoder fault", "check the encoder's cable"},
    EmergencyRow{0x8110, "CAN frames were lost (overrun)", "check the load of the bus"},
    EmergencyRow{0x8120, "many CAN errors", "check cable and termination of the bus"},
    EmergencyRow{0x8130, "the gateway's heartbeat or SYNC was missed",
                 "check the gateway and the bus, then clear"},
    EmergencyRow{0x8140, "recovered from bus-off", "check cable and termination of the bus"},
    EmergencyRow{0x8150, "two nodes use the same id", "give one of them another id (LSS)"},
    EmergencyRow{0x8250, "an expected PDO did not arrive", "check the load of the bus"},
    EmergencyRow{0x8611, "following error: the motor did not follow", "look for an obstacle, home again"},
    EmergencyRow{0x8612, "a position limit was reached", "check the machine file's limits, home again"},
    EmergencyRow{0x8700, "clock synchronisation was lost", "check the bus, then clear"},
};
constexpr std::array kClasses{
    EmergencyRow{0x1000, "general fault", "look at the node's state, then clear"},
    EmergencyRow{0x2000, "current fault", "check motor and cable"},
    EmergencyRow{0x3000, "voltage fault", "check the power supply"},
    EmergencyRow{0x4000, "temperature fault", "let it cool"},
    EmergencyRow{0x5000, "hardware fault", "switch the node off and on"},
    EmergencyRow{0x6000, "software fault", "switch the node off and on"},
    EmergencyRow{0x7000, "fault of an additional module", "look at the node's state, then clear"},
    EmergencyRow{0x8000, "monitoring fault", "check the bus, then clear"},
    EmergencyRow{0xF000, "additional function fault", "look at the node's state, then clear"},
};

struct ReasonRow {
  const char* words;
  const char* advice;
};
/// By StopReason.
constexpr std::array kReasons{
    ReasonRow{"", ""},
    ReasonRow{"its queue ran low",
              "clear and resume; when it comes again, check the load of gateway and bus"},
    ReasonRow{"a record was lost", "clear; when it comes again, check the bus for errors"},
    ReasonRow{"its position is not the gateway's", "clear and home again"},
    ReasonRow{"a record broke its limits", "clear; check the machine file against the node's limits"},
    ReasonRow{"the emergency stop input", "release the emergency stop when it is safe, then clear"},
    ReasonRow{"a limit switch", "move the carriage off the switch, then clear and home again"},
    ReasonRow{"the gateway's heartbeat is missing", "check the gateway and the bus, then clear"},
    ReasonRow{"SYNC is missing", "check the gateway and the bus, then clear"},
    ReasonRow{"fault of a drive", "look at the drive's fault, then clear"},
    ReasonRow{"its drives were switched off in motion", "clear and enable again"},
    ReasonRow{"another node asked for it", "look at the other node's message"},
};

}  // namespace

AlarmText describe_emergency(const Emergency& emergency) {
  const EmergencyRow* found = nullptr;
  for (const auto& row : kEmergencies)
    if (row.code == emergency.code) found = &row;
  if (!found)
    for (const auto& row : kClasses)
      if ((emergency.code & 0xF000) == row.code) found = &row;
  const auto reason = static_cast<std::size_t>(emergency.vendor[0] & 0x7F);
  AlarmText text;
  text.words = "node " + std::to_string(emergency.node) + ": ";
  const bool own = (emergency.code & 0xFF00) == 0xFF00;
  if (!own || reason == 0 || reason >= kReasons.size()) text.words += found ? found->words : "unknown fault";
  if (reason > 0 && reason < kReasons.size()) {
    if (!own) text.words += "; ";
    text.words += kReasons[reason].words;
  }
  if ((emergency.vendor[0] & 0x80) != 0) text.words += ", axis B";
  char code[24];
  std::snprintf(code, sizeof code, " (EMCY %04Xh)", static_cast<unsigned>(emergency.code));
  text.words += code;
  const bool by_reason = own && reason > 0 && reason < kReasons.size();
  text.advice = by_reason ? kReasons[reason].advice
                : found   ? found->advice
                          : "look at the node's state, then clear";
  return text;
}

std::string_view advice_for(AlarmCode code) {
  switch (code) {
    case AlarmCode::kNodeMissing:
      return "check the node's power and the bus cable, then bring up again";
    case AlarmCode::kWrongIdentity:
      return "connect the right node or update its firmware";
    case AlarmCode::kConfiguration:
      return "check the machine file against the node's limits";
    case AlarmCode::kEnableFailed:
      return "look at the drive's fault, clear, then bring up again";
    case AlarmCode::kSecondGateway:
      return "switch one of the gateways off";
    case AlarmCode::kHeartbeatLost:
      return "check the node's power and the bus cable, then clear and bring up again";
    case AlarmCode::kNodeRestarted:
      return "check the node's power, then clear, bring up and home again";
    case AlarmCode::kSyncError:
      return "check the bus for errors, then clear";
    case AlarmCode::kHomingFailed:
      return "check switch and wiring, then clear and home again";
    case AlarmCode::kHomingSpread:
      return "check the switches of the carriages that went on, then clear and home again";
    case AlarmCode::kHomingTimeout:
      return "check switches and home speeds, then clear and home again";
    case AlarmCode::kStreamLost:
      return "clear: positions are known, the job can be run again";
    case AlarmCode::kPathTimeDiffers:
      return "clear; when it comes again, check the bus for lost frames";
    case AlarmCode::kBusFailure:
      return "check cable and termination of the bus, then clear and bring up again";
    case AlarmCode::kThermal:
      return "check heater and sensor, then clear";
    case AlarmCode::kJobError:
      return "correct the job, then clear";
    case AlarmCode::kEmergencyStop:
      return "clear when the machine is safe";
    case AlarmCode::kStopTimeout:
      return "switch the machine off and on, home again";
    case AlarmCode::kIdTaken:
      return "give one of them another id (LSS) or take it off the bus, then clear and bring up again";
  }
  return "clear";
}

}  // namespace kinebus
