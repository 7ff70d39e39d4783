#include "tools/cli/status_json.hpp"

#include <google/protobuf/util/json_util.h>

namespace kinebus {

std::string to_json_text(const joblink::Status& status) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  // A message in memory always has a JSON form.
  static_cast<void>(google::protobuf::util::MessageToJsonString(status, &text, options));
  return text;
}

}  // namespace kinebus
