#pragma once
// Writes every frame of a bus to a file, as `candump -L` does: what happened can be replayed and compared.

#include <cstdio>
#include <memory>
#include <string>

#include "gateway/io/bus_port.hpp"
#include "gateway/result.hpp"

namespace kinebus {

class LoggedBus : public BusPort {
 public:
  static Result<std::unique_ptr<BusPort>, std::string> open(std::unique_ptr<BusPort> bus,
                                                            const std::string& path);

  int fd() const override { return bus_->fd(); }
  LocalTime next_deadline() const override { return bus_->next_deadline(); }
  bool can_send(LocalTime now) override { return bus_->can_send(now); }
  void send(LocalTime now, const CanFrame& frame) override { bus_->send(now, frame); }
  std::optional<Received> receive(LocalTime now) override;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  LoggedBus(std::unique_ptr<BusPort> bus, std::unique_ptr<std::FILE, Close> file)
      : bus_(std::move(bus)), file_(std::move(file)) {}

  std::unique_ptr<BusPort> bus_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace kinebus
