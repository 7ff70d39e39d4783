#pragma once
// The last line of defence of every program: what nobody caught becomes one line on stderr and exit status 1.

#include <cstdio>
#include <exception>
#include <utility>

namespace kinebus {

/// Runs `run`, whose result is the program's exit status.
template <typename Run>
int guarded_main(const char* program, Run&& run) noexcept {
  try {
    return std::forward<Run>(run)();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
  } catch (...) {
    std::fprintf(stderr, "%s: ended by an error of unknown kind\n", program);
  }
  return 1;
}

}  // namespace kinebus
