#pragma once
// A status as JSON for scripts: protobuf's own JSON of kinebus.proto's Status, with its names, values of 0
// too.

#include <string>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {
std::string to_json_text(const joblink::Status& status);
}  // namespace kinebus
