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
constexpr BusTime kPiece = 1ms;  // of the boards' time, between looks at the interface
constexpr int kMailboxes = 4;    // other participants of the bus may have several frames waiting

std::atomic<bool> ended{false}, power_lost{false};
void on_end(int) {
  ended = true;
}
void on_power_loss(int) {
  power_lost = true;
}

}  // namespace

std::string run_live(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes,
                     const std::string& interface, BusTime most_behind) {
  SocketCan can;
  if (std::string error = can.open(interface, false); !error.empty()) return error;
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  std::signal(SIGUSR1, on_power_loss);
  EmulatedMachine machine(image, nodes, kMailboxes);
  std::fprintf(stderr, "kinebus-emulate: %zu boards on %s\n", nodes.size(), interface.c_str());

  const LocalTime began = monotonic_now();
  BusTime slipped{0}, now{0}, goal{0};
  std::deque<std::pair<BusTime, CanFrame>> incoming;
  std::deque<CanFrame> outgoing;
  const auto run_to = [&](BusTime end) {
    while (now < end) {
      while (!incoming.empty() && incoming.front().first <= now && machine.can_send()) {
        machine.send(now, incoming.front().second);
        incoming.pop_front();
      }
      const BusTime next = !incoming.empty() && incoming.front().first > now
                               ? std::min(end, incoming.front().first)
                               : std::min(end, now + 40us);
      const bool done = machine.advance(next);
      while (const auto got = machine.receive()) {
        now = std::max(now, got->when);
        if (!got->own) outgoing.push_back(got->frame);
      }
      if (done) now = next;
    }
  };
  while (!ended) {
    if (power_lost.exchange(false)) {
      for (int node = 0; node < machine.node_count(); ++node) machine.power_cycle(node);
      outgoing.clear();
      std::fprintf(stderr, "kinebus-emulate: power off and on again\n");
    }
    pollfd wait{can.fd(), POLLIN, 0};
    poll(&wait, 1, now < goal ? 0 : 1);
    const BusTime behind = monotonic_now() - began - slipped - kBehind - now;
    if (behind > most_behind + kPiece) slipped += behind - kPiece;
    while (const auto got = can.receive()) {
      if (got->kind == SocketCan::Kind::kDown) return interface + " went down";
      if (got->kind == SocketCan::Kind::kFrame)
        incoming.emplace_back(got->when - began - slipped, got->frame);
    }
    goal = monotonic_now() - began - slipped - kBehind;
    run_to(std::min(goal, now + kPiece));
    while (!outgoing.empty() && can.send(outgoing.front()) == SocketCan::Sent::kYes) outgoing.pop_front();
  }
  std::fprintf(stderr, "kinebus-emulate: %.1f s of board time, slipped %.3f s behind the wall clock\n",
               to_seconds(now), to_seconds(slipped));
  return "";
}

}  // namespace kinebus::emulator
