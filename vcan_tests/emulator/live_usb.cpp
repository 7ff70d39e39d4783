#include "vcan_tests/emulator/live_usb.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <optional>

#include "protocol/host/socketcan.hpp"
#include "vcan_tests/emulator/lab_clock.hpp"
#include "vcan_tests/emulator/usb_cable.hpp"
#include "vcan_tests/emulator/workbench.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

// Of the wall clock, or of the board: the other waits. The computer takes the board's clock, by its time
// stamps, for one that goes as evenly as a crystal.
constexpr BusTime kAhead = 500us;

std::atomic<bool> ended{false};
void on_end(int) {
  ended = true;
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
  bool joined = false;
  while (!ended && !line.closed()) {
    joined = joined || line.plugged();  // before, a computer that starts up measures its clocks
    if (joined) clock.wait_at(began + slipped + now + kAhead);
    BusTime wall = monotonic_now() - began - slipped;
    const bool waits = joined && clock.guest_is_behind(began + slipped + now);
    if (waits || now > wall + kAhead / 2) {
      clock.wait({line.fd(), POLLIN, 0});
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
    if (!bench) continue;
    bench->look_at_cable(now, line.plugged());
    bench->look(now);
  }
  std::fprintf(stderr, "kinebus-emulate: %.1f s of board time, slipped %.3f s behind the wall clock\n",
               to_seconds(now), to_seconds(slipped));
  for (const std::string& violation : socket.usb().violations())
    std::fprintf(stderr, "kinebus-emulate: %s\n", violation.c_str());
  return line.error();
}

}  // namespace kinebus::emulator
