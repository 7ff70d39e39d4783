#pragma once
// Messages of the job link as JSON, by protobuf's own mapping (protobuf.dev, "ProtoJSON") with the names as
// in kinebus.proto: 64-bit numbers are texts, bytes base64, enums their names. All fields are there, but for
// messages and optional ones that are not set.

#include <google/protobuf/message.h>

#include <string>
#include <string_view>

#include "gateway/result.hpp"

namespace kinebus::http {

/// Appends. Written here because protobuf's own writer takes several times as long, within the loop of the
/// machine.
void append_json(std::string& text, const google::protobuf::Message& message);
std::string to_json(const google::protobuf::Message& message);

/// Error: what is wrong, in words. Unknown fields are wrong.
Result<void, std::string> from_json(std::string_view text, google::protobuf::Message& message);

}  // namespace kinebus::http
