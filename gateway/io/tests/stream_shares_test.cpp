// What a stream may take of the loop's time, whoever it is.

#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <string>

#include "gateway/io/listener.hpp"
#include "gateway/io/socket_stream.hpp"
#include "gateway/io/tests/streams_fixture.hpp"
#include "gateway/io/tls_stream.hpp"

namespace kinebus {
namespace {

TEST_F(StreamsTest, SessionsHearThatTheLoopWasAwayButOfNoTrifles) {
  int absences = 0;
  Listener listener(loop_, [&](int fd, const std::string&) {
    hub_.add(std::make_unique<SocketStream>(fd), std::make_unique<Echo>(&closed_, &absences));
  });
  ASSERT_EQ(listener.listen_local(folder_.path() / "socket", ""), "");
  const auto one = connect_local(folder_.path() / "socket"), two = connect_local(folder_.path() / "socket");
  ASSERT_TRUE(turn_until([&] { return hub_.streams() == 2; }));
  hub_.on_stall(monotonic_now(), 300ms);
  EXPECT_EQ(absences, 0);
  hub_.on_stall(monotonic_now(), 20s);
  EXPECT_EQ(absences, 2);
}

// A slow host makes fewer turns: the bound holds on any.
TEST_F(StreamsTest, AFloodLeavesTheRestOfTheLoopsTimeToOthers) {
  int heard = 0;
  StreamHub hub(loop_, {.share = 0.2, .burst = 10ms});
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Laborious>(&heard)));
  const LocalTime begin = monotonic_now();
  LocalTime now = begin;
  while (now < begin + LocalTime{400ms} || heard < 20) {
    [[maybe_unused]] const ssize_t sent = ::send(ends[1], "x", 1, MSG_DONTWAIT);
    hub.on_time(now);
    loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    now = monotonic_now();
  }
  const double bound_s = 0.010 + 0.2 * to_seconds(now - begin) + 0.004;
  EXPECT_LE(heard * 0.0005, bound_s) << heard << " in " << to_seconds(now - begin) << " s";
  ::close(ends[1]);
}

// As the one before: who only comes and goes is a flood, too.
TEST_F(StreamsTest, WhoComesAndGoesLeavesTheRestOfTheLoopsTimeToOthers) {
  int came = 0;
  StreamHub hub(loop_, {.share = 0.2, .burst = 10ms});
  Listener listener(loop_, [&](int fd, const std::string&) {
    ++came;
    labour();
    ::close(fd);
  });
  ASSERT_EQ(listener.listen_tcp("127.0.0.1:0"), "");
  listener.pass(hub.gate(listener.fd()));
  const LocalTime begin = monotonic_now();
  LocalTime now = begin;
  std::vector<std::unique_ptr<ByteStream>> guests;
  while (now < begin + LocalTime{400ms} || came < 20) {
    if (guests.size() < static_cast<std::size_t>(came) + 3)
      if (const auto fd = connect_tcp("127.0.0.1", std::to_string(listener.port())))
        guests.push_back(std::make_unique<SocketStream>(*fd));
    hub.on_time(now);
    loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    now = monotonic_now();
  }
  const double bound_s = 0.010 + 0.2 * to_seconds(now - begin) + 0.004;
  EXPECT_LE(came * 0.0005, bound_s) << came << " in " << to_seconds(now - begin) << " s";
}

// Each takes the whole turn: who is not served in this one must be in a later one.
TEST_F(StreamsTest, OfManyThatAreAlwaysReadyNobodyIsForgotten) {
  constexpr std::size_t kStreams = 48;
  std::array<int, kStreams> heard{}, far_ends{};
  StreamHub hub(loop_, {.share = 1, .burst = 1s});
  for (std::size_t i = 0; i < kStreams; ++i) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
    far_ends[i] = ends[1];
    ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Laborious>(&heard[i])));
  }
  for (std::size_t turn = 0; turn < 4 * kStreams; ++turn) {
    for (const int end : far_ends) ASSERT_EQ(::send(end, "x", 1, 0), 1);
    loop_.wait(monotonic_now());
    hub.on_time(monotonic_now());
  }
  for (std::size_t i = 0; i < kStreams; ++i) EXPECT_GT(heard[i], 0) << "stream " << i;
  for (const int end : far_ends) ::close(end);
}

/// Has something to do all the time, and uses half a millisecond for it.
class Busy : public Laborious {
 public:
  Busy(int* heard, int* turns) : Laborious(heard), turns_(turns) {}
  void on_time(LocalTime) override {
    ++*turns_;
    labour();
  }
  LocalTime next_deadline() const override { return LocalTime{0}; }

 private:
  int* turns_;
};

TEST_F(StreamsTest, WhoAlwaysHasSomethingToDoLeavesOthersTheirTurn) {
  int heard = 0, ignored = 0, turned = 0, came = 0;
  std::array<int, 2> busy{}, other{}, ends{};
  StreamHub hub(loop_, {.share = 0.2, .burst = 10ms});
  for (auto* const pair : {&busy, &other, &ends})
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair->data()), 0);
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(busy[0]), std::make_unique<Busy>(&ignored, &turned)));
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(other[0]), std::make_unique<Busy>(&ignored, &turned)));
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Laborious>(&heard)));
  Listener listener(loop_, [&](int fd, const std::string&) {
    ++came;
    ::close(fd);
  });
  ASSERT_EQ(listener.listen_tcp("127.0.0.1:0"), "");
  listener.pass(hub.gate(listener.fd()));
  const auto turns = [&](int count) {
    for (int i = 0; i < count; ++i) {
      const LocalTime now = monotonic_now();
      hub.on_time(now);
      loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    }
  };
  turns(100);  // what it may use at once is used up
  ASSERT_EQ(::send(ends[1], "x", 1, 0), 1);
  const auto guest = connect_tcp("127.0.0.1", std::to_string(listener.port()));
  ASSERT_TRUE(guest);
  turns(100);
  EXPECT_EQ(heard, 1);
  EXPECT_EQ(came, 1);
  ::close(*guest);
  ::close(busy[1]);
  ::close(other[1]);
  ::close(ends[1]);
}

TEST_F(StreamsTest, WhatOneHubLeavesOfItsShareAnotherMayUseAndNoMore) {
  enum class Other { kKeepsIt, kLeavesIt, kUsesIt };
  const auto heard_beside = [&](Other other) {
    int heard = 0, ignored = 0, turned = 0;
    StreamHub hub(loop_, {.share = 0.1, .burst = 10ms}), beside(loop_, {.share = 0.5, .burst = 10ms});
    if (other != Other::kKeepsIt) beside.leaves_to(hub);
    std::array<int, 2> ends{}, busy{};
    for (auto* const pair : {&ends, &busy})
      EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair->data()), 0);
    EXPECT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Laborious>(&heard)));
    std::unique_ptr<ByteSession> session;
    if (other == Other::kUsesIt)
      session = std::make_unique<Busy>(&ignored, &turned);
    else
      session = std::make_unique<Laborious>(&ignored);
    EXPECT_TRUE(beside.add(std::make_unique<SocketStream>(busy[0]), std::move(session)));
    // Time goes by a millisecond a turn here, whatever the computer's does: what is used is the processor's.
    LocalTime now = monotonic_now();
    for (int turn = 0; turn < 400; ++turn, now += LocalTime{1ms}) {
      [[maybe_unused]] const ssize_t sent = ::send(ends[1], "x", 1, MSG_DONTWAIT);
      hub.on_time(now);
      beside.on_time(now);
      loop_.wait(monotonic_now());
    }
    ::close(ends[1]);
    ::close(busy[1]);
    return heard;
  };
  const int alone = heard_beside(Other::kKeepsIt), left = heard_beside(Other::kLeavesIt),
            shared = heard_beside(Other::kUsesIt);
  EXPECT_GT(left, 2 * alone) << shared;
  EXPECT_LT(shared, alone * 3 / 2) << left;
}

TEST_F(StreamsTest, OneThatAlwaysHasSomethingToDoPaysForIt) {
  int ignored = 0;
  StreamHub hub(loop_, {.share = 0.2, .burst = 10ms});
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  int turns = 0;
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Busy>(&ignored, &turns)));
  const LocalTime begin = monotonic_now();
  LocalTime now = begin;
  while (now < begin + LocalTime{400ms} || turns < 20) {
    hub.on_time(now);
    loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    now = monotonic_now();
  }
  const double bound_s = 0.010 + 0.2 * to_seconds(now - begin) + 0.004;
  EXPECT_LE(turns * 0.0005, bound_s) << turns << " in " << to_seconds(now - begin) << " s";
  ::close(ends[1]);
}

/// Takes so many half milliseconds for whatever it hears.
class Slow : public Laborious {
 public:
  Slow(int* heard, int halves) : Laborious(heard), halves_(halves) {}
  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override {
    Laborious::on_bytes(now, bytes);
    for (int i = 1; i < halves_; ++i) labour();
  }

 private:
  int halves_;
};

TEST_F(StreamsTest, NothingIsBegunThatMightNotBeDoneWhenSomethingIsDue) {
  int heard = 0;
  LocalTime ahead = 1h;  // what is due comes so much later than now, for ever
  StreamHub hub(loop_, {.share = 1, .burst = 1s});
  hub.keep_clear_of([&] { return ahead == LocalTime::max() ? ahead : monotonic_now() + ahead; });
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(ends[0]), std::make_unique<Slow>(&heard, 18)));
  const auto heard_in = [&](int turns) {
    const int before = heard;
    for (int i = 0; i < turns; ++i) {
      [[maybe_unused]] const ssize_t sent = ::send(ends[1], "x", 1, MSG_DONTWAIT);
      hub.on_time(monotonic_now());
      loop_.wait(monotonic_now() + LocalTime{200us});
    }
    return heard - before;
  };
  // Too near for any work; after each rest there is a turn, or nobody would ever be heard.
  ahead = 50us;
  EXPECT_EQ(heard_in(1), 0);
  const int in_spite = heard_in(20);
  EXPECT_GE(in_spite, 1);
  EXPECT_LE(in_spite, 10);
  // Whoever is not known to be slow is served 8 ms before; one that took 9 ms is not.
  ahead = 8ms;
  EXPECT_LE(heard_in(60), 30);
  ahead = 1h;
  EXPECT_GE(heard_in(60), 10);
  ahead = LocalTime::max();
  EXPECT_GE(heard_in(60), 10);
  // The loop sleeps until then, and is not woken by what waits.
  ahead = 5ms;
  const LocalTime before = monotonic_now();
  hub.on_time(before);
  EXPECT_GE(hub.next_deadline(), before + LocalTime{ahead});
  ::close(ends[1]);
}

/// A byte for each reading, 50 times; each takes longer than the turn has for streams.
class Morsels : public SocketStream {
 public:
  using SocketStream::SocketStream;
  Moved read(std::span<std::uint8_t> buffer) override {
    if (++reads_ > 50) return {};
    const LocalTime until = monotonic_now() + LocalTime{1ms};
    while (monotonic_now() < until) {
    }
    buffer[0] = 'x';
    return {1, false};
  }

 private:
  int reads_ = 0;
};

TEST_F(StreamsTest, BytesThatComeOneByOneHaveTheTurnsTimeAndNoMore) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  int heard = 0;
  ASSERT_TRUE(hub_.add(std::make_unique<Morsels>(ends[0]), std::make_unique<Laborious>(&heard)));
  ASSERT_EQ(::send(ends[1], "x", 1, 0), 1);
  loop_.wait(monotonic_now());
  EXPECT_EQ(heard, 1);
  ::close(ends[1]);
}

TEST_F(StreamsTest, AHelloInPiecesIsReadPieceByPiece) {
  const auto tls = TlsContext::server(folder_.path() / "tls");
  ASSERT_TRUE(tls) << tls.error();
  std::array<int, 2> ends{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends.data()), 0);
  // 20,000 records of a byte each: the begin of a hello that says it has 100,000.
  std::string hello{"\x01\x01\x86\xa0\x03\x03", 6}, records;
  hello.resize(20'000);
  for (const char byte : hello) records += std::string("\x16\x03\x01\x00\x01", 5) + byte;
  ASSERT_EQ(::send(ends[1], records.data(), records.size(), 0), static_cast<ssize_t>(records.size()));
  const auto stream = tls->open(ends[0]);
  std::array<std::uint8_t, 1000> buffer;
  EXPECT_FALSE(stream->read(buffer).closed);
  int left = 0;
  ASSERT_EQ(::ioctl(ends[0], FIONREAD, &left), 0);
  EXPECT_GT(left, static_cast<int>(records.size()) - 1000) << "read at once";
  EXPECT_LT(left, static_cast<int>(records.size())) << "nothing was read";
  ::close(ends[1]);
}

}  // namespace
}  // namespace kinebus
