#pragma once
// The fleet's numbers for Prometheus. As many lines for a thousand machines as for one: machines are counted
// by state, and no line names a machine, a job or a file. Each machine's own numbers are its gateway's.

#include <optional>
#include <string>
#include <vector>

#include "gateway/fleet/queue.hpp"

namespace kinebus::fleet {

struct FleetNumbers {
  bool database = false;  ///< answers; else the next two are not known
  Queue::Numbers jobs{};
  std::vector<Queue::Seen> machines{};
  double looked_unix_s = 0;
  std::optional<bool> broker{};  ///< works; nullopt: nobody asked for it
};

/// An agent that has not told of its machine for so long is silent, on the wall, too.
constexpr double kSilentAfterS = 15;

/// In the exposition format 0.0.4.
std::string fleet_metrics(const FleetNumbers& numbers);

}  // namespace kinebus::fleet
