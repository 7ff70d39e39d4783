#include "vcan_tests/emulator/usb_line.hpp"

namespace kinebus::emulator {

std::string StreamedUsb::open(const std::string& path) {
  std::string error = cable_.stream().listen_at(path);
  if (error.empty()) error = cable_.stream().wait();
  fd_ = cable_.stream().fd();
  return error;
}

bool StreamedUsb::receive(std::vector<std::uint8_t>& bytes) {
  bool still = true;
  while (const auto piece = cable_.receive()) {
    switch (piece->kind) {
      case CableStream::Kind::kPlugged:
        plugged_ = true;
        break;
      case CableStream::Kind::kPulled:
        plugged_ = still = false;
        bytes.clear();
        detach();
        break;
      case CableStream::Kind::kData:
        if (attached_ && piece->session == session_)
          bytes.insert(bytes.end(), piece->bytes.begin(), piece->bytes.end());
        break;
      default:
        break;
    }
  }
  return still;
}

void StreamedUsb::attach() {
  attached_ = true;
  cable_.send(CableStream::Kind::kAttached, ++session_);
}

void StreamedUsb::detach() {
  if (!attached_) return;
  attached_ = false;
  cable_.send(CableStream::Kind::kDetached, session_);
}

}  // namespace kinebus::emulator
