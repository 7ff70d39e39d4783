// How many may be connected, for how long without a word, and that nobody is locked out of a stop.

#include "gateway/sessions/tests/link_rig.hpp"

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

}  // namespace
}  // namespace kinebus
