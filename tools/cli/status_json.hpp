#pragma once
// A status as JSON for scripts: lengths in mm, angles in degrees, times in seconds.

#include <nlohmann/json_fwd.hpp>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {
nlohmann::json to_json(const joblink::Status& status);
}  // namespace kinebus
