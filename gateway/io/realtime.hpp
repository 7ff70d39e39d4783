#pragma once
// What a control loop asks of Linux, and the word to systemd. Each function says in words what it got.

#include <string>
#include <string_view>

namespace kinebus {

/// SCHED_FIFO at `priority` (1..99) and locked memory. Returns what could not be had, in words; empty: all of
/// it. Without these the daemon works, with more jitter.
std::string become_realtime(int priority);

/// sd_notify protocol: "READY=1", "STATUS=...", "WATCHDOG=1", "STOPPING=1". Does nothing where systemd did
/// not ask.
void notify_systemd(std::string_view state);

}  // namespace kinebus
