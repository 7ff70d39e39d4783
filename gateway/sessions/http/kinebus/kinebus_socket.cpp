// Kinebus's own API over a websocket: ClientMessage and ServerMessage of kinebus.proto as JSON. The first
// message is a hello, whose token is a key unless the request showed it or none is needed.

#include <algorithm>
#include <utility>

#include "gateway/sessions/http/kinebus/kinebus_api.hpp"
#include "gateway/sessions/http/kinebus/message_json.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/version.hpp"

namespace kinebus::http {
namespace {

using joblink::ClientMessage;
using joblink::Reply;

/// The daemon's loop makes and sends all statuses: as often as an eye needs.
constexpr double kMaxHz = 20;

class KinebusDialect : public Dialect {
 public:
  explicit KinebusDialect(Socket& socket) : socket_(socket) {}

  void on_text(std::string_view text) override {
    ClientMessage message;
    const auto read = from_json(text, message);
    // Whose it was is not known.
    if (!read) return refuse(0, problem(joblink::ERROR_NOT_UNDERSTOOD, {}, Sentence::verbatim(read.error())));
    const std::uint32_t number = message.request_id();
    if (message.has_hello()) return hello(number, message.hello());
    if (!socket_.is_in())
      return refuse(number, problem(joblink::ERROR_NOT_ALLOWED, {}, say("say hello first")));
    if (message.has_ping()) return reply({}, number);
    if (message.has_watch()) return watch(number, message.watch());
    if (message.has_get_status()) return status(number);
    socket_.command(message, [this, number](const Reply& answer) { reply(answer, number); });
  }

  void on_room(LocalTime now) override {
    const EventLog& events = socket_.server().link().events();
    while (watches_events_ && socket_.has_room()) {
      const joblink::Event* event = events.after(told_event_);
      if (event == nullptr) break;
      told_event_ = event->id();
      tell("event", to_json(*event));
    }
    if (now < next_status_ || !socket_.has_room()) return;
    next_status_ = std::max(next_status_ + status_period_, now);
    tell("status", socket_.server().recent_status_json(now));
  }

  LocalTime next_news() const override {
    if (watches_events_ && socket_.server().link().events().newest() > told_event_) return LocalTime{0};
    return next_status_;
  }

 private:
  void hello(std::uint32_t number, const joblink::Hello& hello) {
    const auto& options = socket_.server().link().options();
    if (hello.version_major() != joblink::kVersionMajor)
      return refuse(number,
                    problem(joblink::ERROR_VERSION, "version",
                            say("the gateway and the client speak different versions of the job link"),
                            say("version %1", joblink::kVersionMajor)));
    const User* const user = socket_.server().users().by_key(hello.token());
    if (!socket_.is_in() && user == nullptr) {
      refuse(number, problem(joblink::ERROR_NOT_ALLOWED, "token", say("the token is wrong"),
                             say("the token that is set on the gateway")));
      return socket_.end(CloseCode::kPolicy, "the key is wrong");
    }
    socket_.let_in(user != nullptr ? user->visitor : socket_.visitor(), hello.client_name());
    ClientMessage ask;
    ask.mutable_get_machine();
    Reply answer;
    joblink::HelloReply& said = *answer.mutable_hello();
    said.set_version_major(joblink::kVersionMajor);
    said.set_version_minor(joblink::kVersionMinor);
    said.set_gateway_version(options.version);
    said.set_gateway_id(options.gateway_id);
    said.set_machine_name(socket_.ask_now(ask).machine().name());
    said.set_client_id(socket_.client());
    said.set_role(word_of(socket_.role()));
    said.set_event_id(socket_.server().link().events().newest());
    reply(std::move(answer), number);
  }

  void watch(std::uint32_t number, const joblink::Watch& watch) {
    const double hz = watch.status_hz();
    status_period_ =
        hz > 0 ? LocalTime{static_cast<std::int64_t>(1e9 / std::clamp(hz, 0.1, kMaxHz))} : LocalTime{0};
    next_status_ = hz > 0 ? socket_.now() : LocalTime::max();
    if (watch.events() && !watches_events_) told_event_ = socket_.server().link().events().newest();
    watches_events_ = watch.events();
    reply({}, number);
  }

  /// What a Reply of it is as JSON, but that the status is written once for all who ask.
  void status(std::uint32_t number) {
    tell("reply",
         "{\"request_id\":" + std::to_string(number) + ",\"status\":" + socket_.server().status_json() + "}");
  }
  void tell(const char* what, const std::string& json) {
    socket_.say(std::string("{\"").append(what).append("\":").append(json).append("}"));
  }
  void reply(Reply answer, std::uint32_t number) {
    answer.set_request_id(number);
    tell("reply", to_json(answer));
  }
  void refuse(std::uint32_t number, joblink::Problem wrong) {
    Reply answer;
    *answer.mutable_error() = std::move(wrong);
    reply(std::move(answer), number);
  }

  Socket& socket_;
  LocalTime status_period_{0}, next_status_ = LocalTime::max();
  bool watches_events_ = false;
  std::uint64_t told_event_ = 0;
};

}  // namespace

std::unique_ptr<Dialect> kinebus_dialect(Socket& socket) {
  return std::make_unique<KinebusDialect>(socket);
}

}  // namespace kinebus::http
