// Moonraker's API: the server, the computer, what clients keep with it.

#include <array>
#include <thread>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

/// The version of Moonraker whose API this is, as far as it goes: clients compare it.
constexpr const char* kMoonrakerApi = "v0.9.3-0-kinebus";

void identify_client(const Call& call) {
  if (call.socket == nullptr) return call.fail(400, "only a websocket identifies itself");
  if (!identify(*call.socket, call.text("client_name"), call.text("api_key")))
    return call.fail(401, "Unauthorized");
  call.done({{"connection_id", call.caller.id()}});
}

void websocket_id(const Call& call) {
  call.done({{"websocket_id", call.caller.id()}});
}

void server_info(const Call& call) {
  call.done({{"klippy_connected", true},
             {"klippy_state", klippy_state(machine_status(call.caller))},
             // Clients ask for what is named here, and for nothing else.
             {"components",
              {"klippy_connection", "database", "file_manager", "data_store", "history", "announcements",
               "webcam"}},
             {"failed_components", Json::array()},
             {"registered_directories", {"gcodes"}},
             {"warnings", Json::array()},
             {"websocket_count", call.caller.server().sessions()},
             {"moonraker_version", kMoonrakerApi},
             {"missing_klippy_requirements", Json::array()},
             {"api_version", {1, 5, 0}},
             {"api_version_string", "1.5.0"}});
}

void server_config(const Call& call) {
  call.done({{"config", {{"server", Json::object()}, {"machine", {{"provider", "none"}}}}},
             {"orig", Json::object()},
             {"files", Json::array()}});
}

void access_info(const Call& call) {
  call.done({{"default_source", "moonraker"},
             {"available_sources", Json::array()},
             {"login_required", false},
             {"trusted", call.caller.role() != Role::kNobody}});
}

void system_info(const Call& call) {
  call.done({{"system_info",
              {{"provider", "none"},
               {"cpu_info", {{"cpu_count", std::thread::hardware_concurrency()}}},
               {"distribution", Json::object()},
               {"virtualization", Json::object()},
               {"network", Json::object()},
               {"canbus", Json::object()},
               {"available_services", Json::array()},
               {"service_state", Json::object()}}}});
}

void proc_stats(const Call& call) {
  call.done({{"moonraker_stats", Json::array()},
             {"throttled_state", nullptr},
             {"cpu_temp", nullptr},
             {"network", Json::object()},
             {"system_cpu_usage", Json::object()},
             {"websocket_connections", call.caller.server().sessions()}});
}

void database_list(const Call& call) {
  call.done({{"namespaces", call.caller.server().database().namespaces()}, {"backups", Json::array()}});
}

void answer_item(const Call& call, Result<Json, std::string> value) {
  if (!value) return call.fail(404, value.error());
  call.done({{"namespace", call.text("namespace")},
             {"key", call.text("key").empty() ? Json(nullptr) : Json(call.text("key"))},
             {"value", std::move(*value)}});
}
void database_get(const Call& call) {
  answer_item(call, call.caller.server().database().get(call.text("namespace"), call.text("key")));
}
void database_post(const Call& call) {
  if (!call.may_operate()) return;
  const auto given = call.params.find("value");
  if (given == call.params.end()) return call.fail(400, "the parameter 'value' is missing");
  const auto set = call.caller.server().database().set(call.text("namespace"), call.text("key"), *given);
  if (!set) return call.fail(400, set.error());
  keep_database(call.caller);
  answer_item(call, Json(*given));
}
void database_delete(const Call& call) {
  if (!call.may_operate()) return;
  auto removed = call.caller.server().database().remove(call.text("namespace"), call.text("key"));
  if (removed) keep_database(call.caller);
  answer_item(call, std::move(removed));
}

}  // namespace

void keep_database(Caller& caller) {
  const auto& keep = caller.server().options().keep_database;
  if (!keep) return;
  caller.server().worker().post([keep, text = caller.server().database().text()] { keep(text); }, [] {});
}

std::span<const Method> moonraker_server_methods() {
  static constexpr std::array kMethods{
      Method{"server.connection.identify", nullptr, nullptr, identify_client, true},
      Method{"server.websocket.id", nullptr, nullptr, websocket_id},
      Method{"server.info", "GET", "server/info", server_info},
      Method{"server.config", "GET", "server/config", server_config},
      Method{"access.info", "GET", "access/info", access_info},
      Method{"machine.system_info", "GET", "machine/system_info", system_info},
      Method{"machine.proc_stats", "GET", "machine/proc_stats", proc_stats},
      Method{"server.database.list", "GET", "server/database/list", database_list},
      Method{"server.database.get_item", "GET", "server/database/item", database_get},
      Method{"server.database.post_item", "POST", "server/database/item", database_post},
      Method{"server.database.delete_item", "DELETE", "server/database/item", database_delete},
  };
  return kMethods;
}

}  // namespace kinebus::http
