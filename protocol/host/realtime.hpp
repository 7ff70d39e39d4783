#pragma once
// What a control loop asks of Linux.

#include <string>

namespace kinebus {

/// SCHED_FIFO at `priority` (1..99) for the calling thread and locked memory for the process. Threads that it
/// starts afterwards are ordinary ones: who writes a file must not hold up a loop, here or in another
/// process. Returns what could not be had, in words; empty: all of it. Without it programs work, with more
/// jitter.
std::string become_realtime(int priority);

}  // namespace kinebus
