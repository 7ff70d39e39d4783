// Who may stop the machine is heard before the others, and takes little from them.

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "gateway/io/socket_stream.hpp"
#include "gateway/io/tests/streams_fixture.hpp"

namespace kinebus {
namespace {

using Rank = ByteSession::Rank;

/// Notes its letter when it hears something, and then does what it is told.
class Noted : public Laborious {
 public:
  Noted(char letter, std::string* order, Rank rank, std::function<void()> then = {})
      : Laborious(&heard_), letter_(letter), order_(order), rank_(rank), then_(std::move(then)) {}
  void on_bytes(LocalTime now, std::span<const std::uint8_t> bytes) override {
    *order_ += letter_;
    Laborious::on_bytes(now, bytes);
    if (then_) then_();
  }
  Rank rank() const override { return rank_; }
  void rises_to(Rank rank) { rank_ = rank; }

 private:
  int heard_ = 0;
  char letter_;
  std::string* order_;
  Rank rank_;
  std::function<void()> then_;
};

class LanesTest : public StreamsTest {
 protected:
  static constexpr StreamHub::Options kLane{.share = 0.5, .burst = 100ms, .at_once = true};
  /// Some piece was always the longest: what is near in time is not looked at here.
  StreamHub far_{loop_, {.share = 0.02, .burst = 2ms}};
  std::string order_;
  std::vector<int> ends_;

  ~LanesTest() override {
    for (const int end : ends_) ::close(end);
  }
  /// Where its client speaks.
  int add(StreamHub& hub, char letter, Rank rank, std::function<void()> then = {}, Noted** made = nullptr) {
    std::array<int, 2> both{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, both.data()), 0);
    auto session = std::make_unique<Noted>(letter, &order_, rank, std::move(then));
    if (made != nullptr) *made = session.get();
    EXPECT_TRUE(hub.add(std::make_unique<SocketStream>(both[0]), std::move(session)));
    ends_.push_back(both[1]);
    return both[1];
  }
  static void say(int end) { [[maybe_unused]] const ssize_t sent = ::send(end, "x", 1, MSG_DONTWAIT); }
  void turn() {
    far_.on_time(monotonic_now());
    loop_.wait(std::min(far_.next_deadline(), monotonic_now() + LocalTime{1ms}));
  }
  int heard(char letter) const { return static_cast<int>(std::count(order_.begin(), order_.end(), letter)); }
};

TEST_F(LanesTest, WhoMayStopIsHeardWhileTheOthersRest) {
  far_.add_lane(Rank::kMayStop, kLane);
  const int flood = add(far_, 'f', Rank::kAny), calm = add(far_, 'c', Rank::kMayStop);
  for (int i = 0; i < 20; ++i) {
    say(flood);
    turn();
  }
  far_.on_time(monotonic_now());
  for (int i = 0; i < 20; ++i) {
    say(flood);
    say(calm);
    order_.clear();
    loop_.wait(monotonic_now());
    EXPECT_EQ(heard('c'), 1) << "turn " << i << ", heard: " << order_;
    far_.on_time(monotonic_now());
  }
}

TEST_F(LanesTest, OnlyWhoseSessionSaysSoIsInALaneAndOnlyWhileItDoes) {
  far_.add_lane(Rank::kMayStop, kLane);
  far_.add_lane(Rank::kInControl, kLane);
  Noted* session = nullptr;
  add(far_, 's', Rank::kAny);
  add(far_, 'c', Rank::kAny, {}, &session);
  const auto first = [&] {
    far_.on_time(monotonic_now());
    return far_.streams_first();
  };
  EXPECT_EQ(first(), 0U);
  for (const Rank rank : {Rank::kMayStop, Rank::kInControl}) {
    session->rises_to(rank);
    EXPECT_EQ(first(), 1U);
    EXPECT_EQ(far_.streams(), 2U);
  }
  session->rises_to(Rank::kAny);
  EXPECT_EQ(first(), 0U);
  EXPECT_EQ(far_.streams(), 2U);
}

/// A lane, or the hub of this computer.
class BetweenPieces : public LanesTest, public ::testing::WithParamInterface<bool> {};

TEST_P(BetweenPieces, WhatComesMeanwhileIsHeardBeforeTheNextPieceAndThenTheBusHasItsTurn) {
  StreamHub far(loop_, {.work_per_turn = 100ms, .share = 1, .burst = 1s});
  StreamHub near(loop_, kLane);
  if (GetParam())
    far.add_lane(Rank::kInControl, kLane);
  else
    far.comes_after(near);
  const int calm = add(GetParam() ? far : near, 'c', Rank::kInControl);
  int left = 1;
  std::array<int, 6> crowd{};
  for (int& end : crowd)
    end = add(far, 'f', Rank::kAny, [&] {
      if (left-- == 1) say(calm);
    });
  far.on_time(monotonic_now());
  for (const int end : crowd) say(end);
  loop_.wait(monotonic_now());
  EXPECT_EQ(order_, "fc");
  near.on_time(monotonic_now());
  far.on_time(monotonic_now());
  loop_.wait(monotonic_now());
  EXPECT_EQ(order_, "fcfffff");
}
INSTANTIATE_TEST_SUITE_P(Lanes, BetweenPieces, ::testing::Bool(),
                         [](const auto& of) { return of.param ? "ALane" : "ThisComputer"; });

TEST_F(LanesTest, WhoTakesMuchWaitsWithTheOthersAndKeepsNobodyFromTheLane) {
  StreamHub::Options lane = kLane;
  lane.frugal = {.share = 0.05, .burst = 3ms, .pause = 200ms};
  far_.add_lane(Rank::kMayStop, lane);
  const int flood = add(far_, 'f', Rank::kMayStop), calm = add(far_, 'c', Rank::kMayStop);
  turn();
  EXPECT_EQ(far_.streams_first(), 2U);
  LocalTime begin = monotonic_now();
  while (far_.streams_first() == 2 && monotonic_now() < begin + LocalTime{10s}) {
    say(flood);
    turn();
  }
  EXPECT_EQ(far_.streams_first(), 1U);
  EXPECT_GE(heard('f'), 5);
  order_.clear();
  say(calm);
  loop_.wait(monotonic_now());
  EXPECT_EQ(order_, "c");
  // Who gives peace is back after a while.
  begin = monotonic_now();
  while (far_.streams_first() == 1 && monotonic_now() < begin + LocalTime{10s}) turn();
  EXPECT_EQ(far_.streams_first(), 2U);
  EXPECT_GE(monotonic_now() - begin, LocalTime{100ms});
}

TEST_F(LanesTest, WhoHasJustComeIsInNoLane) {
  StreamHub::Options lane = kLane;
  lane.frugal.trial = 200ms;
  far_.add_lane(Rank::kMayStop, lane);
  Noted* session = nullptr;
  add(far_, 's', Rank::kAny, {}, &session);
  turn();
  session->rises_to(Rank::kMayStop);
  const LocalTime begin = monotonic_now();
  turn();
  EXPECT_EQ(far_.streams_first(), 0U);
  while (far_.streams_first() == 0 && monotonic_now() < begin + LocalTime{10s}) turn();
  EXPECT_EQ(far_.streams_first(), 1U);
  EXPECT_GE(monotonic_now() - begin, LocalTime{200ms});
}

/// Each takes less than is frugal for one.
TEST_F(LanesTest, ManyWhoTakeAPartEachDoNotFillTheLane) {
  StreamHub::Options lane = kLane;
  lane.frugal = {.share = 0.2, .burst = 3ms, .pause = 300ms};
  lane.frugal_together = 0.1;
  StreamHub hub(loop_, {.share = 1, .burst = 1s});
  hub.add_lane(Rank::kMayStop, lane);
  std::array<int, 10> crowd{};
  for (int& end : crowd) end = add(hub, 'f', Rank::kMayStop);
  add(hub, 'c', Rank::kMayStop);
  // 5 % of the loop's time each, which is half a millisecond every 10: until they have stayed out for three
  // pauses.
  const LocalTime begin = monotonic_now();
  LocalTime now = begin, next = begin, out_since = begin;
  while (now < out_since + LocalTime{900ms} && now < begin + LocalTime{60s}) {
    if (now >= next) {
      next = now + LocalTime{10ms};
      for (const int end : crowd) say(end);
    }
    hub.on_time(now);
    loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    now = monotonic_now();
    if (hub.streams_first() != 1) out_since = now;
  }
  EXPECT_GE(now, out_since + LocalTime{900ms})
      << "one takes nothing, and " << hub.streams_first() << " are in the lane";
}

TEST_F(LanesTest, WhoIsApartIsHeardWhileTheCrowdRestsAndHasPlacesWhenItHasNone) {
  int closed = 0;  // told when the hub ends
  StreamHub hub(loop_, {.max_streams = 2, .share = 0.02, .burst = 2ms});
  hub.add_lane(Rank::kMayStop, kLane);
  hub.add_side({.max_streams = 1, .share = 0.5, .burst = 100ms, .at_once = true});
  const std::array<int, 2> crowd{add(hub, 'f', Rank::kAny), add(hub, 'f', Rank::kAny)};
  const auto newcomer = [&](int* told, StreamHub::Side side) {
    std::array<int, 2> both{};
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, both.data()), 0);
    ends_.push_back(both[1]);
    return hub.add(std::make_unique<SocketStream>(both[0]), std::make_unique<Echo>(told), side);
  };
  EXPECT_FALSE(newcomer(&closed, StreamHub::Side::kCommon));
  ASSERT_TRUE(newcomer(&closed, StreamHub::Side::kApart));
  const int apart = ends_.back();
  EXPECT_FALSE(newcomer(&closed, StreamHub::Side::kApart));
  EXPECT_EQ(hub.streams(), 3U);
  for (int i = 0; i < 20; ++i) {
    for (const int end : crowd) say(end);
    hub.on_time(monotonic_now());
    loop_.wait(monotonic_now());
  }
  for (int i = 0; i < 20; ++i) {
    for (const int end : crowd) say(end);
    hub.on_time(monotonic_now());
    say(apart);
    loop_.wait(monotonic_now());
    char heard = 0;
    EXPECT_EQ(::recv(apart, &heard, 1, MSG_DONTWAIT), 1) << "turn " << i;
  }
  EXPECT_EQ(hub.streams_first(), 0U);
}

TEST_F(LanesTest, WhoIsApartAndFrugalIsInTheLaneOfItsRankAndComesBack) {
  StreamHub hub(loop_, {.share = 0.5, .burst = 100ms});
  hub.add_lane(Rank::kInControl, kLane);
  hub.add_side({.max_streams = 1, .share = 0.5, .burst = 100ms});
  std::array<int, 2> both{};
  ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, both.data()), 0);
  ends_.push_back(both[1]);
  auto made = std::make_unique<Noted>('c', &order_, Rank::kInControl);
  Noted& session = *made;
  ASSERT_TRUE(hub.add(std::make_unique<SocketStream>(both[0]), std::move(made), StreamHub::Side::kApart));
  const auto heard_in = [&](std::size_t first) {
    hub.on_time(monotonic_now());
    EXPECT_EQ(hub.streams_first(), first);
    order_.clear();
    say(both[1]);
    loop_.wait(monotonic_now());
    EXPECT_EQ(order_, "c");
    int closed = 0;
    EXPECT_FALSE(hub.add(nullptr, std::make_unique<Echo>(&closed), StreamHub::Side::kApart)) << "its place";
  };
  heard_in(1);
  session.rises_to(Rank::kAny);
  heard_in(0);
}

TEST_F(LanesTest, WhatALaneTakesItsHubPays) {
  StreamHub hub(loop_, {.share = 0.2, .burst = 10ms});
  hub.add_lane(Rank::kMayStop, {.share = 0.15, .burst = 10ms, .at_once = true});
  const int any = add(hub, 'f', Rank::kAny), first = add(hub, 'c', Rank::kMayStop);
  const LocalTime begin = monotonic_now();
  LocalTime now = begin;
  while (now < begin + LocalTime{400ms} || order_.size() < 20) {
    say(any);
    say(first);
    hub.on_time(now);
    loop_.wait(std::min(hub.next_deadline(), now + LocalTime{1ms}));
    now = monotonic_now();
  }
  // Both together, a turn behind each rest of 20 ms, and what was saved.
  const double bound_s = 0.020 + (0.2 + 0.03) * to_seconds(now - begin) + 0.004;
  EXPECT_LE(static_cast<double>(order_.size()) * 0.0005, bound_s) << order_;
  EXPECT_GE(heard('c'), 20);
  EXPECT_GE(heard('f'), 10);
}

}  // namespace
}  // namespace kinebus
