// A conversation frame by frame: who is let in, what a frame that is lost or half does, and how long anything
// may take.

#include "gateway/sessions/tests/raw_client.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

const ClientMessage kPing = plain(&ClientMessage::mutable_ping);
const ClientMessage kStop = plain(&ClientMessage::mutable_stop);
const ClientMessage kBringUp = plain(&ClientMessage::mutable_bring_up);

/// What was said, if it is answered at all.
void expect_all_refused(RawClient& raw) {
  for (const auto& message : raw.hear())
    EXPECT_EQ(message.reply().error().code(), joblink::ERROR_NOT_ALLOWED);
}

TEST(LinkSession, AnotherVersionIsRefusedAndTheClientMayTryAgain) {
  LinkRig rig;
  RawClient raw(rig);
  ClientMessage hello = hello_of();
  hello.mutable_hello()->set_version_major(joblink::kVersionMajor + 1);
  EXPECT_EQ(raw.greet(1, hello).error().code(), joblink::ERROR_VERSION);
  EXPECT_EQ(raw.ask(kBringUp).error().code(), joblink::ERROR_NOT_ALLOWED) << "it was not let in";
  EXPECT_FALSE(raw.stream->ended());
  EXPECT_TRUE(raw.greet(2).has_hello());
}

TEST(LinkSession, ATokenIsRightOnlyWhole) {
  for (const std::string token : {"", "s", "secre", "secret!", "Secret", "secreT"}) {
    LinkRig rig;
    RawClient raw(rig, {.transport = "tcp a", .token = "secret"});
    EXPECT_EQ(raw.greet(1, hello_of(token)).error().code(), joblink::ERROR_NOT_ALLOWED) << token;
    EXPECT_TRUE(raw.stream->ended());
    EXPECT_FALSE(raw.stream->wants_bytes());
    EXPECT_TRUE(rig.control.clients().empty());
  }
}

TEST(LinkSession, WhoWasNotLetInStopsNothing) {
  LinkRig rig;
  ASSERT_TRUE(rig.machine.gateway->carry_out(command::BringUp{}));
  RawClient raw(rig, {.transport = "tcp a", .token = "secret"});
  for (const std::uint32_t session : {0U, 1U})
    for (const std::uint32_t sequence : {0U, 1U}) raw.say_as(session, sequence, kStop.SerializeAsString());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kBringUp);
  expect_all_refused(raw);
  raw.greet(1, hello_of("secret"));
  raw.say_as(2, 1, kStop.SerializeAsString());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kBringUp) << "of another session";
  raw.say(kStop);
  EXPECT_NE(rig.machine.gateway->state(), MachineState::kBringUp);
}

TEST(LinkSession, AStopIsSeenAheadOfItsTurnWhateverNumberItHas) {
  for (const std::uint32_t request : {0U, 1U, 300U, 0xFFFF'FFFFU}) {
    LinkRig rig;
    RawClient raw(rig);
    raw.greet(1);
    raw.say(kBringUp);
    ASSERT_EQ(rig.machine.gateway->state(), MachineState::kBringUp);
    ClientMessage stop = kStop;
    stop.set_request_id(request);
    std::string bytes;
    joblink::append_frame(bytes, 1, raw.sequence, kPing.SerializeAsString());
    joblink::append_frame(bytes, 1, raw.sequence + 1, stop.SerializeAsString());
    raw.send(bytes);
    EXPECT_NE(rig.machine.gateway->state(), MachineState::kBringUp) << request;
  }
}

TEST(LinkSession, WhatOnlyEndsLikeAStopIsNone) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  raw.say(kBringUp);
  ClientMessage chunk;
  chunk.mutable_upload_chunk()->set_data(std::string("\xE2\x02\x00", 3));
  raw.say(chunk);
  EXPECT_TRUE(raw.last_reply().has_error());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kBringUp);
}

TEST(LinkSession, AnUploadNeedsAHelloToo) {
  LinkRig rig;
  RawClient raw(rig, {.transport = "tcp a", .token = "secret"});
  ClientMessage hello = hello_of("secret");
  hello.mutable_hello()->set_version_major(99);
  raw.greet(1, hello);
  ClientMessage chunk;
  chunk.set_request_id(5);
  chunk.mutable_upload_chunk()->set_upload_id(1);
  chunk.mutable_upload_chunk()->set_data("G1");
  raw.say(chunk);
  const auto reply = raw.last_reply();
  EXPECT_EQ(reply.request_id(), 5U);
  EXPECT_EQ(reply.error().code(), joblink::ERROR_NOT_ALLOWED);
}

TEST(LinkSession, AHelloAnewEndsWhatTheOldSessionHad) {
  LinkRig rig;
  RawClient raw(rig);
  const auto first = raw.greet(1).hello();
  EXPECT_FALSE(raw.ask(take_control()).has_error());
  const auto second = raw.greet(2).hello();
  EXPECT_NE(second.client_id(), first.client_id());
  EXPECT_NE(second.resume_key(), first.resume_key());
  EXPECT_EQ(rig.control.clients().size(), 1U);
  EXPECT_EQ(rig.control.holder(), 0U) << "it has not proved to be the same";
  raw.greet(3, hello_of({}, first.resume_key()));
  EXPECT_NE(rig.control.holder(), 0U) << "now it has";
  // The old session's frames are nobody's.
  raw.say_as(1, 2, kBringUp.SerializeAsString());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kOff);
}

TEST(LinkSession, AMessageThatIsLostOrCannotBeReadEndsTheSessionUntilTheNextHello) {
  for (const bool lost : {true, false}) {
    LinkRig rig;
    RawClient raw(rig);
    raw.greet(1);
    ASSERT_FALSE(raw.ask(take_control()).has_error());
    if (lost)
      raw.say_as(1, raw.sequence + 1, kPing.SerializeAsString());
    else
      raw.say_as(1, raw.sequence, "\xFF\xFF\xFF");
    const auto heard = raw.hear();
    ASSERT_EQ(heard.size(), 1U);
    EXPECT_TRUE(heard[0].session_end().resync());
    EXPECT_FALSE(heard[0].session_end().reason().empty());
    EXPECT_EQ(raw.heard_session, 1U);
    EXPECT_TRUE(rig.control.clients().empty());
    for (const std::uint32_t session : {0U, 1U})
      for (std::uint32_t number = 0; number < 5; ++number)
        raw.say_as(session, number, kBringUp.SerializeAsString());
    expect_all_refused(raw);
    EXPECT_EQ(rig.machine.gateway->state(), MachineState::kOff);
    EXPECT_TRUE(raw.greet(2).has_hello());
  }
}

TEST(LinkSession, AHalfFrameIsGivenUpAndTheNextOneHeard) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  std::string half;
  ClientMessage console;
  console.mutable_console()->set_line(std::string(500, 'x'));
  joblink::append_frame(half, 1, 1, console.SerializeAsString());
  half.resize(half.size() - 100);
  raw.send(half);
  raw.stream->on_time(rig.machine.now);
  rig.machine.run_for(100ms);
  std::string next;
  joblink::append_frame(next, 1, 1, kPing.SerializeAsString());
  raw.send(next.substr(0, 10));
  raw.stream->on_time(rig.machine.now);
  const BusTime heard = rig.machine.now;
  EXPECT_LE(raw.stream->next_deadline(), heard + 800ms);
  rig.machine.run_for(700ms);
  raw.stream->on_time(rig.machine.now);
  EXPECT_TRUE(raw.hear().empty());
  rig.machine.run_for(100ms);
  raw.stream->on_time(rig.machine.now);
  raw.work();
  raw.send(next.substr(10));
  raw.work();
  // What was given up is gone with the frame that began within it; the one after it is heard.
  raw.send(next);
  raw.work();
  const auto heard_at_last = raw.hear();
  ASSERT_EQ(heard_at_last.size(), 1U);
  EXPECT_TRUE(heard_at_last[0].has_reply());
}

TEST(LinkSession, SilenceEndsAClientAtItsLimitAndNotBefore) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const BusTime heard = rig.machine.now;
  EXPECT_EQ(raw.stream->next_deadline(), heard + 8s);
  rig.machine.run_for(8s - 1ms);
  raw.stream->on_time(rig.machine.now);
  EXPECT_EQ(rig.control.clients().size(), 1U);
  rig.machine.run_for(1ms);
  raw.stream->on_time(rig.machine.now);
  EXPECT_TRUE(rig.control.clients().empty());
  const auto said = raw.hear();
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].session_end().resync()) << "so that it says hello again";
  EXPECT_GT(raw.stream->next_deadline(), rig.machine.now) << "nothing is due any more";
}

TEST(LinkSession, StatusesComeAsOftenAsAskedForWithinBounds) {
  for (const auto& [asked_hz, statuses] :
       {std::pair{0., 0}, std::pair{-1., 0}, std::pair{0.001, 1}, std::pair{10., 10}, std::pair{1e6, 50}}) {
    LinkRig rig;
    RawClient raw(rig);
    raw.greet(1);
    ClientMessage watch;
    watch.mutable_watch()->set_status_hz(asked_hz);
    EXPECT_FALSE(raw.ask(watch).has_error());
    int heard = 0;
    for (int i = 0; i < 500; ++i) {
      raw.stream->on_time(rig.machine.now);
      for (const auto& message : raw.hear()) heard += message.has_status() ? 1 : 0;
      rig.machine.run_for(2ms);
    }
    EXPECT_NEAR(heard, statuses, statuses == 0 ? 0 : 1) << asked_hz;
    // Until it no longer wants them.
    EXPECT_FALSE(raw.ask(plain(&ClientMessage::mutable_watch)).has_error());
    rig.machine.run_for(1s);
    raw.stream->on_time(rig.machine.now);
    EXPECT_TRUE(raw.hear().empty());
  }
}

TEST(LinkSession, WhoReadsSlowlyGetsTheNewestStatusAndNotAllOldOnes) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  ClientMessage watch;
  watch.mutable_watch()->set_status_hz(50);
  watch.mutable_watch()->set_events(true);
  EXPECT_FALSE(raw.ask(watch).has_error());
  for (int i = 0; i < 3000; ++i) {
    raw.say(kPing);
    MachineEvent event;
    event.kind = MachineEvent::Kind::kMessage;
    event.words = Sentence::verbatim(std::string(300, 'w'));
    rig.server->on_event(rig.machine.now, event);
    raw.stream->on_time(rig.machine.now + i * 20ms);
    static_cast<void>(raw.stream->next_bytes());
  }
  EXPECT_LT(raw.stream->next_bytes().size(), 200U << 10)
      << "three thousand small replies, and 64 KiB of news";
}

TEST(LinkSession, EventsComeFromWhenTheyAreWatchedUntilTheyAreNot) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const auto happens = [&](const char* words) {
    MachineEvent event;
    event.kind = MachineEvent::Kind::kMessage;
    event.words = Sentence::verbatim(words);
    rig.server->on_event(rig.machine.now, event);
  };
  const auto told = [&] {
    std::vector<std::string> heard;
    for (const auto& message : raw.hear())
      if (message.has_event()) heard.push_back(message.event().words());
    return heard;
  };
  using Words = std::vector<std::string>;
  happens("before");
  ClientMessage watch;
  watch.mutable_watch()->set_events(true);
  raw.say(watch);
  EXPECT_EQ(told(), Words());
  happens("first");
  EXPECT_EQ(told(), Words{"first"});
  happens("second");
  raw.say(watch);  // again: nothing is told twice, nothing is left out
  EXPECT_EQ(told(), Words{"second"});
  raw.greet(2);
  happens("third");
  EXPECT_EQ(told(), Words()) << "a session anew watches nothing yet";
}

TEST(LinkSession, WhoIsEndedIsToldWhyOnlyWhereItIsAClient) {
  LinkRig rig;
  RawClient client(rig), stranger(rig);
  client.greet(1);
  client.stream->on_closed(rig.machine.now, "unplugged");
  EXPECT_TRUE(client.stream->ended());
  EXPECT_TRUE(rig.control.clients().empty());
  rig.machine.run_for(10s);
  stranger.stream->on_time(rig.machine.now);
  EXPECT_TRUE(stranger.stream->ended());
  EXPECT_TRUE(stranger.stream->next_bytes().empty()) << "a stranger learns nothing";
}

TEST(LinkSession, WhatIsHereIsWorkedOffBeforeMoreIsRead) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  std::string bytes;
  while (bytes.size() < (80U << 10))
    joblink::append_frame(bytes, 1, raw.sequence++, kPing.SerializeAsString());
  raw.send(bytes.substr(0, 60U << 10));
  EXPECT_TRUE(raw.stream->wants_bytes());
  raw.send(bytes.substr(60U << 10));
  EXPECT_FALSE(raw.stream->wants_bytes());
  raw.work();
  EXPECT_TRUE(raw.stream->wants_bytes());
}

TEST(LinkSession, ManyRequestsWithoutAnAnswerYetAreNotAddedTo) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  std::string bytes;
  for (int i = 0; i < 200; ++i)
    joblink::append_frame(bytes, 1, raw.sequence++,
                          plain(&ClientMessage::mutable_list_jobs).SerializeAsString());
  raw.send(bytes);
  for (int i = 0; i < 100; ++i) raw.stream->on_time(rig.machine.now);
  EXPECT_EQ(rig.worker.waiting(), 64U);
  EXPECT_FALSE(raw.stream->wants_bytes());
  EXPECT_GT(raw.stream->next_deadline(), LocalTime{0}) << "nothing can be done for it now";
  for (int i = 0; i < 5; ++i) raw.work();
  EXPECT_EQ(raw.hear().size(), 200U);
  EXPECT_TRUE(raw.stream->wants_bytes());
}

}  // namespace
}  // namespace kinebus
