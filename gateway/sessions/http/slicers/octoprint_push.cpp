// OctoPrint's push updates (docs.octoprint.org/en/master/api/push): the state twice a second, and events as
// they happen. Over a plain websocket, or in SockJS's frames (its protocol 0.3.3: "o" when it is open, each
// message as a text in an array), with no other transport than websockets.

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "gateway/sessions/http/gate.hpp"
#include "gateway/sessions/http/moonraker/moonraker.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"
#include "gateway/sessions/http/slicers/octoprint_events.hpp"

namespace kinebus::http {
namespace {

constexpr LocalTime kUpdatePeriod = std::chrono::milliseconds{500};
constexpr int kMostThrottle = 120;
constexpr std::string_view kSockJsOpen = "o";

/// The last 20 minutes, a point a second. `names`: OctoPrint's of Klipper's.
Json points_of(const TemperatureCourse::Courses& courses, const std::map<std::string, std::string>& names,
               double unix_s) {
  Json points = Json::array();
  for (std::size_t age = TemperatureCourse::kValues; age-- > 0;) {
    Json point = Json::object();
    for (const auto& [klipper, octoprint] : names) {
      const auto course = courses.find(klipper);
      if (course == courses.end() || course->second.size() <= age) continue;
      const TemperatureCourse::Value& value = course->second[course->second.size() - 1 - age];
      point[octoprint] = {{"actual", value.celsius}, {"target", value.target_celsius.value_or(0)}};
    }
    if (point.empty()) continue;
    point["time"] = static_cast<std::int64_t>(unix_s) - static_cast<std::int64_t>(age);
    points.push_back(std::move(point));
  }
  return points;
}

class OctoPrintDialect : public Dialect {
 public:
  OctoPrintDialect(Socket& socket, bool in_sockjs)
      : socket_(socket), in_sockjs_(in_sockjs), events_(machine_status(socket), socket.server().in_job()) {
    if (in_sockjs_) socket_.say(kSockJsOpen);
    tell("connected", {{"version", kOctoPrintApi},
                       {"display_version", std::string(kOctoPrintApi) + " (Kinebus)"},
                       {"branch", "kinebus"},
                       {"plugin_hash", "none"},
                       {"config_hash", "none"}});
  }

  void on_text(std::string_view text) override {
    const Json said = Json::parse(text, nullptr, false);
    if (!in_sockjs_ || !said.is_array()) return take(said);
    for (const Json& one : said)
      take(one.is_string() ? Json::parse(one.get<std::string>(), nullptr, false) : Json());
  }

  void on_room(LocalTime now) override {
    if (!std::exchange(knows_past_, true)) return tell_past();
    tell_events();
    if (now < next_update_ || !socket_.has_room()) return;
    next_update_ = now + kUpdatePeriod * throttle_;
    const joblink::Status status = machine_status(socket_);
    find_job(octoprint_job_name(status, socket_.server().selected));
    Json current = state_of(status);
    Json point = octoprint_temperatures(status);
    if (!point.empty()) {
      point["time"] = static_cast<std::int64_t>(socket_.server().unix_s(now));
      current["temps"].push_back(std::move(point));
    }
    current["logs"] = new_lines();
    tell("current", current);
  }
  LocalTime next_news() const override {
    if (!knows_past_ || socket_.server().link().events().newest() > told_event_) return LocalTime{0};
    return next_update_;
  }

 private:
  /// What is not understood is left alone, as OctoPrint does.
  void take(const Json& said) {
    if (!said.is_object()) return;
    if (const std::string auth = word_in(said, "auth"); !auth.empty()) {
      const std::size_t colon = std::min(auth.find(':'), auth.size() - 1);
      const auto visitor =
          socket_.server().logins().find(std::string_view(auth).substr(colon + 1), socket_.now());
      if (!visitor || auth.substr(0, colon) != octoprint_user(*visitor))
        return tell("reauthRequired", Json::object({{"reason", "stale"}}));
      socket_.let_in(*visitor, {});
    }
    const auto throttle = said.find("throttle");
    if (throttle != said.end() && throttle->is_number_integer())
      throttle_ = static_cast<int>(std::clamp<std::int64_t>(throttle->get<std::int64_t>(), 1, kMostThrottle));
  }

  Json state_of(const joblink::Status& status) const {
    Json state = octoprint_job_json(status, socket_.server().selected, job_ ? &*job_ : nullptr);
    state["state"] = octoprint_state_json(status);
    state["currentZ"] = status.positions_known() ? Json(status.tool().z_mm()) : Json(nullptr);
    state["offsets"] = Json::object();
    state["temps"] = state["logs"] = state["messages"] = Json::array();
    state["resends"] = {{"count", 0}, {"transmitted", 0}, {"ratio", 0}};
    return state;
  }

  /// What was before; made beside the loop, since it is long.
  void tell_past() {
    const joblink::Status status = machine_status(socket_);
    std::map<std::string, std::string> names;
    for (const joblink::Heater& heater : status.heaters())
      names[klipper_heater(heater)] = octoprint_heater(heater);
    Json history = state_of(status);
    history["logs"] = new_lines();
    socket_.beside(
        [history = std::move(history), names = std::move(names),
         courses = socket_.server().temperatures().all(),
         unix_s = socket_.server().unix_s(socket_.now())](JobStore&) {
          Json whole = Json::object({{"history", history}});
          whole["history"]["temps"] = points_of(courses, names, unix_s);
          return text_of(whole);
        },
        [this](const std::string& text) { say(text); });
  }

  void tell_events() {
    const EventLog& log = socket_.server().link().events();
    while (socket_.has_room()) {
      const joblink::Event* event = log.after(told_event_);
      if (event == nullptr) return;
      told_event_ = event->id();
      if (event->kind() == joblink::EVENT_JOBS) job_name_.reset();
      for (auto& [type, payload] : events_.of(*event, machine_status(socket_)))
        tell("event", {{"type", type}, {"payload", std::move(payload)}});
    }
  }

  /// Sent and received since the last time, as OctoPrint's terminal shows them.
  Json new_lines() {
    Json lines = Json::array();
    for (const ConsoleCourse::Line& line : socket_.server().console().lines()) {
      if (line.id <= told_line_) continue;
      told_line_ = line.id;
      lines.push_back((line.is_command ? "Send: " : "Recv: ") + line.text);
    }
    return lines;
  }

  void find_job(const std::string& name) {
    if (job_name_ == name) return;
    job_name_ = name;
    job_.reset();
    if (name.empty()) return;
    socket_.beside([name](JobStore& store) { return store.find(name); },
                   [this, name](std::optional<StoredJob> found) {
                     if (job_name_ == name) job_ = std::move(found);
                   });
  }

  void tell(const char* type, Json payload) { say(text_of(Json::object({{type, std::move(payload)}}))); }
  void say(const std::string& text) { socket_.say(in_sockjs_ ? "a" + text_of(Json::array({text})) : text); }

  Socket& socket_;
  bool in_sockjs_;
  OctoPrintEvents events_;
  bool knows_past_ = false;
  int throttle_ = 1;
  LocalTime next_update_{0};
  std::uint64_t told_event_ = socket_.server().link().events().newest();
  std::uint64_t told_line_ = 0;
  std::optional<std::string> job_name_;  ///< whose job_ is; nothing: it may have changed
  std::optional<StoredJob> job_;
};

std::unique_ptr<Dialect> plain(Socket& socket) {
  return std::make_unique<OctoPrintDialect>(socket, false);
}
std::unique_ptr<Dialect> in_sockjs(Socket& socket) {
  return std::make_unique<OctoPrintDialect>(socket, true);
}

void sockjs_info(Session& session, std::string_view) {
  session.answer(json_answer({{"websocket", true},
                              {"origins", {"*:*"}},
                              {"cookie_needed", false},
                              // Against caches that keep what they should not.
                              {"entropy", static_cast<std::uint32_t>(session.now().count())}}));
}

}  // namespace

std::span<const Route> octoprint_push_routes() {
  static constexpr std::array kRoutes{
      Route{"GET", "sockjs/info", sockjs_info, nullptr, nullptr, true},
      Route{"GET", "sockjs/websocket", nullptr, nullptr, plain, true},
      Route{"GET", "sockjs/*/*/websocket", nullptr, nullptr, in_sockjs, true},
  };
  return kRoutes;
}

}  // namespace kinebus::http
