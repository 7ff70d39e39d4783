#pragma once
// A loop and a hub with real sockets, a session that says back what it hears, and one that takes its
// time. No sleep, no clock but the
// loop's.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <functional>
#include <string>

#include "gateway/io/byte_stream.hpp"
#include "gateway/io/event_loop.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {

using namespace std::chrono_literals;

/// Says back what it hears.
class Echo : public ByteSession {
 public:
  explicit Echo(int* closed, int* absences = nullptr) : closed_(closed), absences_(absences) {}
  void on_bytes(LocalTime, std::span<const std::uint8_t> bytes) override {
    out_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    most_ = std::max(most_, out_.size());
  }
  void on_time(LocalTime) override {}
  void on_absence(LocalTime) override { ++*absences_; }
  LocalTime next_deadline() const override { return LocalTime::max(); }
  std::span<const std::uint8_t> next_bytes() override {
    return {reinterpret_cast<const std::uint8_t*>(out_.data()), out_.size()};
  }
  void on_bytes_sent(std::size_t count) override { out_.erase(0, count); }
  bool wants_bytes() const override { return out_.size() < 300'000; }
  bool ended() const override { return false; }
  void on_closed(LocalTime, std::string_view) override { ++*closed_; }

 private:
  int *closed_, *absences_;
  std::string out_;
  std::size_t most_ = 0;
};

/// Uses half a millisecond of the processor, however long the host takes for that.
inline void labour() {
  const auto used = [] {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds{time.tv_sec} + std::chrono::nanoseconds{time.tv_nsec};
  };
  const auto until = used() + 500us;
  while (used() < until) {
  }
}

/// Takes half a millisecond for whatever it hears.
class Laborious : public ByteSession {
 public:
  explicit Laborious(int* heard) : heard_(heard) {}
  void on_bytes(LocalTime, std::span<const std::uint8_t>) override {
    ++*heard_;
    labour();
  }
  void on_time(LocalTime) override {}
  LocalTime next_deadline() const override { return LocalTime::max(); }
  std::span<const std::uint8_t> next_bytes() override { return {}; }
  void on_bytes_sent(std::size_t) override {}
  bool wants_bytes() const override { return true; }
  bool ended() const override { return false; }
  void on_closed(LocalTime, std::string_view) override {}

 private:
  int* heard_;
};

class StreamsTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  EventLoop loop_;
  StreamHub hub_{loop_};
  int closed_ = 0;

  /// Turns the loop until `done`, at most two minutes, which is for a loop that hangs.
  bool turn_until(const std::function<bool()>& done) {
    const LocalTime limit = monotonic_now() + LocalTime{120s};
    while (!done()) {
      if (monotonic_now() > limit) return false;
      hub_.on_time(monotonic_now());
      loop_.wait(std::min({hub_.next_deadline(), limit, monotonic_now() + LocalTime{5ms}}));
    }
    return true;
  }
  /// Sends `text` and hears it back, both ways at once.
  std::string through(ByteStream& stream, const std::string& text) {
    std::string back;
    std::size_t sent = 0;
    bool closed = false;
    EXPECT_TRUE(turn_until([&] {
      const std::span<const std::uint8_t> all(reinterpret_cast<const std::uint8_t*>(text.data()),
                                              text.size());
      const auto written = stream.write(all.subspan(sent, std::min<std::size_t>(50'000, text.size() - sent)));
      sent += written.count;
      std::array<std::uint8_t, 40'000> buffer;
      const auto read = stream.read(buffer);
      back.append(reinterpret_cast<const char*>(buffer.data()), read.count);
      closed = written.closed || read.closed;
      return back.size() >= text.size() || closed;
    })) << back.size();
    return closed ? "closed: " + stream.closed_reason() : back;
  }
};

inline std::string some_text(std::size_t size) {
  std::string text(size, '\0');
  for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 131 % 251);
  return text;
}

}  // namespace kinebus
