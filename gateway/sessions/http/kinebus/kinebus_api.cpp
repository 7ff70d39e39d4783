#include "gateway/sessions/http/kinebus/kinebus_api.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/kinebus/message_json.hpp"
#include "gateway/sessions/http/routes.hpp"

namespace kinebus::http {
namespace {

using google::protobuf::FieldDescriptor;
using joblink::ClientMessage;

const FieldDescriptor* request_named(const std::string& name) {
  for (const FieldDescriptor* request : plain_requests())
    if (request->name() == name) return request;
  return nullptr;
}

/// "after_id=5&alarms_only=true" as an object: protobuf's reader takes numbers as texts, but no booleans.
std::optional<std::string> query_json(const std::string& query) {
  const auto fields = query_fields(query);
  if (!fields) return std::nullopt;
  Json object = Json::object();
  for (const auto& [name, value] : *fields)
    object[name] = value == "true" || value == "false" ? Json(value == "true") : Json(value);
  return text_of(object);
}

void carry_out(Session& session, const std::string& json) {
  const FieldDescriptor* request = request_named(session.target().path.back());
  if (request == nullptr)
    return session.refuse(404,
                          "no request has this name: GET /kinebus/v1/openapi.json tells which there are");
  if (session.head().method == "GET" && !only_asks(*request))
    return session.refuse(405, "this request changes something: POST it");
  ClientMessage message;
  const auto read = from_json(json, *message.GetReflection()->MutableMessage(&message, request));
  if (!read) return session.refuse(400, read.error());
  // Written once for all who ask; all who are let in may.
  if (message.has_get_status()) return session.answer({.body = session.server().status_json()});
  session.ask(message, [&session](const joblink::Reply& reply) {
    if (reply.has_error()) return session.refuse(reply.error());
    const auto& type = *joblink::Reply::descriptor()->FindOneofByName("result");
    const FieldDescriptor* result = reply.GetReflection()->GetOneofFieldDescriptor(reply, &type);
    if (result == nullptr) return session.answer(no_content());
    session.answer({.body = to_json(reply.GetReflection()->GetMessage(reply, result))});
  });
}

void get(Session& session, std::string_view) {
  const auto json = query_json(session.target().query);
  if (!json) return session.refuse(400, "the query is not name=value&name=value");
  carry_out(session, *json);
}

void post(Session& session, std::string_view body) {
  if (body.empty()) return carry_out(session, "{}");
  if (json_body(session, body)) carry_out(session, std::string(body));
}

void description(Session& session, std::string_view) {
  session.answer({.body = openapi(session.server().link().options().version)});
}

}  // namespace

std::vector<const FieldDescriptor*> plain_requests() {
  static constexpr std::array kOfSessions{
      ClientMessage::kHello, ClientMessage::kPing, ClientMessage::kWatch, ClientMessage::kUploadBegin,
      ClientMessage::kUploadChunk, ClientMessage::kUploadCommit, ClientMessage::kUploadAbort,
      ClientMessage::kTakeControl, ClientMessage::kReleaseControl, ClientMessage::kHandOver,
      // Its bytes belong into JSON no more than an upload's: GET
      // /downloads/files/local/NAME
      ClientMessage::kReadJob};
  const auto& all = *ClientMessage::descriptor()->FindOneofByName("request");
  std::vector<const FieldDescriptor*> requests;
  for (int i = 0; i < all.field_count(); ++i)
    if (std::none_of(kOfSessions.begin(), kOfSessions.end(),
                     [&](auto c) { return static_cast<int>(c) == all.field(i)->number(); }))
      requests.push_back(all.field(i));
  return requests;
}

bool only_asks(const FieldDescriptor& request) {
  const std::string& name = request.name();
  return name.starts_with("get_") || name.starts_with("list_") || name.starts_with("read_");
}

std::span<const Route> kinebus_routes() {
  static constexpr std::array kRoutes{
      Route{.method = "GET",
            .path = "kinebus/v1/socket",
            .carry_out = nullptr,
            .speak = kinebus_dialect,
            .open = true},
      Route{"GET", "kinebus/v1/openapi.json", description},
      Route{"GET", "kinebus/v1/*", get},
      Route{"POST", "kinebus/v1/*", post},
  };
  return kRoutes;
}

}  // namespace kinebus::http
