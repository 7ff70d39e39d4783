#include "gateway/status/alarm.hpp"

#include <array>

namespace kinebus {
namespace {

struct EmergencyRow {
  std::uint16_t code;
  const char* words;
  const char* advice;
};
constexpr std::array kEmergencies{
    EmergencyRow{0x2310, phrase("over-current in a motor phase"),
                 phrase("check the motor and its cable for a short, then clear")},
    EmergencyRow{0x2320, phrase("a motor phase is shorted"),
                 phrase("switch off, check the motor and its cable")},
    EmergencyRow{0x3210, phrase("supply voltage too high"), phrase("check the power supply")},
    EmergencyRow{0x3220, phrase("supply voltage too low"), phrase("check the power supply and its wiring")},
    EmergencyRow{0x4210, phrase("the node is too hot"), phrase("let it cool, check the fan")},
    EmergencyRow{0x4310, phrase("a motor driver is too hot"),
                 phrase("let it cool, lower the current, check the fan")},
    EmergencyRow{0x5530, phrase("stored parameters are damaged"),
                 phrase("bring up again: the gateway writes them anew")},
    EmergencyRow{0x6100, phrase("internal software fault"), phrase("switch the node off and on, report it")},
    EmergencyRow{0x6200, phrase("user software fault"), phrase("switch the node off and on, report it")},
    EmergencyRow{0x7300, phrase("encoder fault"), phrase("check the encoder's cable")},
    EmergencyRow{0x7305, phrase("encoder fault"), phrase("check the encoder's cable")},
    EmergencyRow{0x8110, phrase("CAN frames were lost (overrun)"), phrase("check the load of the bus")},
    EmergencyRow{0x8120, phrase("many CAN errors"), phrase("check cable and termination of the bus")},
    EmergencyRow{0x8130, phrase("the gateway's heartbeat or SYNC was missed"),
                 phrase("check the gateway and the bus, then clear")},
    EmergencyRow{0x8140, phrase("recovered from bus-off"), phrase("check cable and termination of the bus")},
    EmergencyRow{0x8150, phrase("two nodes use the same id"),
                 phrase("give one of them another id (kinebus-node-id)")},
    EmergencyRow{0x8250, phrase("an expected PDO did not arrive"), phrase("check the load of the bus")},
    EmergencyRow{0x8611, phrase("following error: the motor did not follow"),
                 phrase("look for an obstacle, home again")},
    EmergencyRow{0x8612, phrase("a position limit was reached"),
                 phrase("check the machine file's limits, home again")},
    EmergencyRow{0x8700, phrase("clock synchronisation was lost"), phrase("check the bus, then clear")},
};
constexpr std::array kClasses{
    EmergencyRow{0x1000, phrase("general fault"), phrase("look at the node's state, then clear")},
    EmergencyRow{0x2000, phrase("current fault"), phrase("check motor and cable")},
    EmergencyRow{0x3000, phrase("voltage fault"), phrase("check the power supply")},
    EmergencyRow{0x4000, phrase("temperature fault"), phrase("let it cool")},
    EmergencyRow{0x5000, phrase("hardware fault"), phrase("switch the node off and on")},
    EmergencyRow{0x6000, phrase("software fault"), phrase("switch the node off and on")},
    EmergencyRow{0x7000, phrase("fault of an additional module"),
                 phrase("look at the node's state, then clear")},
    EmergencyRow{0x8000, phrase("monitoring fault"), phrase("check the bus, then clear")},
    EmergencyRow{0xF000, phrase("additional function fault"), phrase("look at the node's state, then clear")},
};

struct ReasonRow {
  const char* words;
  const char* advice;
};
/// By StopReason.
constexpr std::array kReasons{
    ReasonRow{nullptr, nullptr},
    ReasonRow{phrase("its queue ran low"),
              phrase("clear and resume; when it comes again, check the load of gateway and bus")},
    ReasonRow{phrase("a record was lost"), phrase("clear; when it comes again, check the bus for errors")},
    ReasonRow{phrase("its position is not the gateway's"), phrase("clear and home again")},
    ReasonRow{phrase("a record broke its limits"),
              phrase("clear; check the machine file against the node's limits")},
    ReasonRow{phrase("the emergency stop input"),
              phrase("release the emergency stop when it is safe, then clear")},
    ReasonRow{phrase("a limit switch"),
              phrase("move the carriage off the switch, then clear and home again")},
    ReasonRow{phrase("the gateway's heartbeat is missing"),
              phrase("check the gateway and the bus, then clear")},
    ReasonRow{phrase("SYNC is missing"), phrase("check the gateway and the bus, then clear")},
    ReasonRow{phrase("fault of a drive"), phrase("look at the drive's fault, then clear")},
    ReasonRow{phrase("its drives were switched off in motion"), phrase("clear and enable again")},
    ReasonRow{phrase("another node asked for it"), phrase("look at the other node's message")},
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
  const bool own = (emergency.code & 0xFF00) == 0xFF00;
  const bool reasoned = reason > 0 && reason < kReasons.size();
  Sentence fault = say(found ? found->words : phrase("unknown fault"));
  if (reasoned) fault = own ? say(kReasons[reason].words) : say("%1; %2", fault, say(kReasons[reason].words));
  if ((emergency.vendor[0] & 0x80) != 0) fault = say("%1, axis B", fault);
  text.words = say("node %1: %2 (EMCY %3)", emergency.node, fault,
                   printed("%04Xh", static_cast<unsigned>(emergency.code)));
  text.advice = own && reasoned ? say(kReasons[reason].advice)
                : found         ? say(found->advice)
                                : say("look at the node's state, then clear");
  return text;
}

Sentence advice_for(AlarmCode code) {
  switch (code) {
    case AlarmCode::kNodeMissing:
      return say("check the node's power, its id (kinebus-node-id) and the bus cable, then bring up again");
    case AlarmCode::kWrongIdentity:
      return say("connect the right node or update its firmware");
    case AlarmCode::kConfiguration:
      return say("check the machine file against the node's limits");
    case AlarmCode::kEnableFailed:
      return say("look at the drive's fault, clear, then bring up again");
    case AlarmCode::kSecondGateway:
      return say("switch one of the gateways off");
    case AlarmCode::kHeartbeatLost:
      return say("check the node's power and the bus cable, then clear and bring up again");
    case AlarmCode::kNodeRestarted:
      return say("check the node's power, then clear, bring up and home again");
    case AlarmCode::kSyncError:
      return say("check the bus for errors, then clear");
    case AlarmCode::kHomingFailed:
      return say("check switch and wiring, then clear and home again");
    case AlarmCode::kHomingSpread:
      return say("check the switches of the carriages that went on, then clear and home again");
    case AlarmCode::kHomingTimeout:
      return say("check switches and home speeds, then clear and home again");
    case AlarmCode::kStreamLost:
      return say("clear: positions are known, the job can be run again");
    case AlarmCode::kPathTimeDiffers:
      return say("clear; when it comes again, check the bus for lost frames");
    case AlarmCode::kBusFailure:
      return say("check cable and termination of the bus, then clear and bring up again");
    case AlarmCode::kThermal:
      return say("check heater and sensor, then clear");
    case AlarmCode::kJobError:
      return say("correct the job, then clear");
    case AlarmCode::kEmergencyStop:
      return say("clear when the machine is safe");
    case AlarmCode::kStopTimeout:
      return say("switch the machine off and on, home again");
    case AlarmCode::kIdTaken:
      return say(
          "give one of them another id (kinebus-node-id) or take it off the bus, then clear and bring up "
          "again");
  }
  return say("clear");
}

}  // namespace kinebus
