// Real sockets, TLS and the worker's thread, on one loop: no sleep, no clock but the loop's deadlines.

#include <gtest/gtest.h>
#include <spdlog/logger.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "gateway/io/instance_lock.hpp"
#include "gateway/io/job_link_host.hpp"
#include "gateway/io/listener.hpp"
#include "gateway/io/log_queue.hpp"
#include "gateway/io/machine_file_store.hpp"
#include "gateway/io/socket_stream.hpp"
#include "gateway/io/stream_hub.hpp"
#include "gateway/io/tls_stream.hpp"
#include "gateway/io/worker_thread.hpp"
#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {

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

std::string some_text(std::size_t size) {
  std::string text(size, '\0');
  for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 131 % 251);
  return text;
}

TEST_F(StreamsTest, ALocalSocketCarriesBytesBothWaysAndIsTheOwnersAlone) {
  Listener listener(loop_, [&](int fd, const std::string& who) {
    EXPECT_EQ(who, "local");
    hub_.add(std::make_unique<SocketStream>(fd), std::make_unique<Echo>(&closed_));
  });
  const std::string path = folder_.path() / "socket";
  ASSERT_EQ(listener.listen_local(path, ""), "");
  struct stat found {};
  ASSERT_EQ(::stat(path.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600U);
  auto stream = connect_local(path);
  ASSERT_TRUE(stream) << stream.error();
  const std::string text = some_text(3'000'000);
  EXPECT_EQ(through(**stream, text), text);
  stream->reset();
  EXPECT_TRUE(turn_until([&] { return closed_ == 1 && hub_.streams() == 0; }));
}

TEST_F(StreamsTest, ASecondDaemonDoesNotTakeTheSocketAway) {
  Listener first(loop_, [](int fd, const std::string&) { ::close(fd); });
  Listener second(loop_, [](int fd, const std::string&) { ::close(fd); });
  ASSERT_EQ(first.listen_local(folder_.path() / "socket", ""), "");
  EXPECT_NE(second.listen_local(folder_.path() / "socket", ""), "");
  EXPECT_NE(second.listen_local(folder_.path() / "other", "no-such-group"), "");
}

TEST_F(StreamsTest, AFileUnderTheSocketsNameIsLeftAsItIs) {
  const std::string path = folder_.path() / "letter";
  std::ofstream(path) << "dear";
  Listener listener(loop_, [](int fd, const std::string&) { ::close(fd); });
  EXPECT_NE(listener.listen_local(path, ""), "");
  EXPECT_EQ(std::filesystem::file_size(path), 4U);
}

TEST_F(StreamsTest, OneDaemonHasItsFilesAlone) {
  const auto jobs = folder_.path() / "jobs", journal = folder_.path() / "resume.journal";
  auto first = std::make_unique<InstanceLock>();
  EXPECT_EQ(first->take_folder(jobs), "");
  EXPECT_EQ(first->take_file(journal), "");
  InstanceLock second;
  EXPECT_NE(second.take_folder(jobs), "");
  EXPECT_NE(second.take_file(journal), "");
  EXPECT_FALSE(std::filesystem::exists(journal));
  first.reset();
  EXPECT_EQ(second.take_folder(jobs), "");
  EXPECT_EQ(second.take_file(journal), "");
}

/// Has ended, and has more to say than anybody reads.
class Farewell : public ByteSession {
 public:
  void on_bytes(LocalTime, std::span<const std::uint8_t>) override {}
  void on_time(LocalTime) override {}
  LocalTime next_deadline() const override { return LocalTime::max(); }
  std::span<const std::uint8_t> next_bytes() override { return words_; }
  void on_bytes_sent(std::size_t) override {}
  bool wants_bytes() const override { return false; }
  bool ended() const override { return true; }
  void on_closed(LocalTime, std::string_view) override {}

 private:
  std::vector<std::uint8_t> words_ = std::vector<std::uint8_t>(1U << 20);
};

TEST_F(StreamsTest, WhoDoesNotReadTheFarewellIsClosedAllTheSame) {
  StreamHub hub(loop_, {.farewell = 10ms});
  Listener listener(loop_, [&](int fd, const std::string&) {
    hub.add(std::make_unique<SocketStream>(fd), std::make_unique<Farewell>());
  });
  ASSERT_EQ(listener.listen_local(folder_.path() / "socket", ""), "");
  auto mute = connect_local(folder_.path() / "socket");
  bool came = false;
  EXPECT_TRUE(turn_until([&] {
    hub.on_time(monotonic_now());
    came = came || hub.streams() == 1;
    return came && hub.streams() == 0;
  }));
}

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

/// Uses half a millisecond of the processor, however long the host takes for that.
void labour() {
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
    hub.let_in();
    ++came;
    labour();
    ::close(fd);
  });
  ASSERT_EQ(listener.listen_tcp("127.0.0.1:0"), "");
  hub.add_door(listener.fd());
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

TEST_F(StreamsTest, ASecretThatOthersMayReadOrGuessIsRefused) {
  const auto folder = folder_.path() / "tls";
  ASSERT_TRUE(TlsContext::server(folder));
  ::chmod((folder / "key.pem").c_str(), 0640);
  const auto loose = TlsContext::server(folder);
  ASSERT_FALSE(loose);
  EXPECT_NE(loose.error().find("chmod 600"), std::string::npos);
  ::chmod((folder / "key.pem").c_str(), 0600);
  std::ofstream(folder / "token") << "x\n";
  ::chmod((folder / "token").c_str(), 0600);
  EXPECT_NE(token_of(folder / "token").error().find("16 characters"), std::string::npos);
  std::ofstream(folder / "token") << std::string(32, 'x') << "\n";
  EXPECT_TRUE(token_of(folder / "token"));
  ::chmod((folder / "token").c_str(), 0644);
  EXPECT_NE(token_of(folder / "token").error().find("chmod 600"), std::string::npos);
  std::filesystem::remove(folder / "token");
  EXPECT_GE(token_of(folder / "token")->size(), 32U);
}

TEST(LogQueue, ALogThatNobodyReadsIsDroppedAndCountedAndHoldsNobodyUp) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  std::string read;
  {
    auto queue = std::make_shared<LogQueue>(pipe[1]);
    spdlog::logger log("test", queue);
    log.set_pattern("%v");
    // The pipe takes 64 KiB, the queue its lines; all others are dropped.
    for (int i = 0; i < 4000; ++i) log.info(std::string(99, 'x'));
    EXPECT_GT(queue->dropped(), 1000U);
    EXPECT_LT(queue->dropped(), 3400U);
    const std::uint64_t dropped = queue->dropped();
    // Who reads later hears of it.
    const std::string told = std::to_string(dropped) + " lines of the log found no room";
    while (read.find(told) == std::string::npos) {
      std::array<char, 65'536> buffer{};
      const ssize_t count = ::read(pipe[0], buffer.data(), buffer.size());
      ASSERT_GT(count, 0);
      read.append(buffer.data(), static_cast<std::size_t>(count));
    }
    for (int i = 0; i < 2000; ++i) log.info(std::string(99, 'y'));
  }
  // The destructor has come back though nobody reads.
  ::close(pipe[0]);
  ::close(pipe[1]);
}

TEST_F(StreamsTest, AClientThatReadsNothingIsNotReadFromEither) {
  Listener listener(loop_, [&](int fd, const std::string&) {
    hub_.add(std::make_unique<SocketStream>(fd), std::make_unique<Echo>(&closed_));
  });
  ASSERT_EQ(listener.listen_local(folder_.path() / "socket", ""), "");
  auto flood = connect_local(folder_.path() / "socket");
  auto good = connect_local(folder_.path() / "socket");
  ASSERT_TRUE(flood && good);
  const std::string text = some_text(100'000);
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  std::size_t taken = 0;
  int stuck = 0;
  ASSERT_TRUE(turn_until([&] {
    const std::size_t count = (*flood)->write(bytes).count;
    taken += count;
    stuck = count == 0 ? stuck + 1 : 0;
    return stuck > 20;
  }));
  // The session's own limit and the two sockets' buffers.
  EXPECT_LT(taken, 3U << 20);
  EXPECT_EQ(through(**good, text), text);
}

TEST_F(StreamsTest, TlsCarriesBytesToTheRightGatewayOnly) {
  const auto server = TlsContext::server(folder_.path() / "tls");
  ASSERT_TRUE(server) << server.error();
  Listener listener(loop_, [&](int fd, const std::string& who) {
    EXPECT_EQ(who, "tcp 127.0.0.1");
    hub_.add(server->open(fd), std::make_unique<Echo>(&closed_));
  });
  ASSERT_EQ(listener.listen_tcp("127.0.0.1:0"), "");
  const std::string port = std::to_string(listener.port());
  const auto fd = connect_tcp("127.0.0.1", port);
  ASSERT_TRUE(fd) << fd.error();
  // The stream outlives the context that made it.
  const auto stream = TlsContext::client(server->fingerprint())->open(*fd);
  const std::string text = some_text(2'000'000);
  EXPECT_EQ(through(*stream, text), text);

  const auto stranger = TlsContext::client(std::string(64, 'a'));
  ASSERT_TRUE(stranger);
  const auto second = connect_tcp("127.0.0.1", port);
  ASSERT_TRUE(second);
  EXPECT_EQ(through(*stranger->open(*second), text).substr(0, 7), "closed:");
  EXPECT_FALSE(TlsContext::client("not a fingerprint"));
}

TEST_F(StreamsTest, TlsMeetsPlainBytesWithoutHarm) {
  const auto server = TlsContext::server(folder_.path() / "tls");
  ASSERT_TRUE(server);
  Listener listener(loop_, [&](int fd, const std::string&) {
    hub_.add(server->open(fd), std::make_unique<Echo>(&closed_));
  });
  ASSERT_EQ(listener.listen_tcp("127.0.0.1:0"), "");
  const auto fd = connect_tcp("127.0.0.1", std::to_string(listener.port()));
  ASSERT_TRUE(fd);
  SocketStream plain(*fd);
  const std::string text = "GET / HTTP/1.0\r\n\r\n";
  plain.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  EXPECT_TRUE(turn_until([&] { return closed_ == 1; }));
}

TEST_F(StreamsTest, TheIdentityOutlivesTheProgramAndTheKeyIsSecret) {
  const auto first = TlsContext::server(folder_.path() / "tls");
  const auto second = TlsContext::server(folder_.path() / "tls");
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->fingerprint(), second->fingerprint());
  struct stat found {};
  ASSERT_EQ(::stat((folder_.path() / "tls" / "key.pem").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777, 0600U);
}

TEST_F(StreamsTest, WorkIsDoneBesideTheLoopInOrderAndToldWithinIt) {
  WorkerThread worker(loop_);
  const auto loop_thread = std::this_thread::get_id();
  std::vector<int> order;
  for (int i = 0; i < 100; ++i)
    worker.ask([i, loop_thread] { return std::this_thread::get_id() == loop_thread ? -1 : i; },
               [&order, loop_thread](int answer) {
                 EXPECT_EQ(std::this_thread::get_id(), loop_thread);
                 order.push_back(answer);
               });
  ASSERT_TRUE(turn_until([&] { return order.size() == 100; }));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(order[static_cast<std::size_t>(i)], i);
}

TEST_F(StreamsTest, TheMachineFileIsReplacedWholeAndTheOldOneKept) {
  const auto path = folder_.path() / "machine.toml";
  MachineFileStore file(path, "built in");
  EXPECT_FALSE(file.read());
  ASSERT_TRUE(file.write("first"));
  ASSERT_TRUE(file.write("second"));
  EXPECT_EQ(file.read()->text, "second");
  EXPECT_EQ(MachineFileStore(path.string() + ".before", "").read()->text, "first");
  MachineFileStore built_in({}, "built in");
  EXPECT_EQ(built_in.read()->text, "built in");
  EXPECT_FALSE(built_in.write("x"));
}

}  // namespace
}  // namespace kinebus
