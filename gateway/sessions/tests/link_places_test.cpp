// How many may be connected, for how long without a word, and that nobody is locked out of a stop.

#include "gateway/sessions/tests/raw_client.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

TEST(LinkPlaces, WhoSaysNoHelloIsCutOffOnEveryTransport) {
  LinkRig rig;
  for (const std::string token : {"", "secret"}) {
    const auto silent = rig.server->open(rig.machine.now, {.transport = "x", .token = token});
    const LocalTime begun = rig.machine.now;
    // A byte now and then does not help.
    while (rig.machine.now < begun + 9s) {
      rig.machine.run_for(500ms);
      silent->on_bytes(rig.machine.now, std::vector<std::uint8_t>{'K'});
      silent->on_time(rig.machine.now);
      EXPECT_FALSE(silent->ended());
    }
    EXPECT_LE(silent->next_deadline(), begun + 10s);
    rig.machine.run_for(1s);
    silent->on_time(rig.machine.now);
    EXPECT_TRUE(silent->ended());
  }
  const auto cable = rig.server->open(rig.machine.now, {.transport = "usb", .token = {}, .lasting = true});
  rig.machine.run_for(20s);
  cable->on_time(rig.machine.now);
  EXPECT_FALSE(cable->ended());
}

TEST(LinkPlaces, AClientOfThisComputerThatWasStoppedComesBackOnItsStream) {
  LinkRig rig;
  LinkedClient& here = rig.connect("here");
  LinkedClient& there =
      rig.connect("there", 0, {.transport = "tcp a", .token = {}, .peer = "a", .remote = true});
  ASSERT_FALSE(rig.ask(here, take_control()).has_error());
  // Neither is run: the gateway hears nothing of them.
  const BusTime stopped = rig.machine.now;
  while (rig.machine.now < stopped + 60s) {
    rig.machine.run_for(500ms);
    for (const LinkedClient* client : {&here, &there}) client->session->on_time(rig.machine.now);
  }
  EXPECT_EQ(rig.control.clients().size(), 0U);
  EXPECT_TRUE(there.session->ended());
  ASSERT_FALSE(here.session->ended());
  EXPECT_TRUE(rig.run_until([&] { return here.link.connected() && here.link.client_id() != 1; }, 3s));
  EXPECT_EQ(rig.control.holder(), here.link.client_id());
}

TEST(LinkPlaces, OnlyWhoHasSaidTheTokenRanksBeforeTheOthersAndControlRanksFirst) {
  using Rank = ByteSession::Rank;
  LinkRig rig;
  const SessionInfo far{.transport = "tcp a", .token = "secret", .peer = "a", .remote = true};
  LinkedClient& known = rig.connect("known", 0, far, "secret");
  LinkedClient& wrong = rig.connect("wrong", 0, far, "guessed");
  LinkedClient& here = rig.connect("here");
  const auto silent = rig.server->open(rig.machine.now, far);
  for (const ByteSession* session : {wrong.session.get(), here.session.get(), silent.get()})
    EXPECT_EQ(session->rank(), Rank::kAny);
  EXPECT_EQ(known.session->rank(), Rank::kMayStop);
  ASSERT_FALSE(rig.ask(known, take_control()).has_error());
  EXPECT_EQ(known.session->rank(), Rank::kInControl);
  ASSERT_FALSE(rig.ask(here, take_control(true)).has_error());
  EXPECT_EQ(known.session->rank(), Rank::kMayStop);
  EXPECT_EQ(here.session->rank(), Rank::kAny);
  known.session->on_closed(rig.machine.now, "gone");
  EXPECT_EQ(known.session->rank(), Rank::kAny);
}

TEST(LinkPlaces, AfterAPauseOfTheWholeComputerNobodyIsSilent) {
  LinkRig rig;
  LinkedClient& client = rig.connect("client");
  const auto stranger = rig.server->open(rig.machine.now, {.transport = "x", .token = {}});
  rig.machine.run_for(240s);
  for (ByteSession* session : {client.session.get(), stranger.get()}) {
    session->on_absence(rig.machine.now);
    session->on_time(rig.machine.now);
    EXPECT_FALSE(session->ended());
  }
  EXPECT_EQ(rig.control.clients().size(), 1U);
  rig.run_for(5s);
  EXPECT_TRUE(client.link.connected());
  EXPECT_TRUE(client.all<joblink::Disconnected>().empty());
}

TEST(LinkPlaces, StrangersLockNobodyOut) {
  LinkRig rig;
  std::vector<std::unique_ptr<ByteSession>> greedy;
  const auto other = rig.server->open(rig.machine.now, {.transport = "tcp b", .token = "t", .peer = "b"});
  for (int i = 0; i < 100; ++i)
    greedy.push_back(rig.server->open(rig.machine.now, {.transport = "tcp a", .token = "t", .peer = "a"}));
  EXPECT_FALSE(other->ended());
  EXPECT_LE(std::count_if(greedy.begin(), greedy.end(), [](const auto& s) { return !s->ended(); }), 16);
  EXPECT_TRUE(rig.connect("operator").link.connected());
}

TEST(LinkPlaces, WhenAllPlacesAreTakenEveryoneMayStillStopTheMachine) {
  LinkRig rig;
  for (int i = 0; i < 100; ++i)
    rig.connect("crowd", 0, {.transport = "tcp a", .token = {}, .peer = "a", .remote = true});
  // The network's share is not all there is, and one peer's share is not the network's.
  EXPECT_FALSE(rig.ask(rig.connect("b", 0, {.transport = "tcp b", .token = {}, .peer = "b", .remote = true}),
                       take_control())
                   .has_error());
  EXPECT_FALSE(rig.ask(rig.connect("here"), take_control(true)).has_error());
  for (int i = 0; i < 100; ++i) rig.connect("crowd");
  EXPECT_FALSE(rig.ask(*rig.clients[0], plain(&ClientMessage::mutable_ping)).has_error());
  LinkedClient& late = rig.connect("late");
  ASSERT_TRUE(late.link.connected());
  EXPECT_EQ(rig.ask(late, take_control(true)).error().code(), joblink::ERROR_BUSY);
  EXPECT_FALSE(rig.ask(late, plain(&ClientMessage::mutable_get_status)).has_error());
  EXPECT_FALSE(rig.ask(late, plain(&ClientMessage::mutable_stop)).has_error());
  EXPECT_LE(rig.control.clients().size(), 36U);
  rig.run_until([&] { return late.session->ended(); }, 11s);
  EXPECT_TRUE(late.session->ended());
}

// Who goes when places are taken, and how many there are.

SessionInfo remote_of(const std::string& peer) {
  return {.transport = "tcp", .token = {}, .peer = peer, .remote = true};
}
void fill(LinkRig& rig, int count, const SessionInfo& info) {
  for (int i = 0; i < count; ++i) rig.connect("crowd", 0, info);
}
/// Greeted `count` times; whether the last one is more than a visitor.
bool all_are_let_in(LinkRig& rig, int count, const SessionInfo& info) {
  fill(rig, count - 1, info);
  return !rig.ask(rig.connect("last", 0, info), take_control(true)).has_error();
}

TEST(LinkPlaces, ThereAreEightPlacesForAPeerTwentyFourForASideAndThirtyTwoForAll) {
  for (const bool more : {false, true}) {
    LinkRig peer;
    EXPECT_EQ(all_are_let_in(peer, more ? 9 : 8, remote_of("a")), !more);
    LinkRig side;
    for (const char* other : {"a", "b", "c"})
      all_are_let_in(side, other[0] == 'a' && !more ? 7 : 8, remote_of(other));
    EXPECT_EQ(all_are_let_in(side, 1, remote_of("d")), !more);
    EXPECT_TRUE(all_are_let_in(side, 8, {})) << "of this computer";
    EXPECT_FALSE(all_are_let_in(side, 2, {})) << "all are taken";
    LinkRig here;
    EXPECT_EQ(all_are_let_in(here, more ? 25 : 24, {}), !more)
        << "this computer's share of a peer is all of its side's";
    EXPECT_TRUE(all_are_let_in(here, 8, remote_of("a")));
    EXPECT_FALSE(all_are_let_in(here, 1, remote_of("b")));
  }
}

TEST(LinkPlaces, AStreamThatLastsHasItsPlaceAlways) {
  LinkRig rig;
  for (const char* peer : {"a", "b", "c"}) all_are_let_in(rig, 8, remote_of(peer));
  all_are_let_in(rig, 8, {});
  const SessionInfo cable{.transport = "usb", .token = {}, .lasting = true};
  EXPECT_TRUE(all_are_let_in(rig, 1, cable));
  std::vector<std::unique_ptr<ByteSession>> strangers;
  for (int i = 0; i < 16; ++i) strangers.push_back(rig.server->open(rig.machine.now, remote_of("x")));
  const auto more = rig.server->open(rig.machine.now, cable);
  for (const auto& stranger : strangers) EXPECT_FALSE(stranger->ended()) << "it takes nobody's place";
}

TEST(LinkPlaces, TheOldestStrangerOfThePeerWithMostOfThemGoes) {
  LinkRig rig;
  std::vector<std::unique_ptr<ByteSession>> few, many;
  for (int i = 0; i < 7; ++i) few.push_back(rig.server->open(rig.machine.now, remote_of("few")));
  for (int i = 0; i < 9; ++i) many.push_back(rig.server->open(rig.machine.now, remote_of("many")));
  const auto ended = [](const auto& of) {
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < of.size(); ++i)
      if (of[i]->ended()) at.push_back(i);
    return at;
  };
  using At = std::vector<std::size_t>;
  EXPECT_EQ(ended(many), At());
  few.push_back(rig.server->open(rig.machine.now, remote_of("few")));
  EXPECT_EQ(ended(many), At{0});
  // Eight of each: the one whose stranger waits longest.
  few.push_back(rig.server->open(rig.machine.now, remote_of("few")));
  EXPECT_EQ(ended(many), At{0});
  EXPECT_EQ(ended(few), At{0});
  // Who names no peer is known by its transport.
  LinkRig other;
  std::vector<std::unique_ptr<ByteSession>> a, b;
  for (int i = 0; i < 6; ++i)
    a.push_back(other.server->open(other.machine.now, {.transport = "a", .token = {}}));
  for (int i = 0; i < 11; ++i)
    b.push_back(other.server->open(other.machine.now, {.transport = "b", .token = {}}));
  EXPECT_EQ(ended(a), At());
  EXPECT_EQ(ended(b), At{0});
}

TEST(LinkPlaces, WhoHadControlIsNoVisitorWhenItComesBackAndOnlyOnce) {
  LinkRig rig;
  RawClient anna(rig, remote_of("z"));
  const std::string key = anna.greet(1).hello().resume_key();
  ASSERT_FALSE(anna.ask(take_control()).has_error());
  anna.stream->on_closed(rig.machine.now, "unplugged");
  for (const char* peer : {"a", "b", "c"}) fill(rig, 8, remote_of(peer));
  RawClient other(rig, remote_of("y")), back(rig, remote_of("z")), again(rig, remote_of("z"));
  other.greet(1, hello_of({}, "guessed"));
  EXPECT_EQ(other.ask(take_control()).error().code(), joblink::ERROR_BUSY);
  EXPECT_EQ(rig.control.holder(), 0U);
  const auto hello = back.greet(1, hello_of({}, key)).hello();
  EXPECT_EQ(rig.control.holder(), hello.client_id());
  EXPECT_FALSE(back.ask(plain(&ClientMessage::mutable_release_control)).has_error());
  EXPECT_EQ(rig.control.holder(), 0U);
  again.greet(1, hello_of({}, key));
  EXPECT_EQ(rig.control.holder(), 0U) << "the key was for once";
  EXPECT_EQ(again.ask(take_control()).error().code(), joblink::ERROR_BUSY);
}

TEST(LinkPlaces, AKeyThatNobodyHasGivesNothingAndEndsNobody) {
  LinkRig rig;
  RawClient anna(rig), bert(rig), nobody(rig), guesser(rig), stranger(rig);
  const std::string key = anna.greet(1).hello().resume_key();
  bert.greet(1);
  nobody.greet(1, hello_of({}, ""));
  EXPECT_EQ(rig.control.clients().size(), 3U);
  EXPECT_FALSE(stranger.stream->ended());
  ASSERT_FALSE(anna.ask(take_control()).has_error());
  guesser.greet(1, hello_of({}, key.substr(1)));
  EXPECT_EQ(rig.control.clients().size(), 4U);
  EXPECT_NE(rig.control.holder(), 0U);
  anna.stream->on_closed(rig.machine.now, "unplugged");
  guesser.greet(2, hello_of({}, key.substr(1)));
  nobody.greet(2, hello_of({}, ""));
  EXPECT_EQ(rig.control.holder(), 0U);
}

TEST(LinkPlaces, AVisitMayStopAskAndWatchAndNothingElseForTenSeconds) {
  LinkRig rig;
  all_are_let_in(rig, 8, remote_of("a"));
  RawClient visitor(rig, remote_of("a"));
  ASSERT_TRUE(visitor.greet(1).has_hello());
  ClientMessage watch, chunk, begin;
  watch.mutable_watch();
  chunk.mutable_upload_chunk()->set_data("G1");
  begin.mutable_upload_begin()->set_name("a");
  for (const ClientMessage& may : {plain(&ClientMessage::mutable_ping), plain(&ClientMessage::mutable_stop),
                                   plain(&ClientMessage::mutable_get_status), watch})
    EXPECT_FALSE(visitor.ask(may).has_error());
  for (const ClientMessage& may_not :
       {chunk, begin, take_control(), plain(&ClientMessage::mutable_get_machine),
        plain(&ClientMessage::mutable_list_jobs)})
    EXPECT_EQ(visitor.ask(may_not).error().code(), joblink::ERROR_BUSY);
  const BusTime begun = rig.machine.now;
  while (rig.machine.now < begun + 9s) {
    rig.machine.run_for(500ms);
    visitor.say(plain(&ClientMessage::mutable_ping));
    visitor.stream->on_time(rig.machine.now);
  }
  EXPECT_FALSE(visitor.stream->ended());
  EXPECT_LE(visitor.stream->next_deadline(), begun + 10s);
  rig.machine.run_for(1s);
  visitor.hear();
  visitor.stream->on_time(rig.machine.now);
  EXPECT_TRUE(visitor.stream->ended());
  const auto said = visitor.hear();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_FALSE(said[0].session_end().reason().empty());
}

TEST(LinkPlaces, OfVisitorsFourAreHereAndTheOldestGoes) {
  LinkRig rig;
  all_are_let_in(rig, 8, remote_of("a"));
  std::vector<std::unique_ptr<RawClient>> visitors;
  for (int i = 0; i < 5; ++i) {
    visitors.push_back(std::make_unique<RawClient>(rig, remote_of("a")));
    visitors.back()->greet(1);
    EXPECT_EQ(visitors[0]->stream->ended(), i == 4);
  }
  for (std::size_t i = 1; i < 5; ++i) EXPECT_FALSE(visitors[i]->stream->ended());
}

}  // namespace
}  // namespace kinebus
