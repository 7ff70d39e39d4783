#pragma once
// The word to systemd.

#include <string_view>

namespace kinebus {

/// sd_notify protocol: "READY=1", "STATUS=...", "WATCHDOG=1", "STOPPING=1". Does nothing where systemd did
/// not ask.
void notify_systemd(std::string_view state);

}  // namespace kinebus
