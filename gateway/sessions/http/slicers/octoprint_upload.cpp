// The upload of OctoPrint's and Moonraker's APIs: a form with the file.

#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/job_stream.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"
#include "gateway/sessions/http/wire/multipart.hpp"

namespace kinebus::http {
namespace {

/// What a stored file is answered with.
struct Uploaded {
  const std::string& name;
  bool selected = false, printed = false;
};
using Told = Answer (*)(const Uploaded& uploaded);

/// A form with the file, and whether it is to be selected and printed.
class FormUpload : public Task {
 public:
  FormUpload(Session& session, const std::string& boundary, Told told)
      : session_(session), form_(boundary), stream_(session), told_(told) {}
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
    // Moonraker's: its only root is where jobs are.
    if (!in_file_ && form_.name() == "root" && field_ != "gcodes")
      session_.refuse(400, "the only root is gcodes");
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
  void tell() { session_.answer(told_({stream_.name(), select_ || print_, print_})); }

  Session& session_;
  Multipart form_;
  JobStream stream_;
  Told told_;
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

Answer octoprint_told(const Uploaded& uploaded) {
  const std::string& name = uploaded.name;
  const std::string resource = "/api/files/local/" + percent_encoded(name);
  Answer answer = json_answer({{"files",
                                {{"local",
                                  {{"name", name},
                                   {"display", name},
                                   {"path", name},
                                   {"origin", "local"},
                                   {"refs", {{"resource", resource}, {"download", download_path(name)}}}}}}},
                               {"done", true},
                               {"effectiveSelect", uploaded.selected},
                               {"effectivePrint", uploaded.printed}},
                              201);
  answer.fields.emplace_back("Location", resource);
  return answer;
}

Answer moonraker_told(const Uploaded& uploaded) {
  return json_answer({{"item", {{"path", uploaded.name}, {"root", "gcodes"}}},
                      {"print_started", uploaded.printed},
                      {"print_queued", false},
                      {"action", "create_file"}},
                     201);
}

std::unique_ptr<Task> form_upload(Session& session, Told told) {
  const auto boundary = boundary_of(session.head().field("Content-Type"));
  if (!boundary)
    return std::make_unique<Refused>(session, 415,
                                     "an upload is a form: multipart/form-data with its boundary");
  return std::make_unique<FormUpload>(session, *boundary, told);
}

}  // namespace

std::unique_ptr<Task> octoprint_upload(Session& session) {
  return form_upload(session, octoprint_told);
}
std::unique_ptr<Task> moonraker_upload(Session& session) {
  return form_upload(session, moonraker_told);
}

}  // namespace kinebus::http
