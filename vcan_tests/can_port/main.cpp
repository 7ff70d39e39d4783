// kinebus-can-port: joins a SocketCAN interface to a participant of its bus that lies elsewhere: in another
// process, or outside the guest that has the interface. Until SIGINT or SIGTERM.
//   kinebus-can-port INTERFACE PATH      PATH: a Unix socket, or the device of a virtio-serial port

#include <csignal>
#include <cstdio>

#include "protocol/host/guarded_main.hpp"
#include "vcan_tests/can_port/can_port.hpp"

namespace {

using namespace kinebus;

volatile std::sig_atomic_t ended = 0;
void on_end(int) {
  ended = 1;
}

int run(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "kinebus-can-port INTERFACE PATH\n");
    return 2;
  }
  InterfacePort bus;
  StreamPort stream;
  std::string error = bus.open(argv[1]);
  if (error.empty()) error = stream.open(argv[2]);
  if (!error.empty()) {
    std::fprintf(stderr, "kinebus-can-port: %s\n", error.c_str());
    return 1;
  }
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  OneWay out, in;
  std::uint64_t sent = 0, received = 0;
  while (ended == 0 && !bus.closed() && !stream.closed()) {
    // A full interface does not say when it has room: it is asked again after a millisecond.
    pollfd wait[] = {bus.waits_for(!out.waits()), stream.waits_for(!in.waits())};
    ::poll(wait, 2, in.waits() ? 1 : 100);
    sent += out.pass(bus, stream);
    received += in.pass(stream, bus);
  }
  std::fprintf(stderr, "kinebus-can-port: %llu frames from %s, %llu to it, %u lost\n",
               static_cast<unsigned long long>(sent), argv[1], static_cast<unsigned long long>(received),
               bus.lost());
  if (ended != 0) return bus.lost() == 0 ? 0 : 1;
  const CanPort& gone = bus.closed() ? static_cast<const CanPort&>(bus) : stream;
  std::fprintf(stderr, "kinebus-can-port: %s\n",
               gone.trouble().empty() ? "the other end of the bus is gone" : gone.trouble().c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-can-port", [&] { return run(argc, argv); });
}
