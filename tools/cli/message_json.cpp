#include "tools/cli/message_json.hpp"

#include <google/protobuf/util/json_util.h>

#include <nlohmann/json.hpp>

namespace kinebus {

std::string to_json_text(const google::protobuf::Message& message, const std::vector<std::string>& fields) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string text;
  // A message in memory always has a JSON form.
  static_cast<void>(google::protobuf::util::MessageToJsonString(message, &text, options));
  if (fields.empty()) return text;
  const auto all = nlohmann::ordered_json::parse(text);
  nlohmann::ordered_json asked;
  for (const std::string& field : fields)
    if (all.contains(field)) asked[field] = all[field];
  return asked.dump(1) + "\n";
}

}  // namespace kinebus
