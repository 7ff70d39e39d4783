// Whatever clients of the network give the loop to do begins by the same leave as what their streams bring.

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <string>

#include "gateway/io/http_host.hpp"
#include "gateway/io/job_link_host.hpp"
#include "gateway/io/socket_stream.hpp"
#include "gateway/io/tests/streams_fixture.hpp"
#include "gateway/io/worker_thread.hpp"
#include "gateway/sessions/tests/link_rig.hpp"

namespace kinebus {
namespace {

class HostsTest : public StreamsTest {
 protected:
  LocalTime ahead_ = 50us;  // what is due comes so much later than now: too near for any work
  LinkRig rig_;
  http::Server http_{*rig_.server,
                     *rig_.store,
                     rig_.worker,
                     rig_.control,
                     {.users = http::Users("0123456789abcdef"), .names = {}}};
  StreamHub far_{loop_, {.share = 1, .burst = 1s}};

  HostsTest() {
    far_.keep_clear_of([this] { return monotonic_now() + ahead_; });
  }
  void turn() {
    loop_.wait(monotonic_now());
    far_.on_time(monotonic_now());
  }
  /// From here on there is time for all that waits.
  bool until(const std::function<bool()>& done) {
    ahead_ = 1h;
    const LocalTime limit = monotonic_now() + LocalTime{60s};
    while (!done() && monotonic_now() < limit) {
      far_.on_time(monotonic_now());
      loop_.wait(monotonic_now() + LocalTime{1ms});
    }
    return done();
  }
};

TEST_F(HostsTest, WhatTheWorkerHasDoneIsToldWhenTheStreamsMayWork) {
  WorkerThread worker(loop_);
  worker.pass(far_.gate(worker.fd()));
  bool told = false;
  worker.post([] {}, [&] { told = true; });
  pollfd done{.fd = worker.fd(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(::poll(&done, 1, 60'000), 1);
  turn();
  EXPECT_FALSE(told);
  EXPECT_TRUE(until([&] { return told; }));
}

TEST_F(HostsTest, WhoKnocksIsLetInWhenTheStreamsMayWork) {
  StreamHub near(loop_);
  JobLinkHost job_link(loop_, near, far_, *rig_.server);
  HttpHost http(loop_, far_);
  ASSERT_EQ(job_link.listen_tcp("127.0.0.1:0", folder_.path() / "tls"), "");
  ASSERT_EQ(http.listen("127.0.0.1:0", folder_.path() / "tls", http_), "");
  const auto one = connect_tcp("127.0.0.1", std::to_string(job_link.tcp_port()));
  const auto other = connect_tcp("127.0.0.1", std::to_string(http.port()));
  ASSERT_TRUE(one && other);
  turn();
  EXPECT_EQ(far_.streams(), 0U);
  EXPECT_TRUE(until([&] { return far_.streams() == 2; }));
  ::close(*one);
  ::close(*other);
}

TEST_F(HostsTest, WhoComesByTheJobLinkHasAPlaceWhenTheCrowdAtTheHttpPortHasTakenAllOfIts) {
  StreamHub near(loop_), far(loop_, {.max_streams = 1});
  far.add_side({.max_streams = 1});
  JobLinkHost job_link(loop_, near, far, *rig_.server);
  HttpHost http(loop_, far);
  ASSERT_EQ(job_link.listen_tcp("127.0.0.1:0", folder_.path() / "tls"), "");
  ASSERT_EQ(http.listen("127.0.0.1:0", folder_.path() / "tls", http_), "");
  const auto streams_are = [&](std::size_t count) {
    const LocalTime limit = monotonic_now() + LocalTime{60s};
    while (far.streams() != count && monotonic_now() < limit) {
      far.on_time(monotonic_now());
      loop_.wait(monotonic_now() + LocalTime{1ms});
    }
    return far.streams() == count;
  };
  const auto crowd = connect_tcp("127.0.0.1", std::to_string(http.port()));
  ASSERT_TRUE(crowd && streams_are(1));
  const auto one = connect_tcp("127.0.0.1", std::to_string(job_link.tcp_port()));
  ASSERT_TRUE(one);
  EXPECT_TRUE(streams_are(2));
  ::close(*one);
  ::close(*crowd);
}

}  // namespace
}  // namespace kinebus
