// OctoPrint's REST API: what moves and heats the printer, by button or by lines of G-code.

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "gateway/sessions/http/api.hpp"
#include "gateway/sessions/http/routes.hpp"
#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

using joblink::ClientMessage;

constexpr std::size_t kMostLines = 50;

/// The number under `key`: `otherwise` where there is none; nullopt: it is none.
std::optional<double> number_in(const Json& object, const char* key, double otherwise) {
  const auto found = object.find(key);
  if (found == object.end()) return otherwise;
  return found->is_number() ? std::optional(found->get<double>()) : std::nullopt;
}

/// Commands one after the other, each when the one before is done; answered with 204, or why one is refused.
class Commands : public std::enable_shared_from_this<Commands> {
 public:
  Commands(Session& session, std::vector<ClientMessage> messages)
      : session_(session), messages_(std::move(messages)) {}
  void go_on() {
    if (next_ == messages_.size()) return session_.answer(no_content());
    const ClientMessage& message = messages_[next_++];
    note(true, message.console().line());
    session_.command(message, [self = shared_from_this()](const joblink::Reply& reply) {
      if (reply.has_error()) {
        self->note(false, "!! " + words_of(reply.error()));
        return self->session_.refuse(reply.error());
      }
      self->note(false, reply.console().text());
      self->go_on();
    });
  }

 private:
  void note(bool is_command, const std::string& text) {
    if (!text.empty()) session_.server().note_line(session_.now(), is_command, text);
  }
  Session& session_;
  std::vector<ClientMessage> messages_;
  std::size_t next_ = 0;
};

void carry_out(Session& session, std::vector<ClientMessage> messages) {
  std::make_shared<Commands>(session, std::move(messages))->go_on();
}

void jog(Session& session, const Json& asked) {
  const auto absolute = asked.find("absolute");
  const bool to_place = absolute != asked.end() && absolute->is_boolean() && absolute->get<bool>();
  const joblink::Status status = machine_status(session);
  if (to_place && !status.positions_known())
    return session.refuse(409, "where the tool is is not known: home the machine first");
  ClientMessage message;
  joblink::Pose& delta = *message.mutable_jog()->mutable_delta();
  const joblink::Pose& from = status.tool();
  struct Axis {
    const char* name;
    double at;
    void (joblink::Pose::*set)(double);
  };
  for (const Axis& axis :
       {Axis{"x", from.x_mm(), &joblink::Pose::set_x_mm}, Axis{"y", from.y_mm(), &joblink::Pose::set_y_mm},
        Axis{"z", from.z_mm(), &joblink::Pose::set_z_mm}}) {
    if (!asked.contains(axis.name)) continue;
    const auto value = number_in(asked, axis.name, 0);
    if (!value) return session.refuse(400, "x, y and z are numbers, in mm");
    (delta.*axis.set)(to_place ? *value - axis.at : *value);
  }
  // OctoPrint's is in mm/min; true or nothing: as the printer has it.
  const auto speed = asked.find("speed");
  if (speed != asked.end() && speed->is_number())
    message.mutable_jog()->set_speed_per_s(speed->get<double>() / 60);
  command(session, message);
}

void print_head(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  const std::string what = word_in(*asked, "command");
  ClientMessage message;
  if (what == "jog") return jog(session, *asked);
  if (what == "home") {
    // All axes are homed together: the platform has no axes of its own.
    message.mutable_home();
  } else if (what == "feedrate") {
    const auto factor = number_in(*asked, "factor", std::nan(""));
    if (!factor || !std::isfinite(*factor)) return session.refuse(400, "the factor is a number, in %");
    // 50 is 50 %; 0.5, as old clients have it, too.
    static constexpr double kLargestShare = 2;
    message.mutable_set_override()->set_ratio(*factor <= kLargestShare ? *factor : *factor / 100);
  } else {
    return session.refuse(400, "the commands of the print head are: jog, home, feedrate");
  }
  command(session, message);
}

/// Refused in words where the machine has no such heater.
std::optional<ClientMessage> target_message(Session& session, const joblink::Status& status,
                                            const std::string& heater, const Json& celsius) {
  if (!celsius.is_number()) {
    session.refuse(400, "a target is a number, in degrees Celsius");
    return std::nullopt;
  }
  for (const joblink::Heater& known : status.heaters()) {
    if (octoprint_heater(known) != heater) continue;
    ClientMessage message;
    message.mutable_set_temperature()->set_kind(known.kind());
    message.mutable_set_temperature()->set_index(known.index());
    message.mutable_set_temperature()->set_celsius(celsius.get<double>());
    return message;
  }
  session.refuse(409, "this machine has no heater '" + heater + "'");
  return std::nullopt;
}

/// POST bed and chamber: {"command": "target", "target": 60}
void heater_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  if (word_in(*asked, "command") != "target")
    return session.refuse(400, "the commands of a heater are: target");
  const std::string& heater = session.target().path.back();
  const auto message =
      target_message(session, machine_status(session), heater, asked->value("target", Json()));
  if (message) carry_out(session, {*message});
}

/// "tool1" is T1, where the machine has such a hot end.
std::optional<ClientMessage> select_message(Session& session, const joblink::Status& status,
                                            const std::string& tool) {
  for (const joblink::Heater& known : status.heaters()) {
    if (known.kind() != joblink::HEATER_HOTEND || octoprint_heater(known) != tool) continue;
    ClientMessage message;
    message.mutable_console()->set_line("T" + std::to_string(known.index()));
    return message;
  }
  session.refuse(409, "this machine has no tool '" + tool + "'");
  return std::nullopt;
}

/// {"command": "target", "targets": {"tool0": 210}}, {"command": "extrude", "amount": 5},
/// {"command": "select", "tool": "tool1"}
void tool_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  const std::string what = word_in(*asked, "command");
  std::vector<ClientMessage> messages;
  if (what == "target") {
    const auto targets = asked->find("targets");
    if (targets == asked->end() || !targets->is_object() || targets->size() > kMostLines)
      return session.refuse(400, "'targets' is an object of tools with their temperatures");
    const joblink::Status status = machine_status(session);
    for (const auto& [tool, celsius] : targets->items()) {
      const auto message = target_message(session, status, tool, celsius);
      if (!message) return;
      messages.push_back(*message);
    }
  } else if (what == "extrude") {
    const auto amount = number_in(*asked, "amount", std::nan(""));
    if (!amount || !std::isfinite(*amount)) return session.refuse(400, "the amount is a number, in mm");
    const auto speed = number_in(*asked, "speed", 0);
    if (!speed) return session.refuse(400, "the speed is a number, in mm/min");
    ClientMessage message;
    message.mutable_jog()->mutable_delta()->set_e_mm(*amount);
    message.mutable_jog()->set_speed_per_s(*speed / 60);
    messages.push_back(std::move(message));
  } else if (what == "select") {
    auto message = select_message(session, machine_status(session), word_in(*asked, "tool"));
    if (!message) return;
    messages.push_back(std::move(*message));
  } else {
    return session.refuse(400, "the commands of a tool are: target, extrude, select");
  }
  carry_out(session, std::move(messages));
}

/// {"command": "G28"}, {"commands": ["G91", "G0 X1"]}
void lines(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  Json list = asked->value("commands", Json::array());
  if (asked->contains("command")) list = Json::array({(*asked)["command"]});
  if (!list.is_array() || list.empty() || list.size() > kMostLines)
    return session.refuse(400, "'commands' is a list of 1 to 50 lines of G-code");
  std::vector<ClientMessage> messages;
  for (const Json& line : list) {
    if (!line.is_string()) return session.refuse(400, "a line of G-code is a text");
    ClientMessage message;
    // As an emergency stop it waits for nothing.
    if (line.get<std::string>() == "M112")
      message.mutable_stop();
    else
      message.mutable_console()->set_line(line.get<std::string>());
    messages.push_back(std::move(message));
  }
  carry_out(session, std::move(messages));
}

/// The link to the printer: the gateway's bus, which is there as long as the gateway is.
void connection_command(Session& session, std::string_view body) {
  const auto asked = json_body(session, body);
  if (!asked) return;
  const std::string what = word_in(*asked, "command");
  if (what == "connect" || what == "fake_ack") {
    if (machine_status(session).state() != joblink::STATE_OFF) return session.answer(no_content());
    ClientMessage message;
    message.mutable_bring_up();
    return command(session, message);
  }
  if (what == "disconnect")
    return session.refuse(409,
                          "the gateway keeps its bus: a machine that nobody listens to would not be safe");
  session.refuse(400, "the commands of the connection are: connect, disconnect");
}

void system_commands(Session& session, std::string_view) {
  const Json restart = {{"action", "restart"},
                        {"name", "Restart the gateway"},
                        {"source", "core"},
                        {"confirm", "The gateway ends and begins anew."},
                        {"resource", "/api/system/commands/core/restart"}};
  session.answer(json_answer({{"core", Json::array({restart})}, {"custom", Json::array()}}));
}
void restart(Session& session, std::string_view) {
  ClientMessage message;
  message.mutable_restart_gateway();
  command(session, message);
}

}  // namespace

std::span<const Route> octoprint_control_routes() {
  static constexpr std::array kRoutes{
      Route{"POST", "api/printer/printhead", print_head},
      Route{"POST", "api/printer/tool", tool_command},
      Route{"POST", "api/printer/bed", heater_command},
      Route{"POST", "api/printer/chamber", heater_command},
      Route{"POST", "api/printer/command", lines},
      Route{"POST", "api/connection", connection_command},
      Route{"GET", "api/system/commands", system_commands},
      Route{"POST", "api/system/commands/core/restart", restart},
  };
  return kRoutes;
}

}  // namespace kinebus::http
