#pragma once
// The log's way out, beside the loop: whoever reads stderr (a pipe, the journal) may stand still for ever,
// the loop never waits for it. What finds no room is dropped, counted, and told when there is room again.

#include <spdlog/sinks/base_sink.h>

#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "protocol/host/inheriting_mutex.hpp"
#include "protocol/host/wake_up.hpp"

namespace kinebus {

class LogQueue : public spdlog::sinks::sink {
 public:
  static constexpr std::size_t kMaxLines = 1000;

  /// Lines go to `fd`. Made before the process asks for real-time priority: its thread does not inherit it.
  explicit LogQueue(int fd);
  /// Waits for what is there to go out, half a second at most.
  ~LogQueue() override;
  LogQueue(const LogQueue&) = delete;
  LogQueue& operator=(const LogQueue&) = delete;

  void log(const spdlog::details::log_msg& message) override;
  void flush() override {}
  void set_pattern(const std::string& pattern) override;
  void set_formatter(std::unique_ptr<spdlog::formatter> formatter) override;
  std::uint64_t dropped() const;

 private:
  void run();
  bool write(std::string_view text);

  const int fd_;
  mutable InheritingMutex mutex_;
  WakeUp wake_;
  std::unique_ptr<spdlog::formatter> formatter_;  // by mutex_, like all that follows
  std::deque<std::string> lines_;
  std::uint64_t dropped_ = 0, told_dropped_ = 0;
  bool ends_ = false;
  std::chrono::steady_clock::time_point give_up_{};
  std::thread thread_;
};

}  // namespace kinebus
