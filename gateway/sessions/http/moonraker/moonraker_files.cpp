// Moonraker's API: files.

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kRoot = "gcodes";

/// "gcodes/a.gcode": "a.gcode". What is in no other folder.
std::string name_of(const std::string& path) {
  const std::string_view root = "gcodes/";
  return path.starts_with(root) ? path.substr(root.size()) : path;
}

Json file_json(const StoredJob& job, const char* name) {
  Json file = {
      {name, job.name}, {"modified", job.stored_unix_s}, {"size", job.size_bytes}, {"permissions", "rw"}};
  if (job.preflight) file["estimated_time"] = job.preflight->motion_s + job.preflight->dwell_s;
  if (job.last_run) {
    file["print_start_time"] = job.last_run->begun_unix_s;
    file["job_id"] = std::to_string(job.last_run->id);
  }
  return file;
}

/// All stored jobs, made into the result by `make`.
void with_jobs(const Call& call, Json (*make)(const JobListing&)) {
  call.caller.beside(
      [make](JobStore& store) {
        const auto listing = all_jobs(store);
        if (!listing)
          return Result<Json, RpcError>(Error<RpcError>(RpcError{500, listing.error().words.english()}));
        return Result<Json, RpcError>(make(*listing));
      },
      [call](Result<Json, RpcError> made) { call.then(std::move(made)); });
}

void list_files(const Call& call) {
  const std::string root = call.text("root");
  if (!root.empty() && root != kRoot) return call.done(Json::array());
  with_jobs(call, [](const JobListing& listing) {
    Json files = Json::array();
    for (const StoredJob& job : listing.jobs) files.push_back(file_json(job, "path"));
    return files;
  });
}

void directory(const Call& call) {
  const std::string path = call.text("path");
  if (!path.empty() && path != kRoot) return call.fail(404, "there is one folder: gcodes");
  with_jobs(call, [](const JobListing& listing) {
    Json files = Json::array();
    for (const StoredJob& job : listing.jobs) files.push_back(file_json(job, "filename"));
    const std::uint64_t quota = listing.quota_bytes;
    return Json{{"dirs", Json::array()},
                {"files", std::move(files)},
                {"disk_usage",
                 {{"total", quota},
                  {"used", listing.used_bytes},
                  {"free", std::min(listing.free_bytes, quota - std::min(quota, listing.used_bytes))}}},
                {"root_info", {{"name", kRoot}, {"permissions", "rw"}}}};
  });
}

void roots(const Call& call) {
  call.done(Json::array({{{"name", kRoot}, {"path", kRoot}, {"permissions", "rw"}}}));
}

void metadata(const Call& call) {
  call.caller.beside([name = name_of(call.text("filename"))](JobStore& store) { return store.find(name); },
                     [call](const std::optional<StoredJob>& job) {
                       if (!job) return call.fail(404, "no stored job has this name");
                       call.done(file_json(*job, "filename"));
                     });
}

void delete_file(const Call& call) {
  const std::string name = name_of(call.text("path"));
  joblink::ClientMessage message;
  message.mutable_delete_job()->set_name(name);
  call.caller.command(message, [call, name](const joblink::Reply& reply) {
    if (reply.has_error()) return call.fail(400, words_of(reply.error()));
    call.done({{"item", {{"path", name}, {"root", kRoot}}}, {"action", "delete_file"}});
  });
}

}  // namespace

std::span<const Method> moonraker_file_methods() {
  static constexpr std::array kMethods{
      Method{"server.files.list", "GET", "server/files/list", list_files},
      Method{"server.files.get_directory", "GET", "server/files/directory", directory},
      Method{"server.files.roots", "GET", "server/files/roots", roots},
      Method{"server.files.metadata", "GET", "server/files/metadata", metadata},
      // What is known of a job is read when it is stored.
      Method{"server.files.metascan", "POST", "server/files/metascan", metadata},
      Method{"server.files.delete_file", nullptr, nullptr, delete_file},
  };
  return kMethods;
}

}  // namespace kinebus::http
