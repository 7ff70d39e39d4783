#pragma once
// The daemon's loop: bus, gateway core and clients on one thread. No logic of the machine is here.

#include <csignal>
#include <vector>

#include "gateway/io/bus_port.hpp"
#include "gateway/io/daemon_part.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/service_manager.hpp"
#include "gateway/io/stall_watch.hpp"
#include "gateway/machine/gateway.hpp"

namespace kinebus {

class Daemon {
 public:
  Daemon(EventLoop& loop, BusPort& bus, Gateway& gateway, const ServiceManager& manager);

  /// One more part that lives on the loop; must outlive run().
  void add(DaemonPart& part) { parts_.push_back(&part); }

  /// Runs until `*quit` is not 0 (set by a signal handler) and the machine has come to rest, at most 2 s
  /// later.
  /// Or until `anew` is set and the machine rests; in motion `anew` is taken back.
  void run(const volatile std::sig_atomic_t* quit, bool& anew);

 private:
  void report_events();
  LocalTime next_deadline() const;

  EventLoop& loop_;
  BusPort& bus_;
  Gateway& gateway_;
  const ServiceManager& manager_;
  std::vector<DaemonPart*> parts_;
  StallWatch stalls_;
};

}  // namespace kinebus
