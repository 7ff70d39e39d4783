// The description of Kinebus's API, made of the descriptors of kinebus.proto: it cannot tell anything else
// than what the gateway reads and writes.

#include <set>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/kinebus/kinebus_api.hpp"
#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::http {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

Json reference(const Descriptor& type) {
  // "Bodies.Fixed"
  return {{"$ref", "#/components/schemas/" + type.full_name().substr(type.file()->package().size() + 1)}};
}

Json schema_of(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return {{"type", "boolean"}};
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_FLOAT:
      return {{"type", "number"}};
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_UINT32:
      return {{"type", "integer"}};
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_UINT64:
      return {{"type", "string"}, {"pattern", "^-?[0-9]+$"}};
    case FieldDescriptor::CPPTYPE_STRING:
      if (field.type() == FieldDescriptor::TYPE_BYTES) return {{"type", "string"}, {"format", "byte"}};
      return {{"type", "string"}};
    case FieldDescriptor::CPPTYPE_ENUM: {
      Json names = Json::array();
      for (int i = 0; i < field.enum_type()->value_count(); ++i)
        names.push_back(field.enum_type()->value(i)->name());
      return {{"type", "string"}, {"enum", names}};
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return reference(*field.message_type());
  }
  return Json::object();
}

/// `type` and all that it is made of.
void add_schema(Json& schemas, std::set<const Descriptor*>& added, const Descriptor& type) {
  if (!added.insert(&type).second) return;
  Json properties = Json::object();
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    properties[field.name()] =
        field.is_repeated() ? Json{{"type", "array"}, {"items", schema_of(field)}} : schema_of(field);
    if (field.message_type() != nullptr) add_schema(schemas, added, *field.message_type());
  }
  const std::string name = type.full_name().substr(type.file()->package().size() + 1);
  schemas[name] = {{"type", "object"}, {"properties", properties}};
}

Json content(Json schema) {
  return {{"application/json", {{"schema", std::move(schema)}}}};
}

/// What a request is answered with, by the field of Reply: "get_status" has "status".
const FieldDescriptor* result_of(const FieldDescriptor& request) {
  static constexpr std::pair<const char*, const char*> kResults[] = {
      {"get_status", "status"},
      {"get_machine", "machine"},
      {"get_events", "events"},
      {"get_heat_course", "heat_course"},
      {"list_jobs", "jobs"},
      {"get_history", "history"},
      {"check_job", "preflight"},
      {"console", "console"},
      {"read_machine_file", "machine_file"},
      {"check_machine_file", "machine_file_check"}};
  for (const auto& [asked, told] : kResults)
    if (request.name() == asked) return joblink::Reply::descriptor()->FindFieldByName(told);
  return nullptr;
}

Json operation(const FieldDescriptor& request, bool get) {
  const FieldDescriptor* result = result_of(request);
  Json responses = Json::object();
  if (result != nullptr)
    responses["200"] = {{"description", "done"}, {"content", content(reference(*result->message_type()))}};
  else
    responses["204"] = {{"description", "done"}};
  responses["default"] = {
      {"description", "refused, and nothing has changed"},
      {"content", content({{"type", "object"}, {"properties", {{"error", {{"type", "string"}}}}}})}};
  Json described = {{"operationId", (get ? "GET_" : "") + request.name()}, {"responses", responses}};
  const Descriptor& fields = *request.message_type();
  if (!get) {
    described["requestBody"] = {{"content", content(reference(fields))}};
    return described;
  }
  Json parameters = Json::array();
  for (int i = 0; i < fields.field_count(); ++i)
    parameters.push_back(
        {{"name", fields.field(i)->name()}, {"in", "query"}, {"schema", schema_of(*fields.field(i))}});
  described["parameters"] = parameters;
  return described;
}

}  // namespace

std::string openapi(const std::string& version) {
  Json paths = Json::object(), schemas = Json::object();
  std::set<const Descriptor*> added;
  for (const FieldDescriptor* request : plain_requests()) {
    Json& path = paths["/kinebus/v1/" + request->name()];
    if (only_asks(*request)) path["get"] = operation(*request, true);
    path["post"] = operation(*request, false);
    add_schema(schemas, added, *request->message_type());
    if (const FieldDescriptor* result = result_of(*request))
      add_schema(schemas, added, *result->message_type());
  }
  // What the websocket under /kinebus/v1/socket hears and tells.
  add_schema(schemas, added, *joblink::ClientMessage::descriptor());
  add_schema(schemas, added, *joblink::ServerMessage::descriptor());
  return text_of(
      {{"openapi", "3.0.3"},
       {"info",
        {{"title", "Kinebus"},
         {"version", version},
         {"description",
          "Units are the ends of the names. The websocket under /kinebus/v1/socket takes ClientMessage and "
          "tells "
          "ServerMessage; its first message is a hello with the key as its token. Uploads: PUT "
          "/api/v1/files/local/NAME."}}},
       {"security", {{{"key", Json::array()}}}},
       {"paths", paths},
       {"components",
        {{"securitySchemes", {{"key", {{"type", "apiKey"}, {"in", "header"}, {"name", "X-Api-Key"}}}}},
         {"schemas", schemas}}}});
}

}  // namespace kinebus::http
