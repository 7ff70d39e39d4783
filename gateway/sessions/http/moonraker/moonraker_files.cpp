// Moonraker's API: files, the history of jobs, and the queue that Kinebus does not have.

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

const char* result_word(RunResult result) {
  switch (result) {
    case RunResult::kRunning:
      return "in_progress";
    case RunResult::kComplete:
      return "completed";
    case RunResult::kCancelled:
      return "cancelled";
    case RunResult::kInterrupted:
      return "interrupted";
    case RunResult::kRefused:
    case RunResult::kFailed:
      return "error";
  }
  return "error";
}

Json run_json(const StoredRun& run) {
  const bool runs = run.result == RunResult::kRunning;
  return {{"job_id", std::to_string(run.id)},
          {"exists", true},
          {"filename", run.name},
          {"start_time", run.begun_unix_s},
          {"end_time", runs ? Json(nullptr) : Json(run.begun_unix_s + run.duration_s)},
          {"total_duration", run.duration_s},
          {"print_duration", run.duration_s},
          {"status", result_word(run.result)},
          {"metadata", Json::object()},
          {"auxiliary_data", Json::array()},
          {"user", nullptr}};
}

void with_runs(const Call& call, std::function<Json(const std::vector<StoredRun>&)> make) {
  static constexpr std::size_t kMost = 2000;
  call.caller.beside(
      [make = std::move(make)](JobStore& store) {
        const auto runs = store.history(0, kMost);
        if (!runs)
          return Result<Json, RpcError>(Error<RpcError>(RpcError{500, runs.error().words.english()}));
        return Result<Json, RpcError>(make(*runs));
      },
      [call](Result<Json, RpcError> made) { call.then(std::move(made)); });
}

void list_history(const Call& call) {
  const double limit = call.number("limit", 50), start = call.number("start", 0);
  const double since = call.number("since", 0), before = call.number("before", 1e18);
  const bool ascending = call.text("order") == "asc";
  with_runs(call, [=](std::vector<StoredRun> runs) {
    if (ascending) std::reverse(runs.begin(), runs.end());
    Json jobs = Json::array();
    double count = 0;
    for (const StoredRun& run : runs) {
      if (run.begun_unix_s <= since || run.begun_unix_s >= before) continue;
      if (count >= start && static_cast<double>(jobs.size()) < limit) jobs.push_back(run_json(run));
      ++count;
    }
    return Json{{"count", static_cast<std::uint64_t>(count)}, {"jobs", std::move(jobs)}};
  });
}

void totals(const Call& call) {
  with_runs(call, [](const std::vector<StoredRun>& runs) {
    double time = 0, longest = 0;
    for (const StoredRun& run : runs) {
      time += run.duration_s;
      longest = std::max(longest, run.duration_s);
    }
    return Json{{"job_totals",
                 {{"total_jobs", runs.size()},
                  {"total_time", time},
                  {"total_print_time", time},
                  {"longest_job", longest},
                  {"longest_print", longest}}},
                {"auxiliary_totals", Json::array()}};
  });
}

void job_queue(const Call& call) {
  call.done({{"queued_jobs", Json::array()}, {"queue_state", "paused"}});
}
void no_queue(const Call& call) {
  call.fail(501, "Kinebus has no queue of its own: start stored jobs one by one");
}

}  // namespace

std::span<const Method> moonraker_file_methods() {
  static constexpr std::array kMethods{
      Method{"server.files.list", "GET", "server/files/list", list_files},
      Method{"server.files.get_directory", "GET", "server/files/directory", directory},
      Method{"server.files.roots", "GET", "server/files/roots", roots},
      Method{"server.files.metadata", "GET", "server/files/metadata", metadata},
      Method{"server.files.delete_file", nullptr, nullptr, delete_file},
      Method{"server.history.list", "GET", "server/history/list", list_history},
      Method{"server.history.totals", "GET", "server/history/totals", totals},
      Method{"server.job_queue.status", "GET", "server/job_queue/status", job_queue},
      Method{"server.job_queue.post_job", "POST", "server/job_queue/job", no_queue},
      Method{"server.job_queue.start", "POST", "server/job_queue/start", no_queue},
  };
  return kMethods;
}

}  // namespace kinebus::http
