#pragma once
// The bus inside the daemon: the machine's nodes as virtual nodes on a modelled 1 Mbit/s bus, driven by the
// clock of the daemon's loop, which stands while the process is not run. A first run needs no hardware and no
// kernel module.

#include <deque>
#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/io/bus_port.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"

namespace kinebus {

class InprocBus : public BusPort {
 public:
  InprocBus(const MachineDescription& machine, LocalTime now, std::uint64_t seed = 1);

  int fd() const override { return -1; }
  LocalTime next_deadline() const override;
  bool can_send(LocalTime now) override;
  void send(LocalTime now, const CanFrame& frame) override;
  std::optional<Received> receive(LocalTime now) override;

 private:
  void advance(LocalTime now);

  LocalTime start_;    // the bus's own time begins here
  BusTime looked_{0};  // when the machine was last advanced
  std::unique_ptr<VirtualMachine> machine_;
  std::deque<Received> received_;
};

}  // namespace kinebus
