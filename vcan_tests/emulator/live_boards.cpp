#include "vcan_tests/emulator/live_boards.hpp"

#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <deque>
#include <optional>

#include "vcan_tests/emulator/lab_clock.hpp"
#include "vcan_tests/emulator/workbench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kBehind = 1ms;
constexpr BusTime kPiece = 250us;  // of the boards' time, between looks at the interface
constexpr int kMailboxes = 4;      // other participants of the bus may have several frames waiting

std::atomic<bool> ended{false};
void on_end(int) {
  ended = true;
}

}  // namespace

std::string run_live(const ElfImage& image, const std::vector<EmulatedNodeOptions>& nodes, CanPort& bus,
                     const LiveOptions& options) {
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  EmulatedMachine machine(image, nodes, kMailboxes);
  std::optional<Workbench> bench;
  if (!options.bench_folder.empty()) bench.emplace(machine, options.bench_folder);
  LocalTime began = monotonic_now();
  BusTime slipped{0}, now{0}, goal{0};
  std::deque<std::pair<BusTime, CanFrame>> incoming;
  std::deque<CanFrame> outgoing;
  const LabClock clock;
  bool spoken_to = false;  // before, a guest starts up and measures its clocks
  const auto goes_on = [&] { return !ended && !bus.closed(); };
  const auto has_power = [&] {
    return options.power_file.empty() || ::access(options.power_file.c_str(), F_OK) == 0;
  };
  // Without power nothing is heard, and the boards' time stands.
  const auto wait_for_power = [&] {
    std::fprintf(stderr, "kinebus-emulate: power off\n");
    incoming.clear();
    outgoing.clear();
    clock.go_on();
    const LocalTime since = monotonic_now();
    while (goes_on() && !has_power()) {
      pollfd wait = bus.waits_for(true);
      poll(&wait, 1, 1);
      while (bus.receive()) {
      }
    }
    began += monotonic_now() - since;
  };
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
    if (bench) bench->look(now);
  };
  if (!has_power()) wait_for_power();
  if (goes_on()) std::fprintf(stderr, "kinebus-emulate: power on; %zu boards\n", nodes.size());
  while (goes_on()) {
    if (!has_power()) {
      wait_for_power();
      if (!goes_on()) break;
      for (int node = 0; node < machine.node_count(); ++node) machine.power_cycle(node);
      std::fprintf(stderr, "kinebus-emulate: power on\n");
    }
    if (spoken_to) clock.wait_at(began + slipped + now + kBehind + kPiece);
    const bool waits = spoken_to && clock.guest_is_behind(began + slipped + now);
    if (waits || now >= goal) clock.wait(bus.waits_for(true));
    const BusTime behind = monotonic_now() - began - slipped - kBehind - now;
    if (behind > options.most_behind + kPiece) slipped += behind - kPiece;
    while (const auto got = bus.receive()) {
      incoming.emplace_back(got->when - began - slipped, got->frame);
      spoken_to = true;
    }
    goal = waits ? now : monotonic_now() - began - slipped - kBehind;
    run_to(std::min(goal, now + kPiece));
    while (!outgoing.empty() && bus.send(outgoing.front())) outgoing.pop_front();
    bus.flush();
  }
  std::fprintf(stderr, "kinebus-emulate: %.1f s of board time, slipped %.3f s behind the wall clock\n",
               to_seconds(now), to_seconds(slipped));
  return bus.trouble();
}

}  // namespace kinebus::emulator
