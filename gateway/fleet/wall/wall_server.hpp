#pragma once
// Serves the wall by HTTP to this computer, and asks the queue once a second for what it shows.

#include <atomic>
#include <string>

namespace kinebus::fleet {

/// `address`: "127.0.0.1:7450"; only one of this computer is taken. Returns soon after `quit` is set; what is
/// wrong with the address is thrown as words (std::runtime_error).
void serve_wall(const std::string& database, const std::string& address, const std::atomic<bool>& quit);

}  // namespace kinebus::fleet
