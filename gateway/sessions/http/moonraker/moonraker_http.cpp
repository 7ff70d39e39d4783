// Moonraker's methods under their paths by HTTP, and its way of files.

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

std::string path_of(const Target& target) {
  std::string path;
  for (const std::string& piece : target.path) path += (path.empty() ? "" : "/") + piece;
  return path;
}

/// Names a websocket, where a query otherwise names objects.
constexpr const char* kConnection = "connection_id";
/// Clients send scripts by GET, too.
constexpr std::string_view kScript = "printer/gcode/script";

/// "toolhead&gcode_move=speed_factor,position" names objects; everywhere else a query names parameters.
Json objects_of(const std::vector<std::pair<std::string, std::string>>& fields) {
  Json objects = Json::object();
  for (const auto& [name, list] : fields) {
    if (name == kConnection) continue;
    if (list.empty()) {
      objects[name] = nullptr;
      continue;
    }
    for (std::size_t at = 0; at <= list.size();) {
      const std::size_t end = std::min(list.find(',', at), list.size());
      objects[name].push_back(list.substr(at, end - at));
      at = end + 1;
    }
  }
  return objects;
}

void answer_error(Session& session, int code, const std::string& words) {
  const int status = code >= 400 && code < 600 ? code : 400;
  session.answer(json_answer({{"error", {{"code", code}, {"message", words}}}}, status));
}

void carry_out_method(Session& session, std::string_view body) {
  const std::string path = path_of(session.target());
  const std::string& verb = session.head().method == "HEAD" ? "GET" : session.head().method;
  const auto fields = query_fields(session.target().query);
  if (!fields) return answer_error(session, 400, "the query is not name=value&name=value");
  Json params = Json::object();
  if (!body.empty()) {
    auto given = json_body(session, body);
    if (!given) return;
    params = std::move(*given);
  }
  const bool names_objects = path == "printer/objects/query" || path == "printer/objects/subscribe";
  for (const auto& [name, value] : *fields)
    if (!names_objects || name == kConnection) params[name] = value;
  if (names_objects && !params.contains("objects")) params["objects"] = objects_of(*fields);
  static const std::vector<Method> methods = moonraker_methods();
  for (const Method& method : methods) {
    if (method.path == nullptr || method.path != path || (method.verb != verb && path != kScript)) continue;
    return method.carry_out(
        {.caller = session, .params = std::move(params), .then = [&session](Result<Json, RpcError> result) {
           if (!result) return answer_error(session, result.error().code, result.error().message);
           session.answer(json_answer({{"result", std::move(*result)}}));
         }});
  }
}

std::unique_ptr<Task> download_gcode(Session& session) {
  return download(session, session.target().path.back());
}
void remove_gcode(Session& session, std::string_view) {
  delete_job(session, session.target().path.back());
}

}  // namespace

std::span<const Route> moonraker_routes() {
  static const std::vector<Route> routes = [] {
    std::vector<Route> all{
        {.method = "GET",
         .path = "websocket",
         .carry_out = nullptr,
         .speak = moonraker_dialect,
         .open = true},
        {.method = "POST", .path = "server/files/upload", .carry_out = nullptr, .make = moonraker_upload},
        {.method = "GET", .path = "server/files/gcodes/*", .carry_out = nullptr, .make = download_gcode},
        {.method = "GET", .path = "server/files/gcodes/.thumbs/*", .carry_out = send_gcode_picture},
        {.method = "DELETE", .path = "server/files/gcodes/*", .carry_out = remove_gcode}};
    for (const Method& method : moonraker_methods())
      if (method.path != nullptr)
        all.push_back({.method = method.verb, .path = method.path, .carry_out = carry_out_method});
    all.push_back({.method = "GET", .path = kScript.data(), .carry_out = carry_out_method, .commands = true});
    return all;
  }();
  return routes;
}

}  // namespace kinebus::http
