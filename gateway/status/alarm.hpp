#pragma once
// Alarms in plain words: what happened and what to do next. Codes below 0xFF00 are the EMCY error codes of
// the nodes (CiA 301 and 402), codes from 0xFF80 on are the gateway's own.

#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/sentence.hpp"

#include "protocol/canopen/emcy.hpp"

namespace kinebus {

enum class AlarmCode : std::uint16_t {
  kNodeMissing = 0xFF80,    ///< no sign of life during bring-up
  kWrongIdentity = 0xFF81,  ///< another product or too old a revision
  kConfiguration = 0xFF82,  ///< a parameter was refused by the node
  kEnableFailed = 0xFF83,   ///< a drive does not reach Operation Enabled
  kSecondGateway = 0xFF84,
  kHeartbeatLost = 0xFF85,
  kNodeRestarted = 0xFF86,  ///< boot-up in the midst of operation: its position is gone
  kSyncError = 0xFF87,      ///< a clock estimate left its bound
  kHomingFailed = 0xFF88,
  kHomingSpread = 0xFF89,
  kHomingTimeout = 0xFF8A,
  kStreamLost = 0xFF8B,  ///< sequence gap, checkpoint or underrun
  kPathTimeDiffers = 0xFF8C,
  kBusFailure = 0xFF8D,
  kThermal = 0xFF8E,
  kJobError = 0xFF8F,       ///< a job went wrong in the midst of running
  kEmergencyStop = 0xFF90,  ///< M112 or the operator's stop
  kStopTimeout = 0xFF91,    ///< the nodes did not come to rest as they should
  kIdTaken = 0xFF92,        ///< two nodes answer to one id
};

struct AlarmText {
  Sentence words;
  Sentence advice;
};

/// Words for what a node reports; why it asks all to stop (StopReason) is part of them.
AlarmText describe_emergency(const Emergency& emergency);
/// Advice for the gateway's own alarms.
Sentence advice_for(AlarmCode code);

}  // namespace kinebus
