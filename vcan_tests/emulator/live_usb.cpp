#include "vcan_tests/emulator/live_usb.hpp"

#include <poll.h>

#include <atomic>
#include <csignal>
#include <cstdio>

#include "protocol/host/socketcan.hpp"
#include "vcan_tests/emulator/usb_cable.hpp"

namespace kinebus::emulator {
namespace {

using namespace std::chrono_literals;

constexpr BusTime kPiece = 100us;

std::atomic<bool> ended{false};
void on_end(int) {
  ended = true;
}

}  // namespace

std::string run_usb(const ElfImage& image, const EmulatedNodeOptions& node) {
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  EmulatedMachine machine(image, {node});
  UsbCable cable(machine.board(0));
  machine.board(0).set_usb_cable(true);
  const LocalTime began = monotonic_now();
  for (BusTime now{0}; !ended && cable.error().empty();) {
    const BusTime ahead = now - (monotonic_now() - began);
    if (ahead > 1ms) {
      pollfd wait{cable.fd(), POLLIN, 0};
      poll(&wait, 1, 1);
      continue;
    }
    now += kPiece;
    while (!machine.advance(now)) {
    }
    while (machine.receive()) {
    }
    cable.serve();
  }
  for (const std::string& violation : machine.board(0).usb().violations())
    std::fprintf(stderr, "kinebus-emulate: %s\n", violation.c_str());
  return cable.error();
}

}  // namespace kinebus::emulator
