#include "gateway/sessions/machine_requests.hpp"

#include <utility>

#include "gateway/sessions/command_requests.hpp"
#include "gateway/sessions/console.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {
using joblink::ClientMessage;
using joblink::Reply;
}  // namespace

bool MachineRequests::take(const Asker& asker, const ClientMessage& message) {
  if (take_free(asker, message) || take_control_request(asker, message)) return true;
  if (message.has_console() && !needs_control(message.console().line())) {
    console(asker, message.console().line());
    return true;
  }
  if (message.request_case() < ClientMessage::kMoveProbePin ||
      message.request_case() > ClientMessage::kTuneHeater)
    return false;
  if (!server_.control_.may_command(requester_.client())) {
    server_.refuse(asker, server_.no_control());
    return true;
  }
  if (message.has_start_job()) {
    start(asker, message.start_job().name());
  } else if (message.has_console()) {
    console(asker, message.console().line());
  } else {
    carry_out(asker, message);
  }
  return true;
}

/// What everyone may ask at any time.
bool MachineRequests::take_free(const Asker& asker, const ClientMessage& message) {
  if (message.has_stop()) {
    command::Stop stop;
    stop.heaters_off = requester_.stop_cuts_heat();
    if (const auto done = server_.gateway_.carry_out(std::move(stop)); done)
      server_.answer(asker, {});
    else
      server_.refuse(asker, problem(done.error()));
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
  if (message.has_get_heat_course()) {
    *reply.mutable_heat_course() = server_.heat_.message();
    server_.answer(asker, std::move(reply));
    return true;
  }
  if (message.has_get_events()) {
    const joblink::GetEvents& request = message.get_events();
    const std::size_t max = request.max_events() == 0 ? 200 : request.max_events();
    joblink::EventList& list = *reply.mutable_events();
    ListRoom room;
    server_.events_.each(request.after_id(), request.alarms_only(), [&](const joblink::Event& event) {
      if (static_cast<std::size_t>(list.events_size()) >= max) return false;
      list.set_more(!room.take(event));
      if (!list.more()) *list.add_events() = event;
      return !list.more();
    });
    server_.answer(asker, std::move(reply));
    return true;
  }
  return false;
}

bool MachineRequests::take_control_request(const Asker& asker, const ClientMessage& message) {
  Control& control = server_.control_;
  if (message.has_take_control()) {
    if (control.take(requester_.client(), message.take_control().force()))
      server_.answer(asker, {});
    else
      server_.refuse(asker, server_.no_control());
    return true;
  }
  if (message.has_release_control()) {
    control.release(requester_.client());
    server_.answer(asker, {});
    return true;
  }
  if (message.has_hand_over()) {
    if (control.hand_over(requester_.client(), message.hand_over().client_id()))
      server_.answer(asker, {});
    else
      server_.refuse(
          asker, problem(joblink::ERROR_BAD_VALUE, "client_id",
                         say("control is handed over by the client that has it, to a client that is here")));
    return true;
  }
  return false;
}

void MachineRequests::carry_out(const Asker& asker, const ClientMessage& message) {
  auto command = command_of(message);
  if (!command)
    return server_.refuse(
        asker, problem(joblink::ERROR_NOT_UNDERSTOOD, {}, say("this gateway does not know the request")));
  const auto done = server_.gateway_.carry_out(std::move(*command));
  if (!done) return server_.refuse(asker, problem(done.error()));
  server_.answer(asker, {});
}

void MachineRequests::start(const Asker& asker, const std::string& name) {
  server_.worker_.ask(
      [&store = server_.store_, name, unix_s = server_.unix_s(server_.latest_)] {
        return store.begin_job(name, unix_s);
      },
      [&server = server_, asker, name](Result<BegunJob, StoreError> job) {
        if (!job) return server.refuse(asker, problem(job.error()));
        if (const auto begun = server.gateway_.carry_out(command::Run{std::move(job->text), name}); !begun) {
          server.job_refused(name, job->run, begun.error().words);
          return server.refuse(asker, problem(begun.error()));
        }
        server.job_started(name, job->run);
        server.answer(asker, {});
      });
}

void MachineRequests::console(const Asker& asker, const std::string& line) {
  const auto text = console_line(server_.gateway_, line);
  if (!text) return server_.refuse(asker, problem(text.error()));
  Reply reply;
  reply.mutable_console()->set_text(shown_lines(*text, ListRoom::kBytes));
  server_.answer(asker, std::move(reply));
}

}  // namespace kinebus
