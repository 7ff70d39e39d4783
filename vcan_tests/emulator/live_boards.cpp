#include "vcan_tests/emulator/live_boards.hpp"

#include <poll.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <deque>

#include "protocol/host/socketcan.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kBehind = 1ms;
constexpr BusTime kMostBehind = 50ms;
constexpr int kMailboxes = 4;  // other participants of the bus may have several frames waiting

std::atomic<bool> ended{false};
void on_end(int) {
  ended = true;
}

}  // namespace

std::string run_live(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes,
                     const std::string& interface) {
  SocketCan can;
  if (std::string error = can.open(interface, false); !error.empty()) return error;
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  EmulatedMachine machine(image, nodes, kMailboxes);
  std::fprintf(stderr, "kinebus-emulate: %zu boards on %s\n", nodes.size(), interface.c_str());

  const LocalTime began = monotonic_now();
  BusTime slipped{0}, now{0};
  std::deque<std::pair<BusTime, CanFrame>> incoming;
  std::deque<CanFrame> outgoing;
  const auto run_to = [&](BusTime goal) {
    while (now < goal) {
      while (!incoming.empty() && incoming.front().first <= now && machine.can_send()) {
        machine.send(now, incoming.front().second);
        incoming.pop_front();
      }
      const BusTime next = !incoming.empty() && incoming.front().first > now
                               ? std::min(goal, incoming.front().first)
                               : std::min(goal, now + 40us);
      const bool done = machine.advance(next);
      while (const auto got = machine.receive()) {
        now = std::max(now, got->when);
        if (!got->own) outgoing.push_back(got->frame);
      }
      if (done) now = next;
    }
  };
  while (!ended) {
    pollfd wait{can.fd(), POLLIN, 0};
    poll(&wait, 1, 1);
    while (const auto got = can.receive()) {
      if (got->kind == SocketCan::Kind::kDown) return interface + " went down";
      if (got->kind == SocketCan::Kind::kFrame)
        incoming.emplace_back(got->when - began - slipped, got->frame);
    }
    const BusTime wall = monotonic_now() - began;
    if (wall - slipped - kBehind - now > kMostBehind) slipped = wall - kBehind - now - 1ms;
    run_to(std::min(wall - slipped - kBehind, now + 5ms));
    while (!outgoing.empty() && can.send(outgoing.front()) == SocketCan::Sent::kYes) outgoing.pop_front();
  }
  std::fprintf(stderr, "kinebus-emulate: %.1f s of board time, slipped %.3f s behind the wall clock\n",
               to_seconds(now), to_seconds(slipped));
  return "";
}

}  // namespace kinebus::emulator
