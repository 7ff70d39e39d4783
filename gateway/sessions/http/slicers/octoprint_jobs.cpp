// OctoPrint's REST API: files and the job.

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/pictures.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

constexpr std::string_view kEnding = ".gcode";

/// As the plug-in of slicers' pictures has it; the date makes clients read it anew.
std::string plugin_path(const StoredJob& job) {
  const std::string_view name = job.name;
  const std::string_view front = name.substr(0, name.size() - (name.ends_with(kEnding) ? kEnding.size() : 0));
  return "plugin/prusaslicerthumbnails/thumbnail/" + percent_encoded(front) + ".png?" +
         std::to_string(static_cast<std::int64_t>(job.stored_unix_s));
}

Json file_json(const StoredJob& job) {
  Json file = {{"name", job.name},
               {"display", job.name},
               {"path", job.name},
               {"origin", "local"},
               {"type", "machinecode"},
               {"typePath", {"machinecode", "gcode"}},
               {"size", job.size_bytes},
               {"date", static_cast<std::int64_t>(job.stored_unix_s)},
               {"refs",
                {{"resource", "/api/files/local/" + percent_encoded(job.name)},
                 {"download", download_path(job.name)}}}};
  if (estimate_s(job) > 0) file["gcodeAnalysis"]["estimatedPrintTime"] = estimate_s(job);
  if (job.notes.filament_mm() > 0)
    file["gcodeAnalysis"]["filament"]["tool0"]["length"] = job.notes.filament_mm();
  if (job.notes.pictures_size() > 0) {
    file["thumbnail"] = plugin_path(job);
    file["thumbnail_src"] = "prusaslicerthumbnails";
  }
  if (job.last_run) {
    const bool success = job.last_run->result == RunResult::kComplete;
    file["prints"] = {{"last",
                       {{"date", job.last_run->begun_unix_s},
                        {"printTime", job.last_run->duration_s},
                        {"success", success}}}};
  }
  return file;
}

void files(Session& session, std::string_view) {
  if (session.of_prusalink()) return prusalink_files(session);
  session.beside(
      [](JobStore& store) {
        const auto listing = all_jobs(store);
        if (!listing) return Result<std::string, StoreError>(Error<StoreError>(listing.error()));
        Json list = Json::array();
        for (const StoredJob& job : listing->jobs) list.push_back(file_json(job));
        const std::uint64_t quota = listing->quota_bytes;
        const std::uint64_t free =
            std::min(listing->free_bytes, quota - std::min(quota, listing->used_bytes));
        return Result<std::string, StoreError>(
            text_of({{"files", std::move(list)}, {"free", free}, {"total", quota}}));
      },
      [&session](Result<std::string, StoreError> text) {
        if (!text) return session.refuse(500, text.error().words);
        session.answer({.body = std::move(*text)});
      });
}

const std::string& file_name(Session& session) {
  return session.target().path.back();
}

void file(Session& session, std::string_view) {
  with_job(session, file_name(session),
           [&session](const StoredJob& job) { session.answer(json_answer(file_json(job))); });
}

void plugin_picture(Session& session, std::string_view) {
  static constexpr std::string_view kPng = ".png";
  std::string front = file_name(session);
  if (front.ends_with(kPng)) front.resize(front.size() - kPng.size());
  send_picture(session, {front + std::string(kEnding), front}, great_picture);
}

void remove(Session& session, std::string_view) {
  delete_job(session, file_name(session));
}

void file_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  if (word_in(*asked, "command") != "select")
    return session.refuse(400, "the commands of a file are: select");
  if (!may_operate(session)) return;
  const auto print = asked->find("print");
  const bool prints = print != asked->end() && print->is_boolean() && print->get<bool>();
  with_job(session, file_name(session), [&session, prints](const StoredJob& job) {
    session.server().selected = job.name;
    if (!prints) return session.answer(no_content());
    start_job(session, job.name, [&session] { session.answer(no_content()); });
  });
}

void tell_job(Session& session, const joblink::Status& status, const StoredJob* job) {
  Json told = octoprint_job_json(status, session.server().selected, job);
  session.answer(json_answer(session.of_prusalink() ? prusalink_job_json(std::move(told)) : told));
}

void job(Session& session, std::string_view) {
  joblink::Status status = machine_status(session);
  const std::string name = octoprint_job_name(status, session.server().selected);
  if (name.empty()) return tell_job(session, status, nullptr);
  session.beside([name](JobStore& store) { return store.find(name); },
                 [&session, status = std::move(status)](const std::optional<StoredJob>& found) {
                   tell_job(session, status, found ? &*found : nullptr);
                 });
}

void job_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  const std::string what = word_in(*asked, "command");
  const std::string action = word_in(*asked, "action");
  if (what == "cancel") return cancel(session);
  if (what == "pause") {
    if (action == "pause") return pause(session, Pausing::kPause);
    if (action == "resume") return pause(session, Pausing::kResume);
    if (action.empty() || action == "toggle") return pause(session, Pausing::kToggle);
    return session.refuse(400, "the actions of pause are: pause, resume, toggle");
  }
  if (what != "start") return session.refuse(400, "the commands of a job are: start, pause, cancel");
  if (session.server().selected.empty()) return session.refuse(409, "no file is selected");
  start_job(session, session.server().selected, [&session] { session.answer(no_content()); });
}

std::unique_ptr<Task> download_file(Session& session) {
  return download(session, session.target().path.back());
}

}  // namespace

std::span<const Route> octoprint_job_routes() {
  static constexpr std::array kRoutes{
      Route{"GET", "api/job", job},
      Route{"POST", "api/job", job_command},
      Route{"GET", "api/files", files},
      Route{"GET", "api/files/local", files},
      Route{"POST", "api/files/local", nullptr, octoprint_upload},
      Route{"GET", "api/files/local/*", file},
      Route{"POST", "api/files/local/*", file_command},
      Route{"DELETE", "api/files/local/*", remove},
      Route{"GET", "plugin/prusaslicerthumbnails/thumbnail/*", plugin_picture},
      Route{"GET", "downloads/files/local/*", nullptr, download_file},
  };
  return kRoutes;
}

}  // namespace kinebus::http
