#include "gateway/sessions/http/api.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <memory>
#include <utility>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus::http {
namespace {

/// So long a request to start a job waits for the pre-flight's verdict: less than the patience of clients.
constexpr LocalTime kVerdictWithin = std::chrono::seconds{8};
constexpr std::size_t kReadBytes = 128U << 10;

/// The first error that the pre-flight found after event `after`; "": none.
std::string first_error(const EventLog& events, std::uint64_t after) {
  static constexpr std::string_view kError = "error: ";
  std::string words;
  events.each(after, false, [&](const joblink::Event& event) {
    if (event.kind() == joblink::EVENT_PROBLEM && event.words().starts_with(kError))
      words = event.words().substr(kError.size());
    // Some name their line themselves.
    if (!words.empty() && !words.starts_with("line "))
      words = "line " + std::to_string(event.line()) + ": " + words;
    return words.empty();
  });
  return words;
}

struct ByteRange {
  std::uint64_t begin, end;
};
/// Of "bytes=2-5", "bytes=2-" and "bytes=-3"; empty where it begins behind the end. nullopt: all is wanted,
/// as where it is malformed or more than one (RFC 9110, 14.2).
std::optional<ByteRange> byte_range(std::string_view range, std::uint64_t size) {
  static constexpr std::string_view kUnit = "bytes=";
  if (!range.starts_with(kUnit)) return std::nullopt;
  range.remove_prefix(kUnit.size());
  const std::size_t dash = range.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto number = [](std::string_view digits) -> std::optional<std::uint64_t> {
    std::uint64_t value = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || read.ec != std::errc() || read.ptr != digits.data() + digits.size())
      return std::nullopt;
    return value;
  };
  const auto first = number(range.substr(0, dash)), last = number(range.substr(dash + 1));
  if (dash == 0) return last ? std::optional(ByteRange{size - std::min(*last, size), size}) : std::nullopt;
  if (!first) return std::nullopt;
  if (dash + 1 == range.size()) return ByteRange{*first, size};
  if (!last || *last < *first) return std::nullopt;
  return ByteRange{*first, *last < size ? *last + 1 : size};
}

class Download : public Task {
 public:
  Download(Session& session, std::string name) : session_(session), name_(std::move(name)) {}
  void on_body(std::string_view) override {}
  void on_end() override { read(); }
  void on_written() override {
    if (begun_ && !asked_) read();
  }

 private:
  void read() {
    asked_ = true;
    joblink::ClientMessage message;
    message.mutable_read_job()->set_name(name_);
    message.mutable_read_job()->set_offset_bytes(offset_);
    message.mutable_read_job()->set_max_bytes(kReadBytes);
    session_.ask(message, [this](const joblink::Reply& reply) { take(reply); });
  }
  void take(const joblink::Reply& reply) {
    asked_ = false;
    const joblink::JobText& text = reply.job_text();
    if (reply.has_error() && !begun_) return session_.refuse(reply.error());
    if (!begun_) {
      size_ = text.size_bytes();
      end_ = size_;
      if (!begin_answer()) return;
      if (session_.head().method == "HEAD") return session_.finish();
      // What was read is not what is wanted.
      if (offset_ > 0) return read();
    }
    // Replaced or deleted while it was read.
    if (reply.has_error() || text.size_bytes() != size_) return session_.break_off();
    const auto rest = static_cast<std::size_t>(end_ - offset_);
    session_.write(std::string_view(text.data()).substr(0, rest));
    offset_ += std::min(text.data().size(), rest);
    if (offset_ >= end_) return session_.finish();
    if (text.data().empty()) session_.break_off();
  }
  /// The answer's head. False: the part that is asked for is not there, and that is said.
  bool begin_answer() {
    begun_ = true;
    Answer head{
        .type = "text/x.gcode",
        .fields = {{"Accept-Ranges", "bytes"},
                   {"Content-Disposition", "attachment; filename*=UTF-8''" + percent_encoded(name_)}}};
    const auto part = byte_range(session_.head().field("Range"), size_);
    const std::string of_size = "/" + std::to_string(size_);
    if (part && part->begin >= part->end) {
      session_.answer({.status = 416,
                       .body = R"({"error":"the file does not reach so far"})",
                       .fields = {{"Content-Range", "bytes *" + of_size}}});
      return false;
    }
    if (part) {
      offset_ = part->begin;
      end_ = part->end;
      head.status = 206;
      head.fields.emplace_back("Content-Range",
                               "bytes " + std::to_string(offset_) + "-" + std::to_string(end_ - 1) + of_size);
    }
    session_.answer_head(head, end_ - offset_);
    return true;
  }
  Session& session_;
  std::string name_;
  std::uint64_t offset_ = 0, size_ = 0, end_ = 0;  ///< end_: of the part that is wanted
  bool begun_ = false, asked_ = false;
};

}  // namespace

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Answer json_answer(const Json& json, int status) {
  return {.status = status, .body = text_of(json)};
}

Answer no_content() {
  return {.status = 204};
}

std::optional<Json> json_body(Session& session, std::string_view body) {
  const std::string_view type = session.head().field("Content-Type");
  if (!same_word(type.substr(0, type.find(';')), "application/json")) {
    session.refuse(415, "such a request has a body of application/json");
    return std::nullopt;
  }
  // A form of a foreign page cannot send this type, and depth is bounded by the size.
  Json parsed = Json::parse(body, nullptr, false);
  if (parsed.is_object()) return parsed;
  session.refuse(400, "the body is no object of JSON");
  return std::nullopt;
}

std::string word_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

joblink::Status machine_status(Caller& caller) {
  joblink::ClientMessage message;
  message.mutable_get_status();
  return caller.ask_now(message).status();
}

joblink::MachineInfo machine_info(Caller& caller) {
  joblink::ClientMessage message;
  message.mutable_get_machine();
  return caller.ask_now(message).machine();
}

bool job_is_there(const joblink::Status& status) {
  return !status.job().empty();
}

bool is_paused(const joblink::Status& status) {
  return status.state() == joblink::STATE_HELD ||
         (job_is_there(status) && status.interrupted() && status.at_rest());
}

void command(Session& session, const joblink::ClientMessage& message) {
  session.ask(message, [&session](const joblink::Reply& reply) {
    if (reply.has_error()) return session.refuse(reply.error());
    session.answer(no_content());
  });
}

void begin_job(Caller& caller, const std::string& name, std::function<void(const joblink::Problem&)> then) {
  const std::uint64_t before = caller.server().link().events().newest();
  joblink::ClientMessage message;
  message.mutable_start_job()->set_name(name);
  caller.command(message, [&caller, before, then = std::move(then)](const joblink::Reply& reply) {
    if (reply.has_error()) return then(reply.error());
    const LocalTime until = caller.now() + kVerdictWithin;
    caller.wait_for([&caller, before, until, then](LocalTime now) {
      const bool checking = machine_status(caller).state() == joblink::STATE_CHECKING;
      if (checking && now < until) return false;
      const std::string wrong =
          checking ? std::string() : first_error(caller.server().link().events(), before);
      joblink::Problem problem;
      if (!wrong.empty()) {
        problem.set_code(joblink::ERROR_MACHINE_STATE);
        problem.set_rule("the job is refused: " + wrong);
      }
      then(problem);
      return true;
    });
  });
}

std::string words_of(const joblink::Problem& problem) {
  return problem.expected().empty() ? problem.rule() : problem.rule() + " (" + problem.expected() + ")";
}

void start_job(Session& session, const std::string& name, std::function<void()> started) {
  begin_job(session, name, [&session, started = std::move(started)](const joblink::Problem& wrong) {
    if (!wrong.rule().empty()) return session.refuse(wrong);
    started();
  });
}

Result<JobListing, StoreError> all_jobs(JobStore& store) {
  auto all = store.list({});
  while (all && all->more && !all->jobs.empty()) {
    auto next = store.list(all->jobs.back().name);
    if (!next) return next;
    std::move(next->jobs.begin(), next->jobs.end(), std::back_inserter(all->jobs));
    all->more = next->more && !next->jobs.empty();
  }
  return all;
}

bool may_operate(Session& session) {
  if (session.role() >= Role::kOperate) return true;
  session.refuse(403, "this needs the role 'operate'");
  return false;
}

void delete_job(Session& session, const std::string& name) {
  joblink::ClientMessage message;
  message.mutable_delete_job()->set_name(name);
  if (session.role() >= Role::kOperate && session.server().selected == name)
    session.server().selected.clear();
  command(session, message);
}

void with_job(Session& session, const std::string& name, std::function<void(const StoredJob&)> found) {
  session.beside([name](JobStore& store) { return store.find(name); },
                 [&session, found = std::move(found)](const std::optional<StoredJob>& job) {
                   if (!job) return session.refuse(404, "no stored job has this name");
                   found(*job);
                 });
}

std::unique_ptr<Task> download(Session& session, std::string name) {
  return std::make_unique<Download>(session, std::move(name));
}

joblink::ClientMessage pause_message(Pausing pausing, bool is_paused) {
  joblink::ClientMessage message;
  if (pausing == Pausing::kResume || (pausing == Pausing::kToggle && is_paused))
    message.mutable_resume();
  else
    message.mutable_hold();
  return message;
}

void pause(Session& session, Pausing pausing) {
  command(session, pause_message(pausing, is_paused(machine_status(session))));
}

void cancel(Session& session) {
  joblink::ClientMessage message;
  message.mutable_cancel();
  command(session, message);
}

std::string download_path(const std::string& name) {
  return "/downloads/files/local/" + percent_encoded(name);
}

}  // namespace kinebus::http
