#pragma once

namespace kinebus::fleet {

/// Makes what is missing. What the queue promises is held by constraints, too: a job is at one place at a
/// time, and a gateway has one job at a time.
extern const char* const kSchema;

}  // namespace kinebus::fleet
