// Real sockets, TLS and the worker's thread, on one loop: no sleep, no clock but the loop's deadlines.

#include <gtest/gtest.h>
#include <spdlog/logger.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
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
#include "gateway/io/tests/streams_fixture.hpp"
#include "gateway/io/tls_stream.hpp"
#include "gateway/io/worker_thread.hpp"
#include "protocol/host/socketcan.hpp"

namespace kinebus {
namespace {

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
