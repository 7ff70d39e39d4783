#pragma once
// Whether a broker of MQTT works, by a client that stays with it, on a thread of its own: it is logged in and
// its pings are answered. Names that do not resolve and filters that say nothing keep nobody else waiting.

#include <atomic>
#include <optional>
#include <thread>

#include "gateway/fleet/outward/broker.hpp"

namespace kinebus::fleet {

class BrokerProbe {
 public:
  /// nullopt: nothing is asked.
  explicit BrokerProbe(std::optional<Broker::Options> broker);
  ~BrokerProbe();
  BrokerProbe(const BrokerProbe&) = delete;
  BrokerProbe& operator=(const BrokerProbe&) = delete;

  /// By the last answer; nullopt: not asked, or not yet.
  std::optional<bool> works() const;

 private:
  class Client;
  void run();

  std::optional<Broker::Options> broker_;
  std::atomic<int> works_{-1};
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace kinebus::fleet
