#include "gateway/io/bus_log.hpp"

#include <cerrno>
#include <cstring>

#include "protocol/can/candump.hpp"

namespace kinebus {

Result<std::unique_ptr<BusPort>, std::string> LoggedBus::open(std::unique_ptr<BusPort> bus,
                                                              const std::string& path) {
  std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "we"));
  if (!file) return Error<std::string>(path + ": " + std::strerror(errno));
  return std::unique_ptr<BusPort>(new LoggedBus(std::move(bus), std::move(file)));
}

std::optional<BusPort::Received> LoggedBus::receive(LocalTime now) {
  auto received = bus_->receive(now);
  if (received && received->kind != Received::Kind::kFailure) {
    const auto text =
        to_candump({.time = std::chrono::duration_cast<std::chrono::microseconds>(received->when),
                    .interface = "bus",
                    .frame = received->frame})
            .view();
    std::fwrite(text.data(), 1, text.size(), file_.get());
    std::fputc('\n', file_.get());
  }
  return received;
}

}  // namespace kinebus
