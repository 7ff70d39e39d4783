#pragma once
// What becomes of the node's own EMCY codes.

#include <array>
#include <cstdint>

#include "protocol/canopen/alarm_codes.hpp"

namespace kinebus::node_emcy {

/// Those that are over when the stop they caused is cleared.
inline constexpr std::array kEndWithClear{kStarved, kSequence,      kCheckpoint,  kStream,
                                          kCommand, kEmergencyStop, kLimitSwitch, emcy::kSyncController};

}  // namespace kinebus::node_emcy
