#pragma once
// What a control loop asks of Linux.

#include <cstddef>
#include <string>

namespace kinebus {

/// SCHED_FIFO at `priority` (1..99) for the calling thread and locked memory for the process. Threads that it
/// starts afterwards are ordinary ones: who writes a file must not hold up a loop, here or in another
/// process. Returns what could not be had, in words; empty: all of it. Without it programs work, with more
/// jitter.
std::string become_realtime(int priority);

/// For a process that locks its memory, before its threads are made: their stacks are small, as all of them
/// would be fetched at once.
void keep_stacks_small();
/// Fetches `bytes` for the heap of the calling (main) thread and keeps what it is given back: a loop that
/// needs memory finds it there instead of asking the kernel, which would fetch page after page while the loop
/// waits.
void keep_heap(std::size_t bytes);

}  // namespace kinebus
