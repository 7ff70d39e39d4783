#include "gateway/sessions/machine_requests.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "gateway/sessions/console.hpp"
#include "gateway/sessions/job_link_session.hpp"
#include "gateway/sessions/messages.hpp"

namespace kinebus {
namespace {
using joblink::ClientMessage;
using joblink::Reply;
constexpr double kDegrees = 57.29577951308232;
}  // namespace

bool MachineRequests::take(const Asker& asker, const ClientMessage& message) {
  if (take_free(asker, message) || take_control_request(asker, message)) return true;
  if (message.has_console() && !needs_control(message.console().line())) {
    console(asker, message.console().line());
    return true;
  }
  if (message.request_case() < ClientMessage::kStartJob || message.request_case() > ClientMessage::kConsole)
    return false;
  if (!server_.control_.may_command(session_.client())) {
    server_.refuse(asker, server_.no_control());
    return true;
  }
  if (message.has_start_job()) {
    start(asker, message.start_job().name());
  } else if (message.has_console()) {
    console(asker, message.console().line());
  } else if (const auto done = carry_out(message); done) {
    server_.answer(asker, {});
  } else {
    server_.refuse(asker, problem(done.error()));
  }
  return true;
}

/// What everyone may ask at any time.
bool MachineRequests::take_free(const Asker& asker, const ClientMessage& message) {
  if (message.has_stop()) {
    static_cast<void>(server_.gateway_.stop());
    server_.answer(asker, {});
    return true;
  }
  Reply reply;
  if (message.has_get_status()) {
    *reply.mutable_status() = server_.status();
    server_.answer(asker, std::move(reply));
    return true;
  }
  if (message.has_get_machine()) {
    *reply.mutable_machine() = server_.machine_info_;
    server_.answer(asker, std::move(reply));
    return true;
  }
  if (message.has_get_events()) {
    const joblink::GetEvents& request = message.get_events();
    const std::size_t max = request.max_events() == 0 ? 200 : request.max_events();
    reply.mutable_events();
    for (const joblink::Event& event : server_.events_.list(request.after_id(), max, request.alarms_only()))
      *reply.mutable_events()->add_events() = event;
    server_.answer(asker, std::move(reply));
    return true;
  }
  return false;
}

bool MachineRequests::take_control_request(const Asker& asker, const ClientMessage& message) {
  Control& control = server_.control_;
  if (message.has_take_control()) {
    if (control.take(session_.client(), message.take_control().force()))
      server_.answer(asker, {});
    else
      server_.refuse(asker, server_.no_control());
    return true;
  }
  if (message.has_release_control()) {
    control.release(session_.client());
    server_.answer(asker, {});
    return true;
  }
  if (message.has_hand_over()) {
    if (control.hand_over(session_.client(), message.hand_over().client_id()))
      server_.answer(asker, {});
    else
      server_.refuse(
          asker, problem(joblink::ERROR_BAD_VALUE, "client_id",
                         say("control is handed over by the client that has it, to a client that is here")));
    return true;
  }
  return false;
}

Result<void, Refusal> MachineRequests::carry_out(const ClientMessage& message) {
  Gateway& gateway = server_.gateway_;
  switch (message.request_case()) {
    case ClientMessage::kHold:
      return gateway.hold();
    case ClientMessage::kResume:
      return gateway.resume();
    case ClientMessage::kCancel:
      return gateway.cancel();
    case ClientMessage::kClear:
      return gateway.clear();
    case ClientMessage::kBringUp:
      return gateway.bring_up();
    case ClientMessage::kHome:
      return gateway.home();
    case ClientMessage::kReference:
      return gateway.go_to_reference();
    case ClientMessage::kJog:
      return gateway.jog({pose_of(message.jog().delta()), message.jog().speed_per_s()});
    case ClientMessage::kSetOverride:
      return gateway.set_feed_override(message.set_override().ratio());
    case ClientMessage::kSetTemperature:
      return gateway.set_temperature(message.set_temperature().bed(), message.set_temperature().celsius());
    case ClientMessage::kSetFan: {
      const double ratio = message.set_fan().ratio();
      if (!(ratio >= 0 && ratio <= 1)) return Error<Refusal>(Refusal{say("a fan's ratio is 0 to 1")});
      char line[32];
      std::snprintf(line, sizeof line, "M106 S%.2f", ratio * 255);
      const auto done = gateway.text_line(line);
      if (!done) return Error<Refusal>(done.error());
      return {};
    }
    case ClientMessage::kMotorsOff:
      return gateway.motors_off();
    case ClientMessage::kSetWorkOffset:
      return set_work_offset(message.set_work_offset());
    default:
      return Error<Refusal>(Refusal{say("this gateway does not know the request")});
  }
}

/// As a line of the console: one place knows what a work offset is.
Result<void, Refusal> MachineRequests::set_work_offset(const joblink::SetWorkOffset& request) {
  if (request.system() < 1 || request.system() > 9)
    return Error<Refusal>(Refusal{say("a work coordinate system is 1 (G54) to 9 (G59.3)")});
  const PoseVector offset = pose_of(request.offset());
  if (!std::all_of(offset.begin(), offset.end(),
                   [](double v) { return std::isfinite(v) && std::abs(v) < 1e6; }))
    return Error<Refusal>(Refusal{say("a work offset needs numbers below 1000 m")});
  char line[256];
  std::snprintf(line, sizeof line, "G10 L%d P%u X%.6f Y%.6f Z%.6f A%.6f C%.6f", request.here() ? 20 : 2,
                request.system(), offset[kX], offset[kY], offset[kZ], offset[kA] * kDegrees,
                offset[kC] * kDegrees);
  return run_line(server_.gateway_, line);
}

void MachineRequests::start(const Asker& asker, const std::string& name) {
  using Opened = Result<std::unique_ptr<ByteSource>, StoreError>;
  server_.worker_.ask([&store = server_.store_, name] { return store.open_job(name); },
                      [&server = server_, asker, name](Opened source) {
                        if (!source) return server.refuse(asker, problem(source.error()));
                        if (const auto begun = server.gateway_.run(std::move(*source), name); !begun)
                          return server.refuse(asker, problem(begun.error()));
                        server.job_started(name);
                        server.answer(asker, {});
                      });
}

void MachineRequests::console(const Asker& asker, const std::string& line) {
  const auto text = console_line(server_.gateway_, line);
  if (!text) return server_.refuse(asker, problem(text.error()));
  Reply reply;
  reply.mutable_console()->set_text(*text);
  server_.answer(asker, std::move(reply));
}

}  // namespace kinebus
