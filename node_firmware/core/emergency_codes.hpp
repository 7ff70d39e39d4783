#pragma once
// The node's own EMCY codes (FFxxh is for the device). What a code stops is in the vendor bytes: StopRequest.

#include <array>
#include <cstdint>

#include "protocol/canopen/emcy.hpp"

namespace kinebus::node_emcy {

inline constexpr std::uint16_t kStarved = 0xFF01, kSequence = 0xFF02, kCheckpoint = 0xFF03, kStream = 0xFF04,
                               kCommand = 0xFF05, kEmergencyStop = 0xFF06, kLimitSwitch = 0xFF07,
                               kHoming = 0xFF10;

/// Those that are over when the stop they caused is cleared.
inline constexpr std::array kEndWithClear{kStarved, kSequence,      kCheckpoint,  kStream,
                                          kCommand, kEmergencyStop, kLimitSwitch, emcy::kSyncController};

}  // namespace kinebus::node_emcy
