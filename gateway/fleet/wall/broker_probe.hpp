#pragma once
// Whether somebody takes connections at an address, asked now and then by a thread of its own: names that do
// not resolve and filters that say nothing keep nobody else waiting.

#include <atomic>
#include <optional>
#include <string>
#include <thread>

namespace kinebus::fleet {

class BrokerProbe {
 public:
  /// An empty `host`: nothing is asked.
  BrokerProbe(std::string host, int port);
  ~BrokerProbe();
  BrokerProbe(const BrokerProbe&) = delete;
  BrokerProbe& operator=(const BrokerProbe&) = delete;

  /// By the last answer; nullopt: not asked, or not yet.
  std::optional<bool> reached() const;

 private:
  void run();

  std::string host_, port_;
  std::atomic<int> reached_{-1};
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

}  // namespace kinebus::fleet
