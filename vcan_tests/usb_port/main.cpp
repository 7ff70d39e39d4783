// kinebus-usb-port: this computer's own USB (vhci_hcd) joined to a board that lies elsewhere: in another
// process, or outside the guest whose USB it is. Until SIGINT, SIGTERM or the board's end.
//   kinebus-usb-port PATH FILE      PATH: a Unix socket, or the device of a virtio-serial port;
//                                   the cable is in the board's connector while FILE exists

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "protocol/host/guarded_main.hpp"
#include "vcan_tests/usb_port/cable_stream.hpp"
#include "vcan_tests/usb_port/virtual_host.hpp"

namespace {

using namespace kinebus;

volatile std::sig_atomic_t ended = 0;
void on_end(int) {
  ended = 1;
}

class Port {
 public:
  explicit Port(std::string file) : file_(std::move(file)) {}
  std::string open(const std::string& path) { return cable_.stream().open(path); }

  bool goes_on() const { return !cable_.closed() && host_.error().empty(); }
  std::string trouble() const { return host_.error().empty() ? cable_.trouble() : host_.error(); }
  void turn() {
    constexpr int kLook_ms = 10;  // at the file
    pollfd wait[] = {{cable_.stream().fd(), POLLIN, 0}, {host_.fd(), POLLIN, 0}};
    ::poll(wait, 2, kLook_ms);
    if (const bool plugged = ::access(file_.c_str(), F_OK) == 0; plugged != plugged_) {
      plugged_ = plugged;
      if (!plugged) leave();
      cable_.send(plugged ? CableStream::Kind::kPlugged : CableStream::Kind::kPulled, 0);
    }
    while (const auto piece = cable_.receive()) take(*piece);
    if (device_there_ && !host_.attached()) host_.attach();
    bytes_.clear();
    if (host_.attached() && !host_.receive(bytes_)) {
      // Linux has let go of it: as one who pulls the plug and puts it in again.
      leave();
      cable_.send(CableStream::Kind::kPulled, 0);
      plugged_ = false;
    } else if (!bytes_.empty()) {
      cable_.send(CableStream::Kind::kData, session_, bytes_);
    }
  }

 private:
  void leave() {
    host_.detach();
    device_there_ = false;
  }
  void take(const CableStream::Piece& piece) {
    if (!plugged_) return;  // it was under way
    if (piece.kind == CableStream::Kind::kAttached) {
      leave();
      session_ = piece.session;
      device_there_ = true;
    } else if (piece.session != session_) {
      return;
    } else if (piece.kind == CableStream::Kind::kDetached) {
      leave();
    } else if (piece.kind == CableStream::Kind::kData && host_.attached()) {
      host_.send(piece.bytes);
    }
  }

  std::string file_;
  CableStream cable_;
  VirtualHost host_;
  bool plugged_ = false, device_there_ = false;
  std::uint8_t session_ = 0;
  std::vector<std::uint8_t> bytes_;
};

int run(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "kinebus-usb-port PATH FILE\n");
    return 2;
  }
  std::signal(SIGINT, on_end);
  std::signal(SIGTERM, on_end);
  Port port(argv[2]);
  std::string error = port.open(argv[1]);
  while (error.empty() && ended == 0 && port.goes_on()) port.turn();
  if (error.empty()) error = port.trouble();
  if (!error.empty()) std::fprintf(stderr, "kinebus-usb-port: %s\n", error.c_str());
  return error.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return kinebus::guarded_main("kinebus-usb-port", [&] { return run(argc, argv); });
}
