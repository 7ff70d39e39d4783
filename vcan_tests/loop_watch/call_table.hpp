#pragma once
// What each system call does to a thread that must not wait.

#include <cstdint>

namespace kinebus {

enum class CallRule : std::uint8_t {
  kNever,     ///< waits, or may
  kQuick,     ///< never waits for anything outside of the processor
  kTransfer,  ///< of a descriptor that does not wait; not of a file
  kClose,
  kMap,
  kFutex,
};

struct CallRow {
  std::uint64_t number;
  const char* name;
  CallRule rule;
  /// Which argument has the MSG_ flags; -1: none.
  int flags = -1;
};

/// nullptr: not in the table.
const CallRow* call_row(std::uint64_t number);

}  // namespace kinebus
