#pragma once
// Tells a broker of MQTT what machines do, on a thread of its own: nobody waits for it. A broker that is gone
// is asked again every second; what happened meanwhile is told as it is then.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "gateway/fleet/machine_view.hpp"

namespace kinebus::fleet {

class Broker {
 public:
  struct Options {
    std::string host = "localhost";
    int port = 1883;
    std::string user{}, password{};
    std::string group = "kinebus";
    std::string node{};  ///< of Sparkplug: this agent
  };
  explicit Broker(Options options);
  ~Broker();
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;

  void show(const MachineView& view);

 private:
  class Connection;
  void run();
  std::vector<MachineView> all();
  std::vector<MachineView> changed();

  Options options_;
  std::mutex busy_;
  std::map<std::string, MachineView> views_;
  std::map<std::string, bool> changed_;
  std::atomic<bool> quit_{false};
  std::thread thread_;
};

/// "HOST", "HOST:PORT" with the default port 1883. Error: words.
std::string read_broker_address(const std::string& text, Broker::Options& options);

}  // namespace kinebus::fleet
