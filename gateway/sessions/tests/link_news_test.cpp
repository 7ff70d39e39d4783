// What clients are told without delay and of what time, and what the history and the store keep of a run.

#include "gateway/sessions/tests/raw_client.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

const ClientMessage kGetStatus = plain(&ClientMessage::mutable_get_status);

TEST(LinkNews, AHelloIsAnsweredWithWhatTheGatewayIsAndTakes) {
  LinkRig rig;
  RawClient first(rig), raw(rig);
  first.greet(1);
  rig.server->on_event(rig.machine.now, MachineEvent{});
  const joblink::HelloReply hello = raw.greet(1).hello();
  EXPECT_EQ(hello.version_minor(), joblink::kVersionMinor);
  EXPECT_EQ(hello.gateway_version(), "test");
  EXPECT_EQ(hello.gateway_id(), "id");
  EXPECT_EQ(hello.client_id(), 2U);
  EXPECT_EQ(hello.resume_key().size(), 16U);
  EXPECT_EQ(hello.max_chunk_bytes(), Requester::kMaxChunk);
  EXPECT_EQ(hello.upload_window_bytes(), Requester::kUploadWindow);
  EXPECT_EQ(hello.event_id(), rig.server->events().newest());
  EXPECT_GT(hello.event_id(), 0U);
}

TEST(LinkNews, AStatusIsThatAfterTheLastCommandAndTellsWhoIsHere) {
  LinkRig rig;
  RawClient anna(rig, {.transport = "usb", .token = {}}), bert(rig, {.transport = "tcp b", .token = {}});
  anna.greet(1);
  EXPECT_EQ(anna.ask(kGetStatus).status().clients_size(), 1);
  bert.greet(1);
  EXPECT_EQ(anna.ask(kGetStatus).status().clients_size(), 2);
  anna.ask(take_control());
  auto status = anna.ask(kGetStatus).status();
  ASSERT_EQ(status.clients_size(), 2);
  EXPECT_EQ(status.controller(), 1U);
  EXPECT_EQ(status.clients(1).id(), 2U);
  EXPECT_EQ(status.clients(1).name(), "raw");
  EXPECT_EQ(status.clients(1).transport(), "tcp b");
  ClientMessage faster;
  faster.mutable_set_override()->set_ratio(1.5);
  EXPECT_FALSE(anna.ask(faster).has_error());
  EXPECT_EQ(anna.ask(kGetStatus).status().feed_override(), 1.5);
  EXPECT_EQ(bert.ask(kGetStatus).status().feed_override(), 1.5);
}

TEST(LinkNews, WhoHasControlIsToldWhenItMoves) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  const auto last = [&] {
    joblink::Event control;
    for (const auto& event : anna.all<joblink::Event>())
      if (event.kind() == joblink::EVENT_CONTROL) control = event;
    return control;
  };
  rig.ask(anna, take_control());
  EXPECT_EQ(last().client(), anna.link.client_id());
  EXPECT_EQ(last().words(), "anna has control");
  EXPECT_EQ(last().said().text(), "%1 has control");
  rig.ask(anna, plain(&ClientMessage::mutable_release_control));
  EXPECT_EQ(last().client(), 0U);
  EXPECT_EQ(last().words(), "nobody has control");
}

TEST(LinkNews, AnEventHasTheTimeAtWhichItHappenedByBothClocks) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  rig.machine.run_for(5s);
  rig.server->wall_clock(1000);
  MachineEvent event;
  event.kind = MachineEvent::Kind::kMessage;
  event.when = 3s;
  rig.server->on_event(rig.machine.now, event);
  raw.ask(take_control());
  rig.server->on_time(rig.machine.now);
  const auto events = raw.ask(plain(&ClientMessage::mutable_get_events)).events();
  ASSERT_EQ(events.events_size(), 2);
  EXPECT_EQ(events.events(0).time_s(), 3);
  EXPECT_EQ(events.events(0).unix_s(), 1003);
  EXPECT_NEAR(events.events(1).time_s(), 5, 0.1) << "told now";
  EXPECT_NEAR(events.events(1).unix_s(), 1005, 0.1);
}

/// A machine that is homed, and one client.
class LinkRunTest : public ::testing::Test {
 protected:
  LinkRig rig_;
  LinkedClient* anna_ = nullptr;
  const std::string text_ = "G21 G90\nG0 X0 Y0 Z5\nG1 X20 F600\nG1 X0\nG1 X20\n";
  void SetUp() override {
    ASSERT_TRUE(rig_.machine.make_ready()) << rig_.machine.story();
    anna_ = &rig_.connect("anna");
  }
  void store(const std::string& name, const std::string& text) {
    rig_.upload(*anna_, name, text);
    rig_.pump();
  }
  joblink::Reply start(const std::string& name) {
    ClientMessage message;
    message.mutable_start_job()->set_name(name);
    return rig_.ask(*anna_, message);
  }
  bool reach(MachineState state, BusTime limit = 60s) {
    return rig_.run_until([&] { return rig_.machine.gateway->state() == state; }, limit);
  }
  std::vector<joblink::JobRun> history() {
    const auto runs = rig_.ask(*anna_, plain(&ClientMessage::mutable_get_history)).history();
    return {runs.runs().begin(), runs.runs().end()};
  }
  /// The text that an interrupted job of this name would go on with.
  std::string kept(const std::string& name) {
    auto source = rig_.store->open_kept(name);
    if (!source) return {};
    std::string text(200, '\0');
    text.resize((*source)->read(text));
    return text;
  }
};

TEST_F(LinkRunTest, ARunningJobKeepsItsTextWhoeverReplacesIt) {
  store("a", text_);
  ASSERT_FALSE(start("a").has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->status().line > 2; }, 30s));
  store("a", "G1 X1\n");
  EXPECT_EQ(kept("a"), text_);
  ASSERT_TRUE(reach(MachineState::kReady));
  rig_.pump();
  EXPECT_EQ(kept("a"), "G1 X1\n") << "it is over";
  EXPECT_GT(history().at(0).line(), 2U);
}

TEST_F(LinkRunTest, AnInterruptedJobKeepsItsTextAndGoesOnAsARunOfItsOwn) {
  store("a", text_);
  ASSERT_FALSE(start("a").has_error());
  ASSERT_TRUE(rig_.run_until([&] { return rig_.machine.gateway->status().line > 2; }, 30s));
  rig_.ask(*anna_, plain(&ClientMessage::mutable_stop));
  ASSERT_TRUE(reach(MachineState::kStopped));
  EXPECT_FALSE(rig_.ask(*anna_, plain(&ClientMessage::mutable_motors_off)).has_error());
  rig_.run_for(1s);
  EXPECT_EQ(history().size(), 1U);
  store("a", "G1 X1\n");
  EXPECT_EQ(kept("a"), text_) << "it may go on";
  EXPECT_FALSE(rig_.ask(*anna_, plain(&ClientMessage::mutable_resume)).has_error());
  ASSERT_TRUE(reach(MachineState::kRunning, 200s)) << rig_.machine.story();
  ASSERT_TRUE(reach(MachineState::kReady, 100s)) << rig_.machine.story();
  rig_.pump();
  const auto runs = history();
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].name(), "a");
  EXPECT_EQ(runs[0].result(), joblink::JOB_COMPLETE);
  EXPECT_GT(runs[0].duration_s(), 1);
  EXPECT_LT(runs[0].duration_s(), 60);
  EXPECT_EQ(runs[0].hash().size(), 16U);
  EXPECT_EQ(kept("a"), "G1 X1\n");
}

TEST_F(LinkRunTest, WhatTheMachineWouldNotTakeIsNoRunUnlessItRunsOnce) {
  for (const char* name : {"a", "b.once.gcode"}) store(name, text_);
  EXPECT_FALSE(rig_.ask(*anna_, plain(&ClientMessage::mutable_motors_off)).has_error());
  EXPECT_EQ(start("a").error().code(), joblink::ERROR_MACHINE_STATE);
  rig_.pump();
  EXPECT_EQ(history().size(), 0U);
  EXPECT_EQ(start("b.once.gcode").error().code(), joblink::ERROR_MACHINE_STATE);
  rig_.pump();
  const auto runs = history();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].result(), joblink::JOB_REFUSED);
  EXPECT_EQ(runs[0].duration_s(), 0);
  EXPECT_FALSE(runs[0].first_error_said().text().empty());
  EXPECT_EQ(start("none").error().code(), joblink::ERROR_NO_SUCH_JOB);
}

}  // namespace
}  // namespace kinebus
