// OctoPrint's REST API: the server, the printer and its state.

#include <algorithm>
#include <array>

#include "gateway/description/camera_address.hpp"
#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

void version(Session& session, std::string_view) {
  const auto& options = session.server().link().options();
  session.answer(
      json_answer({{"api", "0.1"},
                   {"server", kOctoPrintApi},
                   {"text", "OctoPrint " + std::string(kOctoPrintApi) + " (Kinebus " + options.version + ")"},
                   {"capabilities", {{"upload-by-put", true}}}}));
}

void server(Session& session, std::string_view) {
  session.answer(json_answer({{"version", kOctoPrintApi}, {"safemode", nullptr}}));
}

Json user_json(const Visitor& visitor) {
  Json groups = Json::array({"users"}), permissions = Json::array({"STATUS", "FILES_LIST", "FILES_DOWNLOAD"});
  if (visitor.role >= Role::kOperate)
    for (const char* more : {"CONNECTION", "FILES_UPLOAD", "FILES_DELETE", "FILES_SELECT", "PRINT"})
      permissions.push_back(more);
  const bool administers = visitor.role >= Role::kAdminister;
  if (administers) groups.push_back("admins");
  return {{"name", octoprint_user(visitor)},
          {"active", true},
          {"user", true},
          {"admin", administers},
          {"apikey", nullptr},
          {"groups", std::move(groups)},
          {"permissions", std::move(permissions)}};
}

/// Whoever asks has shown the key: nobody logs in by a name.
void login(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  if (!asked->value("passive", Json(false)).is_boolean() || !asked->value("passive", Json(false)).get<bool>())
    return session.refuse(403, "there are no names and passwords: clients are let in by X-Api-Key");
  Json answer = user_json(session.visitor());
  // For a websocket, which shows it in its first message (octoprint_push.cpp); requests show the key.
  answer["session"] = session.server().logins().begin(session.now(), session.visitor(), session.address());
  answer["_is_external_client"] = false;
  session.answer(json_answer(answer));
}

void current_user(Session& session, std::string_view) {
  session.answer(json_answer(user_json(session.visitor())));
}

/// The first camera of the machine file, for whoever calls this computer as `host` says; its pictures are
/// shown as they come.
Json webcam_json(const joblink::MachineInfo& machine, std::string_view host) {
  std::string stream, snapshot;
  if (machine.cameras_size() > 0) {
    const joblink::Camera& camera = machine.cameras(0);
    stream = camera_address_from(camera.stream(), host);
    if (!camera.snapshot().empty()) snapshot = camera_address_from(camera.snapshot(), host);
  }
  return {{"webcamEnabled", !stream.empty()},
          {"streamUrl", stream},
          {"snapshotUrl", snapshot},
          {"flipH", false},
          {"flipV", false},
          {"rotate90", false}};
}

void settings(Session& session, std::string_view) {
  session.answer(json_answer({{"api", {{"allowCrossOrigin", false}}},
                              {"appearance", {{"name", machine_info(session).name()}, {"color", "default"}}},
                              {"feature", {{"sdSupport", false}, {"temperatureGraph", true}}},
                              {"webcam", webcam_json(machine_info(session), session.head().field("Host"))},
                              {"plugins", Json::object()}}));
}

void connection(Session& session, std::string_view) {
  const joblink::Status status = machine_status(session);
  session.answer(
      json_answer({{"current",
                    {{"state", octoprint_state(status)},
                     {"port", "kinebus"},
                     {"baudrate", nullptr},
                     {"printerProfile", "_default"}}},
                   {"options",
                    {{"ports", {"kinebus"}},
                     {"baudrates", Json::array()},
                     {"printerProfiles", {{{"id", "_default"}, {"name", machine_info(session).name()}}}},
                     {"portPreference", "kinebus"},
                     {"printerProfilePreference", "_default"}}}}));
}

void printer(Session& session, std::string_view) {
  const joblink::Status status = machine_status(session);
  Json temperature = octoprint_temperatures(status);
  for (auto& heater : temperature) heater["offset"] = 0;
  session.answer(json_answer(
      {{"temperature", temperature}, {"sd", {{"ready", false}}}, {"state", octoprint_state_json(status)}}));
}

Json range(const joblink::Range& range) {
  return range.max() - range.min();
}

void printer_profiles(Session& session, std::string_view) {
  const joblink::MachineInfo info = machine_info(session);
  int hotends = 0;
  bool bed = false, chamber = false;
  for (const joblink::HeaterInfo& heater : info.heaters()) {
    hotends += heater.kind() == joblink::HEATER_HOTEND ? 1 : 0;
    bed = bed || heater.kind() == joblink::HEATER_BED;
    chamber = chamber || heater.kind() == joblink::HEATER_CHAMBER;
  }
  const joblink::Reach& reach = info.reach();
  const bool round = reach.radius_mm() > 0;
  Json offsets = Json::array();
  for (int i = 0; i < std::max(hotends, 1); ++i) offsets.push_back({0.0, 0.0});
  Json profile = {
      {"id", "_default"},
      {"name", info.name()},
      {"model", "Kinebus " + info.kinematics()},
      {"default", true},
      {"current", true},
      {"resource", "/api/printerprofiles/_default"},
      {"volume",
       {{"formFactor", round ? "circular" : "rectangular"},
        {"origin", reach.x_mm().min() < 0 ? "center" : "lowerleft"},
        {"width", round ? Json(2 * reach.radius_mm()) : range(reach.x_mm())},
        {"depth", round ? Json(2 * reach.radius_mm()) : range(reach.y_mm())},
        {"height", range(reach.z_mm())}}},
      {"heatedBed", bed},
      {"heatedChamber", chamber},
      {"extruder", {{"count", std::max(hotends, 1)}, {"offsets", offsets}, {"sharedNozzle", false}}}};
  session.answer(json_answer({{"profiles", {{"_default", profile}}}}));
}

}  // namespace

std::span<const Route> octoprint_machine_routes() {
  static constexpr std::array kRoutes{
      Route{"GET", "api/version", version},   Route{"GET", "api/server", server},
      Route{"POST", "api/login", login},      Route{"GET", "api/currentuser", current_user},
      Route{"GET", "api/settings", settings}, Route{"GET", "api/connection", connection},
      Route{"GET", "api/printer", printer},   Route{"GET", "api/printerprofiles", printer_profiles},
  };
  return kRoutes;
}

}  // namespace kinebus::http
