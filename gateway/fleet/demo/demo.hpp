#pragma once
// A whole fleet on one computer, in a folder that is gone afterwards: PostgreSQL, a broker, simulated
// machines, an agent, the wall.

#include <atomic>
#include <string>

namespace kinebus::fleet {

struct DemoOptions {
  int machines = 10;
  int jobs = 30;
  std::string http = "127.0.0.1:7450";
};

/// Returns soon after `quit` is set. What is missing is thrown as words (std::runtime_error).
void run_demo(const DemoOptions& options, const std::atomic<bool>& quit);

}  // namespace kinebus::fleet
