#pragma once
// What a program is doing, once it takes longer than two seconds.

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <string>

namespace kinebus {

/// On stderr: in a terminal one line that is written over, else a line now and then.
class StepLine {
 public:
  StepLine() = default;
  ~StepLine() { clear(); }
  StepLine(const StepLine&) = delete;
  StepLine& operator=(const StepLine&) = delete;

  void show(const std::string& words) {
    using namespace std::chrono_literals;
    const auto now = std::chrono::steady_clock::now();
    if (now - began_ < 2s || (!terminal_ && now - shown_ < 20s)) return;
    std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", words.c_str());
    std::fflush(stderr);
    shown_ = now;
    open_ = terminal_;
  }
  /// The line is gone, for what is printed next.
  void clear() {
    if (open_) std::fputs("\r\033[K", stderr);
    open_ = false;
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) != 0, open_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now(), shown_{};
};

}  // namespace kinebus
