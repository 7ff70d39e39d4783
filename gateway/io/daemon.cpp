#include "gateway/io/daemon.hpp"

#include <spdlog/spdlog.h>
#include <sys/epoll.h>

#include <algorithm>

#include "gateway/io/frame_exchange.hpp"
#include "gateway/sessions/messages.hpp"
#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {
constexpr LocalTime kQuitWithin = std::chrono::seconds{2};
// Half of the WatchdogSec in kinebusd.service.
constexpr LocalTime kWatchdogPeriod = std::chrono::seconds{1};

// A check of a job moves nothing either.
bool may_leave(MachineState state) {
  return at_rest(state) || state == MachineState::kChecking;
}

void log_event(const MachineEvent& event) {
  const std::string words = shown(event.words);
  switch (event.kind) {
    case MachineEvent::Kind::kAlarm:
      spdlog::error("alarm 0x{:04X}: {}: {}", event.code, words, shown(event.advice));
      break;
    case MachineEvent::Kind::kProblem:
      spdlog::warn("line {}: {}", event.line, words);
      break;
    case MachineEvent::Kind::kState:
      spdlog::info("state {}: {}", to_string(event.state), words);
      break;
    default:
      spdlog::info("{}", words);
  }
}
}  // namespace

Daemon::Daemon(EventLoop& loop, BusPort& bus, Gateway& gateway, const ServiceManager& manager)
    : loop_(loop), bus_(bus), gateway_(gateway), manager_(manager) {
  if (bus_.fd() >= 0) loop_.watch(bus_.fd(), EPOLLIN, [](std::uint32_t) {});
}

void Daemon::report_events() {
  while (auto event = gateway_.next_event()) {
    log_event(*event);
    for (DaemonPart* part : parts_) part->on_event(*event);
  }
}

LocalTime Daemon::next_deadline() const {
  LocalTime next = std::min(gateway_.next_deadline(), bus_.next_deadline());
  for (const DaemonPart* part : parts_) next = std::min(next, part->next_deadline());
  return next;
}

void Daemon::run(const volatile std::sig_atomic_t* quit, bool& anew) {
  bool leaves = false;  // its last turn: answers go out
  LocalTime next_watchdog{0};
  LocalTime quit_at = LocalTime::max();
  for (;;) {
    if (const auto stall = stalls_.wakes(loop_.now())) {
      gateway_.on_stall(loop_.now(), stall->length, stall->why);
      for (DaemonPart* part : parts_) part->on_stall(loop_.now(), stall->length);
    }
    exchange_frames(loop_, bus_, gateway_);
    report_events();
    const LocalTime now = loop_.now();
    for (DaemonPart* part : parts_) part->on_time(now);
    // The first command that comes in between counts for more.
    if (anew && !at_rest(gateway_.state())) anew = leaves = false;
    if (leaves) return;
    leaves = anew;
    if (now >= next_watchdog) {
      manager_.tell("WATCHDOG=1");
      next_watchdog = now + kWatchdogPeriod;
    }
    if (*quit != 0 && quit_at == LocalTime::max()) {
      spdlog::info("asked to end: bringing the machine to rest on its path");
      manager_.tell("STOPPING=1");
      quit_at = now + kQuitWithin;
      if (!may_leave(gateway_.state()))
        if (const auto held = gateway_.carry_out(command::Hold{}); !held)
          static_cast<void>(gateway_.carry_out(command::Stop{}));
    }
    if (*quit != 0 && (may_leave(gateway_.state()) || now >= quit_at)) return;
    const LocalTime until = leaves ? now
                                   : std::min({next_deadline(), next_watchdog, quit_at,
                                               *quit != 0 ? now + BusTime{1'000'000} : quit_at});
    stalls_.sleeps(loop_.now(), until);
    loop_.wait(until);
  }
}

}  // namespace kinebus
