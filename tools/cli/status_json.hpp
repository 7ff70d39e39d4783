#pragma once
// A status as JSON for scripts: protobuf's own JSON of kinebus.proto's Status, with its names, values of 0
// too.

#include <string>
#include <vector>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus {
/// `fields`: only these; none: all. A message that is not set is left out.
std::string to_json_text(const joblink::Status& status, const std::vector<std::string>& fields = {});
}  // namespace kinebus
