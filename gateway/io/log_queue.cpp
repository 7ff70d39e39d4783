#include "gateway/io/log_queue.hpp"

#include <poll.h>
#include <spdlog/pattern_formatter.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <utility>

#include "protocol/host/quiet_thread.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr auto kFarewell = 500ms;
/// How often a thread that waits for a full pipe looks whether the process ends.
constexpr int kLookMs = 100;

}  // namespace

LogQueue::LogQueue(int fd) : fd_(fd), formatter_(std::make_unique<spdlog::pattern_formatter>()) {
  thread_ = quiet_thread([this] { run(); });
}

LogQueue::~LogQueue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
    give_up_ = std::chrono::steady_clock::now() + kFarewell;
  }
  wake_.wake();
  thread_.join();
}

void LogQueue::log(const spdlog::details::log_msg& message) {
  {
    const std::lock_guard lock(mutex_);
    if (lines_.size() >= kMaxLines) {
      ++dropped_;
      return;
    }
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    lines_.emplace_back(text.data(), text.size());
  }
  wake_.wake();
}

void LogQueue::set_pattern(const std::string& pattern) {
  set_formatter(std::make_unique<spdlog::pattern_formatter>(pattern));
}

void LogQueue::set_formatter(std::unique_ptr<spdlog::formatter> formatter) {
  const std::lock_guard lock(mutex_);
  formatter_ = std::move(formatter);
}

std::uint64_t LogQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void LogQueue::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    while (!ends_ && lines_.empty()) {
      lock.unlock();
      wake_.wait();
      lock.lock();
    }
    if (lines_.empty()) return;
    std::string text = std::move(lines_.front());
    lines_.pop_front();
    if (lines_.empty() && dropped_ > told_dropped_) {
      text += "kinebusd: " + std::to_string(dropped_ - told_dropped_) + " lines of the log found no room\n";
      told_dropped_ = dropped_;
    }
    lock.unlock();
    const bool written = write(text);
    lock.lock();
    if (!written) return;
  }
}

/// False: nobody will read it.
bool LogQueue::write(std::string_view text) {
  while (!text.empty()) {
    // A pipe that is ready has room for PIPE_BUF bytes: so much never blocks.
    pollfd waiting{fd_, POLLOUT, 0};
    if (::poll(&waiting, 1, kLookMs) <= 0) {
      const std::lock_guard lock(mutex_);
      if (ends_ && std::chrono::steady_clock::now() > give_up_) return false;
      continue;
    }
    const ssize_t count = ::write(fd_, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    // A reader that has gone takes nothing; others may come (a terminal), later lines are tried again.
    if (count <= 0) return true;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace kinebus
