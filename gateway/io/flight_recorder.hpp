#pragma once
// The flight recorder of the daemon: hears all frames and events, and writes the last minute to a folder
// after any alarm. Its memory is a mapped file: when the daemon is killed, the next one finds there what
// happened.

#include <filesystem>
#include <memory>
#include <string>

#include "gateway/io/bus_port.hpp"
#include "gateway/io/daemon_part.hpp"

namespace kinebus {

class Gateway;

class FlightRecorder final : public DaemonPart {
 public:
  struct Options {
    std::filesystem::path folder;  ///< of the reports
    /// The mapped file. On a file system of memory (/run) no page of it is ever written back, so the loop's
    /// writes never wait for a disk, and it outlives a process that dies all the same. Empty: in `folder`.
    std::filesystem::path memory{};
    std::string machine;
    std::string interface;
  };
  FlightRecorder(Options options, const Gateway& gateway);
  ~FlightRecorder() override;

  /// Empty: recording. A report of a daemon that died is on its way then. Otherwise why not.
  std::string open();

  void on_frame(LocalTime when, const CanFrame& frame, bool own);
  void on_event(const MachineEvent& event) override;
  void on_time(LocalTime now) override;
  LocalTime next_deadline() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A bus whose frames the recorder hears.
class RecordedBus final : public BusPort {
 public:
  RecordedBus(std::unique_ptr<BusPort> bus, FlightRecorder& recorder)
      : bus_(std::move(bus)), recorder_(recorder) {}
  int fd() const override { return bus_->fd(); }
  LocalTime next_deadline() const override { return bus_->next_deadline(); }
  bool can_send(LocalTime now) override { return bus_->can_send(now); }
  void send(LocalTime now, const CanFrame& frame) override { bus_->send(now, frame); }
  std::optional<Received> receive(LocalTime now) override {
    auto got = bus_->receive(now);
    if (got && got->kind != Received::Kind::kFailure)
      recorder_.on_frame(got->when, got->frame, got->kind == Received::Kind::kSent);
    return got;
  }

 private:
  std::unique_ptr<BusPort> bus_;
  FlightRecorder& recorder_;
};

}  // namespace kinebus
