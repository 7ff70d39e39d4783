// Moonraker's API: the printer, its objects, commands and lines of G-code.

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <utility>

#include "gateway/sessions/http/moonraker/moonraker.hpp"

namespace kinebus::http {
namespace {

using joblink::ClientMessage;

void printer_info(const Call& call) {
  const joblink::Status status = machine_status(call.caller);
  call.done({{"state", klippy_state(status)},
             {"state_message", status.doing()},
             {"hostname", machine_info(call.caller).name()},
             {"software_version", "kinebus-" + call.caller.server().link().options().version},
             {"app", "Kinebus"},
             {"cpu_info", ""}});
}

void list_objects(const Call& call) {
  call.done({{"objects", moonraker_object_names(call.caller)}});
}

/// The time that belongs to what is told.
double event_time(Caller& caller) {
  return to_seconds(caller.now());
}

void query_objects(const Call& call) {
  const auto objects = call.params.find("objects");
  if (objects == call.params.end() || !objects->is_object())
    return call.fail(400, "the parameter 'objects' names the objects that are asked for");
  call.done({{"eventtime", event_time(call.caller)}, {"status", moonraker_objects(call.caller, *objects)}});
}

void subscribe_objects(const Call& call) {
  // By a request for a websocket, whose number its client was told.
  const auto& sockets = call.caller.server().moonraker_sockets();
  const double number = call.number("connection_id", 0);
  const auto named = std::find_if(sockets.begin(), sockets.end(), [&](const auto& socket) {
    return static_cast<double>(socket.first) == number;
  });
  MoonrakerDialect* const socket = named != sockets.end() ? named->second : call.socket;
  if (socket == nullptr)
    return call.fail(400, "only a websocket can be told of changes: 'connection_id' is its number");
  const auto objects = call.params.find("objects");
  if (objects == call.params.end() || !objects->is_object())
    return call.fail(400, "the parameter 'objects' names the objects that are asked for");
  subscribe(*socket, *objects);
  call.done({{"eventtime", event_time(call.caller)}, {"status", moonraker_objects(call.caller, *objects)}});
}

void emergency_stop(const Call& call) {
  ClientMessage message;
  message.mutable_stop();
  call.command(message);
}
void restart(const Call& call) {
  ClientMessage message;
  message.mutable_clear();
  call.command(message);
}
void pause_print(const Call& call) {
  call.command(pause_message(Pausing::kPause, false));
}
void resume_print(const Call& call) {
  call.command(pause_message(Pausing::kResume, true));
}
void cancel_print(const Call& call) {
  ClientMessage message;
  message.mutable_cancel();
  call.command(message);
}

void start_file(const Call& call, const std::string& name) {
  begin_job(call.caller, name, [call](const joblink::Problem& wrong) {
    if (!wrong.rule().empty()) return call.fail(400, words_of(wrong));
    call.done("ok");
  });
}
void start_print(const Call& call) {
  start_file(call, call.text("filename"));
}

/// Home switches by the joints that they are of, as the nodes report them.
void endstops(const Call& call) {
  const joblink::Status status = machine_status(call.caller);
  Json switches = Json::object();
  const joblink::MachineInfo info = machine_info(call.caller);
  for (const joblink::Joint& joint : info.joints())
    for (const joblink::NodeStatus& node : status.nodes())
      if (joint.home_switch() > 0 && node.id() == joint.node())
        switches[joint.name()] =
            (node.inputs() >> (joint.home_switch() - 1) & 1U) != 0 ? "TRIGGERED" : "open";
  call.done(std::move(switches));
}

/// A line as Klipper's clients write commands: a word, and NAME=VALUE.
struct KlipperLine {
  std::string word;
  std::map<std::string, std::string> values;
};
KlipperLine klipper_line(std::string_view line) {
  KlipperLine read;
  while (!line.empty()) {
    const std::size_t from = std::min(line.find_first_not_of(" \t"), line.size());
    line.remove_prefix(from);
    const bool quoted = line.find("=\"") < line.find_first_of(" \t");
    const std::size_t end = quoted ? std::min(line.find('"', line.find("=\"") + 2), line.size())
                                   : std::min(line.find_first_of(" \t"), line.size());
    std::string word(line.substr(0, end));
    line.remove_prefix(std::min(end + (quoted ? 1U : 0U), line.size()));
    std::string name = word.substr(0, word.find('='));
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
    if (read.word.empty())
      read.word = name;
    else if (word.size() > name.size())
      read.values[name] = word.substr(name.size() + (quoted ? 2 : 1));
  }
  return read;
}

std::optional<ClientMessage> temperature_message(Caller& caller, const std::string& heater, double celsius) {
  const joblink::Status status = machine_status(caller);
  for (const joblink::Heater& known : status.heaters()) {
    const bool hotend = known.kind() == joblink::HEATER_HOTEND && known.index() == 0 && heater == "extruder";
    const bool other = known.kind() == joblink::HEATER_HOTEND && known.index() > 0 &&
                       heater == "extruder" + std::to_string(known.index());
    const bool bed = known.kind() == joblink::HEATER_BED && known.index() == 0 && heater == "heater_bed";
    if (!hotend && !other && !bed && heater != known.name()) continue;
    ClientMessage message;
    message.mutable_set_temperature()->set_kind(known.kind());
    message.mutable_set_temperature()->set_index(known.index());
    message.mutable_set_temperature()->set_celsius(celsius);
    return message;
  }
  return std::nullopt;
}

/// The lines of one script, each when the one before is done.
class Script : public std::enable_shared_from_this<Script> {
 public:
  Script(Call call, std::string text) : call_(std::move(call)), rest_(std::move(text)) {}
  void go_on() {
    while (true) {
      if (at_ >= rest_.size()) return call_.done("ok");
      const std::size_t end = std::min(rest_.find('\n', at_), rest_.size());
      const std::string line = rest_.substr(at_, end - at_);
      at_ = end + 1;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      return carry_out(line);
    }
  }

 private:
  void carry_out(const std::string& line) {
    call_.caller.server().note_line(call_.caller.now(), true, line);
    const KlipperLine said = klipper_line(line);
    ClientMessage message;
    if (said.word == "PAUSE") {
      message.mutable_hold();
    } else if (said.word == "RESUME") {
      message.mutable_resume();
    } else if (said.word == "CANCEL_PRINT") {
      message.mutable_cancel();
    } else if (said.word == "M112") {
      message.mutable_stop();
    } else if (said.word == "FIRMWARE_RESTART" || said.word == "RESTART") {
      message.mutable_clear();
    } else if (said.word == "EXCLUDE_OBJECT" && said.values.contains("NAME")) {
      message.mutable_exclude_object()->set_name(value(said, "NAME"));
    } else if (said.word == "SDCARD_PRINT_FILE") {
      return start_file(call_, value(said, "FILENAME"));
    } else if (said.word == "TURN_OFF_HEATERS") {
      std::string lines;
      const joblink::Status status = machine_status(call_.caller);
      for (const joblink::Heater& heater : status.heaters())
        lines += "SET_HEATER_TEMPERATURE HEATER=\"" + heater.name() + "\" TARGET=0\n";
      rest_.insert(std::min(at_, rest_.size()), "\n" + lines);
      return go_on();
    } else if (said.word == "SET_HEATER_TEMPERATURE") {
      const std::string target = said.values.contains("TARGET") ? value(said, "TARGET") : "0";
      double celsius = 0;
      const auto read = std::from_chars(target.data(), target.data() + target.size(), celsius);
      const auto set = temperature_message(call_.caller, value(said, "HEATER"), celsius);
      if (read.ec != std::errc() || read.ptr != target.data() + target.size() || !set)
        return refuse("SET_HEATER_TEMPERATURE names a heater of this machine and a temperature");
      message = *set;
    } else {
      message.mutable_console()->set_line(line);
    }
    call_.caller.command(message, [self = shared_from_this(), line](const joblink::Reply& reply) {
      if (reply.has_error()) return self->refuse(line + ": " + words_of(reply.error()));
      if (!reply.console().text().empty()) self->note(reply.console().text());
      self->go_on();
    });
  }
  void note(const std::string& answer) { call_.caller.server().note_line(call_.caller.now(), false, answer); }
  void refuse(std::string why) {
    note("!! " + why);
    call_.fail(400, std::move(why));
  }
  static std::string value(const KlipperLine& line, const char* name) {
    const auto found = line.values.find(name);
    return found != line.values.end() ? found->second : std::string();
  }

  Call call_;
  std::string rest_;
  std::size_t at_ = 0;
};

void run_script(const Call& call) {
  static constexpr std::size_t kMaxScript = 4096;
  std::string text = call.text("script");
  if (text.empty() || text.size() > kMaxScript)
    return call.fail(400, "the parameter 'script' is 1 to 4096 bytes of G-code");
  std::make_shared<Script>(call, std::move(text))->go_on();
}

void gcode_help(const Call& call) {
  const Json objects = moonraker_objects(call.caller, {{"gcode", nullptr}});
  Json words = Json::object();
  for (const auto& [name, what] : objects["gcode"]["commands"].items()) words[name] = what["help"];
  call.done(std::move(words));
}

}  // namespace

std::span<const Method> moonraker_printer_methods() {
  static constexpr std::array kMethods{
      Method{"printer.info", "GET", "printer/info", printer_info},
      Method{"printer.objects.list", "GET", "printer/objects/list", list_objects},
      Method{"printer.objects.query", "GET", "printer/objects/query", query_objects},
      Method{"printer.objects.query", "POST", "printer/objects/query", query_objects},
      Method{"printer.objects.subscribe", "POST", "printer/objects/subscribe", subscribe_objects},
      Method{"printer.query_endstops.status", "GET", "printer/query_endstops/status", endstops},
      Method{"printer.gcode.script", "POST", "printer/gcode/script", run_script},
      Method{"printer.gcode.help", "GET", "printer/gcode/help", gcode_help},
      Method{"printer.print.start", "POST", "printer/print/start", start_print},
      Method{"printer.print.pause", "POST", "printer/print/pause", pause_print},
      Method{"printer.print.resume", "POST", "printer/print/resume", resume_print},
      Method{"printer.print.cancel", "POST", "printer/print/cancel", cancel_print},
      Method{"printer.emergency_stop", "POST", "printer/emergency_stop", emergency_stop},
      Method{"printer.restart", "POST", "printer/restart", restart},
      Method{"printer.firmware_restart", "POST", "printer/firmware_restart", restart},
  };
  return kMethods;
}

}  // namespace kinebus::http
