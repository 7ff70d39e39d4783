#pragma once
// The words of the local socket: one JSON object a line, both ways. Here only values become text and back.
//
//   to the daemon    {"id": 7, "do": "jog", "x": 10, "speed": 50}
//   from the daemon  {"id": 7, "ok": true, ...}   or   {"id": 7, "ok": false, "error": "why, in words"}
//                    {"status": {...}} and {"event": {...}} to those who asked by {"do": "watch", "hz": 10}

#include <nlohmann/json_fwd.hpp>

#include "gateway/machine/event.hpp"
#include "gateway/machine/status.hpp"

namespace kinebus {

/// Lengths in mm, angles in degrees, times in seconds: what people read.
nlohmann::json to_json(const MachineStatus& status);
nlohmann::json to_json(const MachineEvent& event);

/// Nothing moves and nothing will by itself.
bool at_rest(MachineState state);

}  // namespace kinebus
