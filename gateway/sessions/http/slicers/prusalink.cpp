// PrusaLink's API (github.com/prusa3d/Prusa-Link-Web, spec/openapi.yaml), version 1: what PrusaSlicer, its
// relatives and managers of printers send.

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/job_stream.hpp"
#include "gateway/sessions/http/pictures.hpp"
#include "gateway/sessions/http/routes.hpp"

namespace kinebus::http {
namespace {

constexpr const char* kStorage = "local";

/// There is one storage. "usb" is what printers call theirs, and some clients write it without asking.
bool known_storage(std::string_view name) {
  return name == kStorage || name == "usb";
}

const char* printer_state(const joblink::Status& status) {
  if (is_paused(status)) return "PAUSED";
  switch (status.state()) {
    case joblink::STATE_READY:
      return "IDLE";
    case joblink::STATE_CHECKING:
    case joblink::STATE_RUNNING:
    case joblink::STATE_HOLDING:
      return "PRINTING";
    case joblink::STATE_STOPPING:
    case joblink::STATE_STOPPED:
    case joblink::STATE_ALARM:
      return "ERROR";
    // Somebody has to bring it up, or to home it.
    case joblink::STATE_OFF:
    case joblink::STATE_UNHOMED:
      return "ATTENTION";
    default:
      return "BUSY";
  }
}

Json job_json(Session& session, const joblink::Status& status) {
  return {{"id", session.server().job_id()},
          {"progress", 100 * status.progress()},
          {"time_remaining", static_cast<std::int64_t>(status.remaining_s())},
          {"time_printing", static_cast<std::int64_t>(status.elapsed_s())}};
}

void storage(Session& session, std::string_view) {
  session.beside([](JobStore& store) { return std::pair(store.list({}, 1), store.writable()); },
                 [&session](const std::pair<Result<JobListing, StoreError>, bool>& found) {
                   const auto& [listing, writable] = found;
                   if (!listing) return session.refuse(500, listing.error().words);
                   const std::uint64_t quota = listing->quota_bytes;
                   const std::uint64_t room =
                       std::min(listing->free_bytes, quota - std::min(quota, listing->used_bytes));
                   // PrusaSlicer wants "storage_list" to be the first.
                   session.answer(json_answer({{"storage_list",
                                                {{{"type", "LOCAL"},
                                                  {"path", "/local"},
                                                  {"name", kStorage},
                                                  {"available", true},
                                                  {"read_only", !writable},
                                                  {"free_space", room},
                                                  {"total_space", quota}}}}}));
                 });
}

void info(Session& session, std::string_view) {
  const auto& options = session.server().link().options();
  session.answer(json_answer({{"name", machine_info(session).name()},
                              {"serial", options.gateway_id},
                              {"mmu", false},
                              {"farm_mode", false}}));
}

void status(Session& session, std::string_view) {
  const joblink::Status now = machine_status(session);
  const joblink::Pose& tool = now.tool();
  Json printer = {{"state", printer_state(now)},
                  {"temp_nozzle", now.hotend().actual_celsius()},
                  {"target_nozzle", now.hotend().target_celsius()},
                  {"temp_bed", now.bed().actual_celsius()},
                  {"target_bed", now.bed().target_celsius()},
                  {"speed", std::lround(100 * now.feed_override())}};
  if (now.positions_known()) {
    printer["axis_x"] = tool.x_mm();
    printer["axis_y"] = tool.y_mm();
    printer["axis_z"] = tool.z_mm();
  }
  printer["status_printer"] = {{"ok", now.state() != joblink::STATE_ALARM}, {"message", now.doing()}};
  Json answer = {{"storage", {{"path", "/local/"}, {"name", kStorage}, {"read_only", false}}},
                 {"printer", printer}};
  if (job_is_there(now)) answer["job"] = job_json(session, now);
  session.answer(json_answer(answer));
}

Json print_file_json(const StoredJob& job) {
  Json refs = {{"download", download_path(job.name)}};
  if (job.notes.pictures_size() > 0) {
    refs["icon"] = "/thumb/s/local/" + percent_encoded(job.name);
    refs["thumbnail"] = "/thumb/l/local/" + percent_encoded(job.name);
  }
  return {{"name", job.name},       {"display_name", job.name},
          {"type", "PRINT_FILE"},   {"read_only", false},
          {"size", job.size_bytes}, {"m_timestamp", static_cast<std::int64_t>(job.stored_unix_s)},
          {"refs", std::move(refs)}};
}

void present_job(Session& session, std::string_view) {
  const joblink::Status now = machine_status(session);
  if (!job_is_there(now)) return session.answer(no_content());
  session.beside([name = now.job()](JobStore& store) { return store.find(name); },
                 [&session, now](const std::optional<StoredJob>& stored) {
                   Json answer = job_json(session, now);
                   answer["state"] = printer_state(now);
                   answer["inaccurate_estimates"] = false;
                   // It may have been deleted while it runs.
                   answer["file"] = stored ? print_file_json(*stored)
                                           : Json{{"name", now.job()}, {"display_name", now.job()}};
                   answer["file"]["path"] = "/local";
                   session.answer(json_answer(answer));
                 });
}

/// False, and refused: no job of this number is there.
bool names_the_job(Session& session) {
  const std::string& text = session.target().path[3];
  std::uint32_t id = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), id);
  const bool number = read.ec == std::errc() && read.ptr == text.data() + text.size();
  if (number && id == session.server().job_id() && job_is_there(machine_status(session))) return true;
  session.refuse(404, "no job of this number is there");
  return false;
}

void pause_job(Session& session, std::string_view) {
  if (names_the_job(session)) pause(session, Pausing::kPause);
}
void resume_job(Session& session, std::string_view) {
  if (names_the_job(session)) pause(session, Pausing::kResume);
}
void cancel_job(Session& session, std::string_view) {
  if (names_the_job(session)) cancel(session);
}

/// nullopt: refused.
std::optional<std::string> file_of(Session& session) {
  const std::vector<std::string>& path = session.target().path;
  if (!known_storage(path[3])) {
    session.refuse(404, "no storage has this name: the one that is here is called local");
    return std::nullopt;
  }
  if (path.size() == 5) return path[4];
  session.refuse(400, "the store has no folders: leave the path empty");
  return std::nullopt;
}

void folder(Session& session, std::string_view) {
  if (!known_storage(session.target().path[3]))
    return session.refuse(404, "no storage has this name: the one that is here is called local");
  session.beside(
      [](JobStore& store) {
        const auto listing = all_jobs(store);
        if (!listing) return Result<std::string, StoreError>(Error<StoreError>(listing.error()));
        Json list = Json::array();
        for (const StoredJob& stored : listing->jobs) list.push_back(print_file_json(stored));
        return Result<std::string, StoreError>(text_of(
            {{"type", "FOLDER"}, {"name", kStorage}, {"read_only", false}, {"children", std::move(list)}}));
      },
      [&session](Result<std::string, StoreError> text) {
        if (!text) return session.refuse(500, text.error().words);
        session.answer({.body = std::move(*text)});
      });
}

void stored_file(Session& session, std::string_view) {
  const auto name = file_of(session);
  if (!name) return;
  with_job(session, *name,
           [&session](const StoredJob& stored) { session.answer(json_answer(print_file_json(stored))); });
}

/// /thumb/s/local/NAME, /thumb/l/local/NAME
void thumb(Session& session, std::string_view) {
  const std::vector<std::string>& path = session.target().path;
  const bool small = path[1] == "s";
  if ((!small && path[1] != "l") || !known_storage(path[2]))
    return session.refuse(404, "pictures are under /thumb/s/local/ and /thumb/l/local/");
  send_picture(session, {path[3]}, small ? small_picture : great_picture);
}

void remove_file(Session& session, std::string_view) {
  if (const auto name = file_of(session)) delete_job(session, *name);
}

void start(Session& session, std::string_view) {
  if (const auto name = file_of(session))
    start_job(session, *name, [&session] { session.answer(no_content()); });
}

/// An item of structured fields (RFC 8941): true is "?1".
bool is_true(std::string_view value) {
  return value == "?1";
}

/// PUT: the body is the file.
class PutUpload : public Task {
 public:
  explicit PutUpload(Session& session) : session_(session), stream_(session) {}
  void begin() override {
    const auto name = file_of(session_);
    if (!name) return;
    stream_.begin(*name, session_.head().content_length.value_or(0),
                  is_true(session_.head().field("Overwrite")), [this] {
                    session_.let_body_come();
                    if (whole_) end();
                  });
  }
  bool holds_body() const override { return true; }
  bool takes_body() const override { return stream_.takes_bytes(); }
  void on_body(std::string_view bytes) override { stream_.write(bytes); }
  void on_end() override {
    whole_ = true;
    // An empty one is whole before it is begun.
    if (stream_.begun()) end();
  }

 private:
  void end() {
    stream_.end([this] {
      if (!is_true(session_.head().field("Print-After-Upload"))) return tell();
      start_job(session_, stream_.name(), [this] { tell(); });
    });
  }
  void tell() {
    Answer answer = json_answer({{"name", stream_.name()},
                                 {"display_name", stream_.name()},
                                 {"type", "PRINT_FILE"},
                                 {"size", stream_.bytes()},
                                 {"refs", {{"download", download_path(stream_.name())}}}},
                                201);
    answer.fields.emplace_back("Location", "/api/v1/files/local/" + percent_encoded(stream_.name()));
    session_.answer(answer);
  }
  Session& session_;
  JobStream stream_;
  bool whole_ = false;
};

std::unique_ptr<Task> put(Session& session) {
  return std::make_unique<PutUpload>(session);
}

}  // namespace

std::span<const Route> prusalink_routes() {
  static constexpr std::array kRoutes{
      Route{"GET", "api/v1/storage", storage},
      Route{"GET", "api/v1/info", info},
      Route{"GET", "api/v1/status", status},
      Route{"GET", "api/v1/job", present_job},
      Route{"PUT", "api/v1/job/*/pause", pause_job},
      Route{"PUT", "api/v1/job/*/resume", resume_job},
      Route{"DELETE", "api/v1/job/*", cancel_job},
      Route{"GET", "api/v1/files/*", folder},
      Route{"GET", "api/v1/files/*/**", stored_file},
      Route{"PUT", "api/v1/files/*/**", nullptr, put},
      Route{"POST", "api/v1/files/*/**", start},
      Route{"DELETE", "api/v1/files/*/**", remove_file},
      Route{"GET", "thumb/*/*/*", thumb},
  };
  return kRoutes;
}

}  // namespace kinebus::http
