#include "gateway/sessions/http/moonraker/moonraker.hpp"

#include <charconv>
#include <cmath>
#include <utility>

#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/routes.hpp"

namespace kinebus::http {
namespace {

/// So often what has changed is told, as Klipper does.
constexpr LocalTime kUpdatePeriod = std::chrono::milliseconds{250};
constexpr int kNoSuchMethod = -32601, kNoRequest = -32600, kNoJson = -32700;

/// The fields of `fresh` that are not as in `old`.
Json changes(const Json& old, const Json& fresh) {
  Json changed = Json::object();
  for (const auto& [name, object] : fresh.items()) {
    const Json before = old.value(name, Json::object());
    for (const auto& [field, value] : object.items())
      if (!before.contains(field) || before[field] != value) changed[name][field] = value;
  }
  return changed;
}

}  // namespace

bool Call::may_operate() const {
  if (caller.role() >= Role::kOperate) return true;
  fail(403, "this needs the role 'operate'");
  return false;
}

void Call::command(const joblink::ClientMessage& message) const {
  caller.command(message, [call = *this](const joblink::Reply& reply) {
    if (reply.has_error()) return call.fail(400, words_of(reply.error()));
    call.done("ok");
  });
}

double Call::number(const char* name, double otherwise) const {
  const auto found = params.find(name);
  if (found == params.end()) return otherwise;
  if (found->is_number()) return found->get<double>();
  const std::string text = found->is_string() ? found->get<std::string>() : std::string();
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  // "nan" and "inf" are read, too, and are no numbers of anything.
  return read.ec == std::errc() && std::isfinite(value) ? value : otherwise;
}

const Method* moonraker_method(std::string_view name) {
  static const std::vector<Method> methods = moonraker_methods();
  for (const Method& method : methods)
    if (name == method.name) return &method;
  return nullptr;
}

std::vector<Method> moonraker_methods() {
  std::vector<Method> all;
  for (const auto methods :
       {moonraker_server_methods(), moonraker_store_methods(), moonraker_printer_methods(),
        moonraker_file_methods(), moonraker_history_methods(), moonraker_webcam_methods(),
        moonraker_refused_methods()})
    all.insert(all.end(), methods.begin(), methods.end());
  return all;
}

class MoonrakerDialect : public Dialect {
 public:
  explicit MoonrakerDialect(Socket& socket) : socket_(socket) {
    socket_.server().moonraker_sockets()[socket_.id()] = this;
  }
  ~MoonrakerDialect() override { socket_.server().moonraker_sockets().erase(socket_.id()); }

  void on_text(std::string_view text) override {
    const Json said = Json::parse(text, nullptr, false);
    if (said.is_discarded()) return refuse(nullptr, kNoJson, "this is no JSON");
    if (!said.is_array()) return take(said);
    static constexpr std::size_t kMostOfBatch = 50;
    if (said.size() > kMostOfBatch) return refuse(nullptr, kNoRequest, "a batch has at most 50 requests");
    for (const Json& one : said) take(one);
  }

  void on_room(LocalTime now) override {
    tell_events();
    tell_lines();
    if (std::exchange(webcams_, socket_.server().webcams_revision) != socket_.server().webcams_revision)
      tell_webcams();
    if (now < next_update_ || !socket_.has_room()) return;
    next_update_ = now + kUpdatePeriod;
    // A slow reader hears the sum of what has changed since it last heard.
    Json fresh = moonraker_objects(socket_, wanted_);
    const Json changed = changes(told_, fresh);
    told_ = std::move(fresh);
    if (!changed.empty()) notify("notify_status_update", {changed, to_seconds(now)});
  }
  LocalTime next_news() const override {
    if (socket_.server().link().events().newest() > told_event_ ||
        socket_.server().console().newest() > told_line_)
      return LocalTime{0};
    return next_update_;
  }

  void subscribe(Json wanted) {
    wanted_ = std::move(wanted);
    told_ = moonraker_objects(socket_, wanted_);
    next_update_ = wanted_.empty() ? LocalTime::max() : socket_.now() + kUpdatePeriod;
  }
  bool identify(const std::string& name, const std::string& key) {
    const User* const user = socket_.server().users().by_key(key);
    if (!socket_.is_in() && user == nullptr) return false;
    socket_.let_in(user != nullptr ? user->visitor : socket_.visitor(), name);
    return true;
  }

 private:
  void take(const Json& said) {
    if (!said.is_object()) return refuse(nullptr, kNoRequest, "a request is an object");
    const auto given = said.find("id");
    const Json id = given != said.end() && !given->is_structured() ? *given : Json(nullptr);
    const std::string name = word_in(said, "method");
    const Method* method = moonraker_method(name);
    if (method == nullptr) return refuse(id, kNoSuchMethod, "Method not found");
    if (!method->open && !socket_.is_in()) return refuse(id, 401, "Unauthorized");
    const auto params = said.find("params");
    const bool named = params != said.end() && params->is_object();
    method->carry_out({.caller = socket_,
                       .params = named ? *params : Json::object(),
                       .then =
                           [this, id](Result<Json, RpcError> result) {
                             if (!result) return refuse(id, result.error().code, result.error().message);
                             if (id.is_null()) return;
                             say({{"jsonrpc", "2.0"}, {"result", std::move(*result)}, {"id", id}});
                           },
                       .socket = this});
  }

  void tell_events() {
    const EventLog& events = socket_.server().link().events();
    while (socket_.has_room()) {
      const joblink::Event* event = events.after(told_event_);
      if (event == nullptr) return;
      told_event_ = event->id();
      tell(*event);
    }
  }
  /// What lines of any client were answered.
  void tell_lines() {
    if (socket_.server().console().newest() == told_line_) return;
    for (const ConsoleCourse::Line& line : socket_.server().console().lines()) {
      if (line.id <= told_line_) continue;
      if (!socket_.has_room()) return;
      told_line_ = line.id;
      if (!line.is_command) notify("notify_gcode_response", Json::array({line.text}));
    }
  }
  void tell(const joblink::Event& event) {
    switch (event.kind()) {
      case joblink::EVENT_ALARM:
        notify("notify_gcode_response", Json::array({"!! " + event.words() + " " + event.advice()}));
        break;
      case joblink::EVENT_MESSAGE:
      case joblink::EVENT_PROBLEM:
        notify("notify_gcode_response", Json::array({"// " + event.words()}));
        break;
      case joblink::EVENT_JOBS:
        notify("notify_filelist_changed",
               Json::array({Json::object(
                   {{"action", "create_file"}, {"item", {{"path", event.job()}, {"root", "gcodes"}}}})}));
        break;
      case joblink::EVENT_STATE:
        tell_state();
        break;
      default:
        break;
    }
  }
  void tell_state() {
    const bool in_job = socket_.server().in_job();
    if (std::exchange(in_job_, in_job) != in_job)
      newest_run(socket_, [this, in_job](Json run) {
        if (run.is_null()) return;
        notify("notify_history_changed", Json::array({Json::object({{"action", in_job ? "added" : "finished"},
                                                                    {"job", std::move(run)}})}));
      });
    const std::string state = klippy_state(machine_status(socket_));
    if (state == klippy_) return;
    klippy_ = state;
    notify(state == "ready" ? "notify_klippy_ready" : "notify_klippy_shutdown", Json::array());
  }

  void tell_webcams() {
    moonraker_method("server.webcams.list")
        ->carry_out(
            {.caller = socket_, .params = Json::object(), .then = [this](Result<Json, RpcError> list) {
               if (list) notify("notify_webcams_changed", Json::array({std::move(*list)}));
             }});
  }

  /// `params`: an array. To be made by Json::array: of one value in braces some compilers make a copy of it.
  void notify(const char* method, Json params) {
    say({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}});
  }
  void refuse(const Json& id, int code, const std::string& words) {
    say({{"jsonrpc", "2.0"}, {"error", {{"code", code}, {"message", words}}}, {"id", id}});
  }
  void say(const Json& json) { socket_.say(text_of(json)); }

  Socket& socket_;
  Json wanted_ = Json::object(), told_ = Json::object();
  LocalTime next_update_ = LocalTime::max();
  std::uint64_t told_event_ = socket_.server().link().events().newest();
  std::uint64_t told_line_ = socket_.server().console().newest();
  std::uint32_t webcams_ = socket_.server().webcams_revision;
  bool in_job_ = socket_.server().in_job();
  std::string klippy_ = "ready";
};

std::unique_ptr<Dialect> moonraker_dialect(Socket& socket) {
  return std::make_unique<MoonrakerDialect>(socket);
}
void subscribe(MoonrakerDialect& socket, Json wanted) {
  socket.subscribe(std::move(wanted));
}
bool identify(MoonrakerDialect& socket, const std::string& name, const std::string& key) {
  return socket.identify(name, key);
}

}  // namespace kinebus::http
