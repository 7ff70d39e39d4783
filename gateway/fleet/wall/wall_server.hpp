#pragma once
// Serves the wall by HTTP to this computer, and asks the queue once a second for what it shows; every five
// seconds for what Prometheus reads, whoever asks how often.

#include <atomic>
#include <optional>
#include <string>

#include "gateway/fleet/outward/broker.hpp"

namespace kinebus::fleet {

struct WallOptions {
  std::string database;
  std::string address;                      ///< "127.0.0.1:7450"; only one of this computer is taken
  std::optional<Broker::Options> broker{};  ///< whether it works; nullopt: not asked for
};

/// Returns soon after `quit` is set; what is wrong with the address is thrown as words (std::runtime_error).
void serve_wall(const WallOptions& options, const std::atomic<bool>& quit);

}  // namespace kinebus::fleet
