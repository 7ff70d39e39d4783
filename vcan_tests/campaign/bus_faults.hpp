#pragma once
// What goes wrong between the stations: frames lost, late, doubled, in another order or wrong at one
// receiver, bit errors on the wire for all, and stations that do not belong there.

#include <memory>
#include <optional>

#include "gateway/machine/gateway.hpp"
#include "tools/simulation/simulation.hpp"
#include "vcan_tests/campaign/fault.hpp"

namespace kinebus {

/// Frames on their way into one receiver.
class ReceiverFaults {
 public:
  ReceiverFaults(const Fault& fault, std::uint64_t seed) : fault_(fault), random_(seed) {}
  void on_arrival(int station, std::vector<VirtualMachine::Arrival>& arrivals);
  /// Frames that a node's controller knows it has lost; asked once each.
  std::uint32_t take_overruns();
  static bool concerns(FaultKind kind);

 private:
  const Fault fault_;
  std::mt19937_64 random_;
  std::optional<VirtualMachine::Arrival> kept_;  // waits to be overtaken
  std::uint32_t overruns_ = 0;
};

/// Bit errors: which frames are destroyed.
class WireFaults {
 public:
  WireFaults(const Fault& fault, std::uint64_t seed, BusModel::Port victim)
      : fault_(fault), random_(seed), victim_(victim) {}
  bool destroys(BusModel::Port from);
  static bool concerns(FaultKind kind);

 private:
  const Fault fault_;
  std::mt19937_64 random_;
  BusModel::Port victim_;
};

/// A station that is none of the machine's: babbler, another CANopen system, a node with an id that is taken.
class Stranger {
 public:
  Stranger(const Fault& fault, std::uint64_t seed, VirtualMachine& machine, std::uint8_t taken_id);
  /// After every frame on the bus, and every millisecond.
  void on_time(BusTime now);
  static bool concerns(FaultKind kind);

 private:
  CanFrame next_foreign_frame();

  const Fault fault_;
  std::mt19937_64 random_;
  VirtualMachine& machine_;
  BusModel::Port port_;
  std::uint8_t taken_id_;
  BusTime next_{0};
  std::uint8_t count_ = 0;
};

/// A second gateway with the same machine file, on the same bus.
class SecondGateway {
 public:
  SecondGateway(const MachineDescription& description, VirtualMachine& machine)
      : gateway_(description, {.epoch = 251}), machine_(machine), port_(machine.add_stranger(1)) {}
  void start(BusTime now);
  void on_frame(const NodeMachine::Received& received);
  void on_time(BusTime now);
  MachineState state() const { return gateway_.state(); }

 private:
  void serve(BusTime now);

  Gateway gateway_;
  VirtualMachine& machine_;
  BusModel::Port port_;
};

}  // namespace kinebus
