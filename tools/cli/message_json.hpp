#pragma once
// What the gateway says as JSON for scripts: protobuf's own JSON of kinebus.proto, with its names, values of
// 0 too.

#include <google/protobuf/message.h>

#include <string>
#include <vector>

namespace kinebus {
/// `fields`: only these; none: all. A message that is not set is left out.
std::string to_json_text(const google::protobuf::Message& message,
                         const std::vector<std::string>& fields = {});
}  // namespace kinebus
