// OctoPrint's REST API (docs.octoprint.org/en/master/api), as far as slicers, apps and managers of printers
// use it. What Kinebus does not have is left out, not made up.

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/job_stream.hpp"
#include "gateway/sessions/http/multipart.hpp"
#include "gateway/sessions/http/routes.hpp"

namespace kinebus::http {
namespace {

struct Flags {
  const char* text;  ///< as OctoPrint's clients know it
  bool operational = true, printing = false, pausing = false, cancelling = false, ready = false,
       error = false;
};

Flags flags_of(joblink::State state) {
  switch (state) {
    case joblink::STATE_OFF:
      return {.text = "Offline", .operational = false};
    case joblink::STATE_BRING_UP:
      return {.text = "Connecting", .operational = false};
    case joblink::STATE_READY:
      return {.text = "Operational", .ready = true};
    case joblink::STATE_CHECKING:
      return {.text = "Starting", .printing = true};
    case joblink::STATE_RUNNING:
      return {.text = "Printing", .printing = true};
    case joblink::STATE_HOLDING:
      return {.text = "Pausing", .printing = true, .pausing = true};
    case joblink::STATE_HELD:
      return {.text = "Paused"};
    case joblink::STATE_CANCELLING:
      return {.text = "Cancelling", .cancelling = true};
    case joblink::STATE_STOPPING:
    case joblink::STATE_STOPPED:
    case joblink::STATE_ALARM:
      return {.text = "Error", .operational = false, .error = true};
    default:
      return {.text = "Operational"};
  }
}

const char* state_text(const joblink::Status& status) {
  return is_paused(status) ? "Paused" : flags_of(status.state()).text;
}

Json state_json(const joblink::Status& status) {
  const Flags flags = flags_of(status.state());
  return {{"text", state_text(status)},
          {"flags",
           {{"operational", flags.operational},
            {"paused", is_paused(status)},
            {"printing", flags.printing},
            {"pausing", flags.pausing},
            {"cancelling", flags.cancelling},
            {"resuming", false},
            {"finishing", false},
            {"sdReady", false},
            {"error", flags.error},
            {"ready", flags.ready},
            {"closedOrError", !flags.operational}}},
          // In Kinebus's own words, for whoever reads them.
          {"kinebus", {{"state", status.state_words()}, {"doing", status.doing()}}}};
}

/// "tool0", "bed", "chamber", as OctoPrint names heaters.
std::string heater_name(const joblink::Heater& heater) {
  const std::string number = std::to_string(heater.index());
  if (heater.kind() == joblink::HEATER_HOTEND) return "tool" + number;
  const std::string kind = heater.kind() == joblink::HEATER_BED ? "bed" : "chamber";
  return heater.index() == 0 ? kind : kind + number;
}

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

Json user() {
  return {{"name", "kinebus"},
          {"active", true},
          {"user", true},
          {"admin", true},
          {"apikey", nullptr},
          {"groups", {"admins", "users"}},
          {"permissions",
           {"STATUS", "CONNECTION", "FILES_LIST", "FILES_UPLOAD", "FILES_DOWNLOAD", "FILES_DELETE",
            "FILES_SELECT", "PRINT"}}};
}

/// Whoever asks has shown the key: nobody logs in by a name.
void login(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  if (!asked->value("passive", Json(false)).is_boolean() || !asked->value("passive", Json(false)).get<bool>())
    return session.refuse(403, "there are no names and passwords: clients are let in by X-Api-Key");
  Json answer = user();
  // A key is shown with every request; this tells nothing and opens nothing.
  answer["session"] = std::to_string(session.id());
  answer["_is_external_client"] = false;
  session.answer(json_answer(answer));
}

void current_user(Session& session, std::string_view) {
  session.answer(json_answer(user()));
}

void settings(Session& session, std::string_view) {
  session.answer(json_answer({{"api", {{"allowCrossOrigin", false}}},
                              {"appearance", {{"name", machine_info(session).name()}, {"color", "default"}}},
                              {"feature", {{"sdSupport", false}, {"temperatureGraph", true}}},
                              {"webcam", {{"webcamEnabled", false}, {"streamUrl", ""}, {"snapshotUrl", ""}}},
                              {"plugins", Json::object()}}));
}

void connection(Session& session, std::string_view) {
  const joblink::Status status = machine_status(session);
  session.answer(
      json_answer({{"current",
                    {{"state", state_text(status)},
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
  Json temperature = Json::object();
  for (const joblink::Heater& heater : status.heaters())
    temperature[heater_name(heater)] = {
        {"actual", heater.actual_celsius()}, {"target", heater.target_celsius()}, {"offset", 0}};
  session.answer(
      json_answer({{"temperature", temperature}, {"sd", {{"ready", false}}}, {"state", state_json(status)}}));
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
  if (job.preflight)
    file["gcodeAnalysis"] = {{"estimatedPrintTime", job.preflight->motion_s + job.preflight->dwell_s}};
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
  session.beside(
      [](JobStore& store) {
        std::string after;
        Json list = Json::array();
        std::uint64_t free = 0, quota = 0;
        for (bool more = true; more;) {
          const auto listing = store.list(after);
          if (!listing) return Result<std::string, StoreError>(Error<StoreError>(listing.error()));
          for (const StoredJob& job : listing->jobs) list.push_back(file_json(job));
          quota = listing->quota_bytes;
          free = std::min(listing->free_bytes, quota - std::min(quota, listing->used_bytes));
          more = listing->more && !listing->jobs.empty();
          if (more) after = listing->jobs.back().name;
        }
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

void remove(Session& session, std::string_view) {
  delete_job(session, file_name(session));
}

void file_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  if (word_in(*asked, "command") != "select")
    return session.refuse(400, "the commands of a file are: select");
  const auto print = asked->find("print");
  const bool prints = print != asked->end() && print->is_boolean() && print->get<bool>();
  with_job(session, file_name(session), [&session, prints](const StoredJob& job) {
    session.server().selected = job.name;
    if (!prints) return session.answer(no_content());
    start_job(session, job.name, [&session] { session.answer(no_content()); });
  });
}

void tell_job(Session& session, const joblink::Status& status, const StoredJob* job) {
  const bool runs = job_is_there(status);
  Json file = {{"name", nullptr},   {"path", nullptr}, {"display", nullptr},
               {"origin", nullptr}, {"size", nullptr}, {"date", nullptr}};
  const std::string& name = runs ? status.job() : session.server().selected;
  if (!name.empty()) {
    file["name"] = file["path"] = file["display"] = name;
    file["origin"] = "local";
  }
  Json estimate = nullptr;
  if (job != nullptr) {
    file["size"] = job->size_bytes;
    file["date"] = static_cast<std::int64_t>(job->stored_unix_s);
  }
  if (runs) estimate = status.elapsed_s() + status.remaining_s();
  Json progress = {{"completion", nullptr},
                   {"filepos", nullptr},
                   {"printTime", nullptr},
                   {"printTimeLeft", nullptr},
                   {"printTimeLeftOrigin", nullptr}};
  if (runs)
    progress = {{"completion", 100 * status.progress()},
                {"filepos", job != nullptr ? Json(static_cast<std::uint64_t>(
                                                 status.progress() * static_cast<double>(job->size_bytes)))
                                           : Json(nullptr)},
                {"printTime", static_cast<std::int64_t>(status.elapsed_s())},
                {"printTimeLeft", static_cast<std::int64_t>(status.remaining_s())},
                {"printTimeLeftOrigin", "estimate"}};
  session.answer(json_answer({{"job",
                               {{"file", file},
                                {"estimatedPrintTime", estimate},
                                {"lastPrintTime", nullptr},
                                {"filament", nullptr}}},
                              {"progress", progress},
                              {"state", state_text(status)}}));
}

void job(Session& session, std::string_view) {
  joblink::Status status = machine_status(session);
  const std::string name = job_is_there(status) ? status.job() : session.server().selected;
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

/// POST /api/files/local: a form with the file, and whether it is to be selected and printed.
class FormUpload : public Task {
 public:
  FormUpload(Session& session, const std::string& boundary)
      : session_(session), form_(boundary), stream_(session) {}
  void on_body(std::string_view bytes) override {
    form_.add(bytes);
    read();
  }
  bool takes_body() const override { return !waits_ && (!in_file_ || stream_.takes_bytes()); }
  void on_end() override {
    if (!form_.ended()) return session_.refuse(400, "the form ends without its closing boundary");
    if (!stream_.begun()) return session_.refuse(400, "the form holds no file (the part named \"file\")");
    if (!folder_.empty() && folder_ != "/" && folder_ != ".") return session_.refuse(400, kNoFolders);
    stream_.end([this] { stored(); });
  }
  static constexpr const char* kNoFolders = "the store has no folders: leave the path empty";

 private:
  static constexpr std::size_t kMaxField = 1024;

  void read() {
    using Step = Multipart::Step;
    // A task that has answered is not asked any more.
    while (!waits_ && session_.unanswered()) {
      const Step step = form_.next();
      if (step == Step::kMore || step == Step::kEnd) return;
      if (step == Step::kBad) return session_.refuse(400, form_.why());
      if (step == Step::kPart) begin_part();
      if (step == Step::kData) take(form_.data());
      if (step == Step::kPartEnd) end_part();
    }
  }
  void begin_part() {
    field_.clear();
    in_file_ = form_.file_name().has_value() && form_.name() == "file";
    if (!in_file_) return;
    if (!stream_.name().empty()) return session_.refuse(400, "a form holds one file");
    if (form_.file_name()->empty()) return session_.refuse(400, "the file has no name");
    waits_ = true;
    // The form around the file is small against it: its length is the room that is kept.
    stream_.begin(*form_.file_name(), session_.head().content_length.value_or(0), true, [this] {
      waits_ = false;
      read();
    });
  }
  void take(std::string_view data) {
    if (in_file_) return stream_.write(data);
    if (field_.size() + data.size() > kMaxField)
      return session_.refuse(400, "a field of the form has at most 1 KiB");
    field_ += data;
  }
  void end_part() {
    if (!in_file_ && form_.name() == "path") folder_ = field_;
    if (!in_file_ && form_.name() == "print") print_ = field_ == "true";
    if (!in_file_ && form_.name() == "select") select_ = field_ == "true";
    if (!in_file_ && form_.name() == "foldername") session_.refuse(400, kNoFolders);
    in_file_ = false;
  }
  void stored() {
    if (select_ || print_) session_.server().selected = stream_.name();
    if (!print_) return tell();
    start_job(session_, stream_.name(), [this] { tell(); });
  }
  void tell() {
    const std::string& name = stream_.name();
    const std::string resource = "/api/files/local/" + percent_encoded(name);
    Answer answer =
        json_answer({{"files",
                      {{"local",
                        {{"name", name},
                         {"display", name},
                         {"path", name},
                         {"origin", "local"},
                         {"refs", {{"resource", resource}, {"download", download_path(name)}}}}}}},
                     {"done", true},
                     {"effectiveSelect", select_ || print_},
                     {"effectivePrint", print_}},
                    201);
    answer.fields.emplace_back("Location", resource);
    session_.answer(answer);
  }

  Session& session_;
  Multipart form_;
  JobStream stream_;
  std::string field_, folder_;
  bool waits_ = false, in_file_ = false, print_ = false, select_ = false;
};

/// Answers at its beginning.
class Refused : public Task {
 public:
  Refused(Session& session, int status, const char* why) : session_(session), status_(status), why_(why) {}
  void begin() override { session_.refuse(status_, why_); }
  void on_body(std::string_view) override {}
  void on_end() override {}

 private:
  Session& session_;
  int status_;
  const char* why_;
};

std::unique_ptr<Task> upload(Session& session) {
  const auto boundary = boundary_of(session.head().field("Content-Type"));
  if (!boundary)
    return std::make_unique<Refused>(session, 415,
                                     "an upload is a form: multipart/form-data with its boundary");
  return std::make_unique<FormUpload>(session, *boundary);
}

std::unique_ptr<Task> download_file(Session& session) {
  return download(session, session.target().path.back());
}

}  // namespace

std::span<const Route> octoprint_routes() {
  static constexpr std::array kRoutes{
      Route{"GET", "api/version", version},
      Route{"GET", "api/server", server},
      Route{"POST", "api/login", login},
      Route{"GET", "api/currentuser", current_user},
      Route{"GET", "api/settings", settings},
      Route{"GET", "api/connection", connection},
      Route{"GET", "api/printer", printer},
      Route{"GET", "api/printerprofiles", printer_profiles},
      Route{"GET", "api/job", job},
      Route{"POST", "api/job", job_command},
      Route{"GET", "api/files", files},
      Route{"GET", "api/files/local", files},
      Route{"POST", "api/files/local", nullptr, upload},
      Route{"GET", "api/files/local/*", file},
      Route{"POST", "api/files/local/*", file_command},
      Route{"DELETE", "api/files/local/*", remove},
      Route{"GET", "downloads/files/local/*", nullptr, download_file},
  };
  return kRoutes;
}

}  // namespace kinebus::http
