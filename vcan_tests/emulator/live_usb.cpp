#include "vcan_tests/emulator/live_usb.hpp"

#include <dlfcn.h>
#include <poll.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <optional>

#include "protocol/host/socketcan.hpp"
#include "vcan_tests/emulator/usb_cable.hpp"
#include "vcan_tests/emulator/workbench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

// Of the wall clock, or of the board: the other waits.
constexpr BusTime kAhead = 2ms;

std::atomic<bool> ended{false};
void on_end(int) {
  ended = true;
}

/// Where both ends' clock is a lab's (tools/vm/run --slow), it waits for the board.
class LabClock {
 public:
  LabClock() : hold_(reinterpret_cast<void (*)(long long)>(::dlsym(RTLD_DEFAULT, "kinebus_hold_clock"))) {}
  ~LabClock() { until(LocalTime{0}); }
  LabClock(const LabClock&) = delete;
  LabClock& operator=(const LabClock&) = delete;
  void until(LocalTime at) const {
    if (hold_ != nullptr) hold_(at.count());
  }

 private:
  void (*hold_)(long long);
};

/// Waits for the computer, at most a millisecond.
void wait_for(const UsbLine& line) {
  pollfd wait{line.fd(), POLLIN, 0};
  poll(&wait, 1, 1);
}

}  // namespace

std::string run_usb(const ElfImage& image, const std::vector<EmulatedNodeOptions>& boards, UsbLine& line,
                    const LiveOptions& options) {
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  EmulatedMachine machine(image, boards);
  machine.set_gateway_on_wire(false);
  auto& socket = dynamic_cast<UsbSocket&>(machine.chip(0));
  UsbCable cable(socket, line);
  std::optional<Workbench> bench;
  if (!options.bench_folder.empty()) bench.emplace(machine, options.bench_folder);
  const LocalTime began = monotonic_now();
  const LabClock clock;
  BusTime now{0}, slipped{0};
  while (!ended && !line.closed()) {
    // Without a cable nobody minds a late board; and a computer that starts up measures its clocks.
    clock.until(line.plugged() ? began + slipped + now + kAhead : LocalTime{0});
    BusTime wall = monotonic_now() - began - slipped;
    if (now > wall + kAhead / 2) {
      wait_for(line);
      continue;
    }
    if (wall > now + options.most_behind) {
      slipped += wall - now - options.most_behind;
      wall = now + options.most_behind;
    }
    now += UsbCable::kTurn;
    while (!machine.advance(now)) {
    }
    while (machine.receive()) {
    }
    cable.serve(now, wall);
    if (bench) bench->look(now);
  }
  std::fprintf(stderr, "kinebus-emulate: %.1f s of board time, slipped %.3f s behind the wall clock\n",
               to_seconds(now), to_seconds(slipped));
  for (const std::string& violation : socket.usb().violations())
    std::fprintf(stderr, "kinebus-emulate: %s\n", violation.c_str());
  return line.error();
}

}  // namespace kinebus::emulator
