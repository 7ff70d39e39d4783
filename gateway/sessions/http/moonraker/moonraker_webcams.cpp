// Moonraker's API: cameras, those of the machine file and those that pages enter and keep with the printer.
// The gateway has no part in their pictures.

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "gateway/description/camera_address.hpp"
#include "gateway/sessions/http/moonraker/moonraker.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kSpace = "webcams";
constexpr std::size_t kUidDigits = 32;

/// A camera with all its fields, each as it would be if nobody said so.
Json usual_webcam() {
  return {{"name", ""},
          {"location", "printer"},
          {"service", "mjpegstreamer"},
          {"enabled", true},
          {"icon", "mdiWebcam"},
          {"target_fps", 15},
          {"target_fps_idle", 5},
          {"stream_url", ""},
          {"snapshot_url", ""},
          {"flip_horizontal", false},
          {"flip_vertical", false},
          {"rotation", 0},
          {"aspect_ratio", "4:3"},
          {"extra_data", Json::object()},
          {"source", "database"},
          {"uid", ""}};
}

Json kept_webcams(const Call& call) {
  auto kept = call.caller.server().database().get(kSpace, {});
  return kept && kept->is_object() ? std::move(*kept) : Json::object();
}

std::string uid_by_name(const std::string& name) {
  return joblink::to_hex(joblink::sha256_of("webcam " + name)).substr(0, kUidDigits);
}

/// By uid. The machine file's cannot be changed here, and take the place of others of their names.
Json all_webcams(const Call& call) {
  Server& server = call.caller.server();
  const std::vector<std::string>& names = server.options().names;
  const std::string host = names.empty() ? "localhost" : names.back();
  Json all = kept_webcams(call);
  for (const joblink::Camera& camera : server.link().machine().cameras()) {
    const std::string uid = uid_by_name(camera.name());
    Json webcam = usual_webcam();
    webcam.update({{"name", camera.name()},
                   {"stream_url", camera_address_from(camera.stream(), host)},
                   {"snapshot_url", camera_address_from(camera.snapshot(), host)},
                   {"source", "config"},
                   {"uid", uid}});
    all[uid] = std::move(webcam);
  }
  return all;
}
bool is_of_machine_file(const Json& webcam) {
  return word_in(webcam, "source") == "config";
}

/// Of the webcam that is meant, by "uid" or by "name"; "": none is.
std::string uid_of(const Call& call) {
  const std::string uid = call.text("uid"), name = call.text("name");
  const Json all = all_webcams(call);
  for (const auto& [known, webcam] : all.items())
    if (uid.empty() ? word_in(webcam, "name") == name : known == uid) return known;
  return {};
}

void list(const Call& call) {
  Json webcams = Json::array();
  const Json all = all_webcams(call);
  for (const auto& [uid, webcam] : all.items()) webcams.push_back(webcam);
  call.done({{"webcams", std::move(webcams)}});
}

void no_such_webcam(const Call& call) {
  call.fail(404, "there is no webcam of this uid or name");
}

void of_machine_file(const Call& call) {
  call.fail(400, "this webcam is the machine file's: change its [camera] there");
}

void get(const Call& call) {
  const std::string uid = uid_of(call);
  if (uid.empty()) return no_such_webcam(call);
  call.done({{"webcam", all_webcams(call)[uid]}});
}

void post(const Call& call) {
  if (!call.may_operate()) return;
  const std::string name = call.text("name");
  std::string uid = uid_of(call);
  if (uid.empty() && !call.text("uid").empty()) return no_such_webcam(call);
  if (uid.empty() && name.empty()) return call.fail(400, "the parameter 'name' is missing");
  if (uid.empty()) uid = uid_by_name(name);
  if (const Json all = all_webcams(call); all.contains(uid) && is_of_machine_file(all[uid]))
    return of_machine_file(call);
  Json webcam = usual_webcam();
  webcam.update(kept_webcams(call).value(uid, Json::object()));
  for (auto& [field, value] : webcam.items()) {
    const auto given = call.params.find(field);
    if (given == call.params.end() || field == "source" || field == "uid") continue;
    const bool fits =
        given->type() == value.type() || (given->is_number_integer() && value.is_number_integer());
    if (!fits) return call.fail(400, "the parameter '" + field + "' is of another kind: " + text_of(value));
    value = *given;
  }
  webcam["uid"] = uid;
  auto& server = call.caller.server();
  if (const auto set = server.database().set(kSpace, uid, webcam); !set) return call.fail(400, set.error());
  keep_database(call.caller);
  ++server.webcams_revision;
  call.done({{"webcam", std::move(webcam)}});
}

void remove(const Call& call) {
  if (!call.may_operate()) return;
  const std::string uid = uid_of(call);
  if (uid.empty()) return no_such_webcam(call);
  if (is_of_machine_file(all_webcams(call)[uid])) return of_machine_file(call);
  auto& server = call.caller.server();
  auto removed = server.database().remove(kSpace, uid);
  if (!removed) return no_such_webcam(call);
  keep_database(call.caller);
  ++server.webcams_revision;
  call.done({{"webcam", std::move(*removed)}});
}

}  // namespace

std::span<const Method> moonraker_webcam_methods() {
  static constexpr std::array kMethods{
      Method{"server.webcams.list", "GET", "server/webcams/list", list},
      Method{"server.webcams.get_item", "GET", "server/webcams/item", get},
      Method{"server.webcams.post_item", "POST", "server/webcams/item", post},
      Method{"server.webcams.delete_item", "DELETE", "server/webcams/item", remove},
  };
  return kMethods;
}

}  // namespace kinebus::http
