// Clients and the gateway's end together: hello, control, and what happens when links break.

#include <fstream>
#include <random>
#include <sstream>

#include "gateway/description/machine_file.hpp"
#include "gateway/sessions/tests/link_rig.hpp"
#include "protocol/joblink/frame_codec.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

TEST(JobLink, HelloTellsVersionMachineAndCapabilities) {
  LinkRig rig;
  LinkedClient& client = rig.connect("a");
  ASSERT_TRUE(client.link.connected());
  EXPECT_EQ(client.link.hello().version_major(), joblink::kVersionMajor);
  EXPECT_EQ(client.link.hello().machine_name(), rig.machine.machine.name);
  EXPECT_EQ(client.link.client_id(), 1U);
  EXPECT_GT(client.link.hello().capabilities_size(), 0);
}

TEST(JobLink, AWrongTokenIsRefusedAndTheRightOneLetIn) {
  LinkRig rig;
  LinkedClient& wrong = rig.connect("a", 0, {.transport = "tcp 1", .token = "secret"}, "guess");
  EXPECT_FALSE(wrong.link.connected());
  EXPECT_TRUE(wrong.session->ended());
  EXPECT_TRUE(rig.connect("b", 0, {.transport = "tcp 2", .token = "secret"}, "secret").link.connected());
  EXPECT_EQ(rig.control.clients().size(), 1U);
}

TEST(JobLink, NothingIsAnsweredBeforeHello) {
  LinkRig rig;
  const auto session = rig.server->open(rig.machine.now, {});
  std::string bytes;
  joblink::append_frame(bytes, 7, 0, plain(&ClientMessage::mutable_home).SerializeAsString());
  joblink::append_frame(bytes, 7, 1, plain(&ClientMessage::mutable_home).SerializeAsString());
  session->on_bytes(rig.machine.now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  session->on_time(rig.machine.now);
  EXPECT_TRUE(session->next_bytes().empty());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kOff);
}

TEST(JobLink, BeforeHelloOnlySmallFramesAreTaken) {
  LinkRig rig;
  for (const std::size_t size : {std::size_t{100}, std::size_t{8000}}) {
    const auto session = rig.server->open(rig.machine.now, {});
    ClientMessage hello;
    hello.mutable_hello()->set_version_major(joblink::kVersionMajor);
    hello.mutable_hello()->set_client_version(std::string(size, 'v'));
    std::string bytes;
    joblink::append_frame(bytes, 7, 0, hello.SerializeAsString());
    session->on_bytes(rig.machine.now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    session->on_time(rig.machine.now);
    EXPECT_EQ(session->next_bytes().empty(), size > 4096) << size;
  }
}

TEST(JobLink, OneHasControlTheOthersWatchAndAnyoneMayStop) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  EXPECT_FALSE(rig.ask(anna, take_control()).has_error());
  EXPECT_EQ(rig.ask(bert, plain(&ClientMessage::mutable_bring_up)).error().code(), joblink::ERROR_NO_CONTROL);
  EXPECT_EQ(rig.ask(bert, take_control()).error().code(), joblink::ERROR_NO_CONTROL);
  EXPECT_FALSE(rig.ask(anna, plain(&ClientMessage::mutable_bring_up)).has_error());
  EXPECT_FALSE(rig.ask(bert, plain(&ClientMessage::mutable_stop)).has_error());
  EXPECT_NE(rig.machine.gateway->state(), MachineState::kBringUp);
}

/// A page or a print host: what it calls stop is an emergency stop.
class EmergencyStopper : public Requester {
 public:
  using Requester::Requester;
  ClientId client() const override { return 0; }
  void take_reply(joblink::Reply) override {}
};

TEST(JobLink, StopDoesWithHeatWhatTheMachineFileSaysAndAnEmergencyStopCutsIt) {
  using After = ThermalDescription::After;
  for (const After on_stop : {After::kOff, After::kKeep}) {
    MachineDescription description = default_m1();
    description.thermal.on_stop = on_stop;
    LinkRig rig({}, {}, description);
    LinkedClient& anna = rig.connect("anna");
    EXPECT_FALSE(rig.ask(anna, take_control()).has_error());
    ClientMessage heat;
    heat.mutable_set_temperature()->set_kind(joblink::HEATER_BED);
    heat.mutable_set_temperature()->set_celsius(60);
    const auto target = [&] { return rig.machine.gateway->status().heater(kFirstBed).target_celsius; };
    EXPECT_FALSE(rig.ask(anna, heat).has_error());
    EXPECT_FALSE(rig.ask(anna, plain(&ClientMessage::mutable_stop)).has_error());
    EXPECT_EQ(target(), on_stop == After::kKeep ? 60 : 0);
    EmergencyStopper page(*rig.store, rig.worker);
    const std::uint64_t id = rig.server->enter(page);
    rig.server->request(rig.machine.now, page, {id, 1}, plain(&ClientMessage::mutable_stop));
    EXPECT_EQ(target(), 0);
    rig.server->leave(id);
  }
}

TEST(JobLink, ControlIsHandedOverAndAllAreTold) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  rig.ask(anna, take_control());
  ClientMessage hand_over;
  hand_over.mutable_hand_over()->set_client_id(bert.link.client_id());
  EXPECT_FALSE(rig.ask(anna, hand_over).has_error());
  EXPECT_EQ(rig.control.holder(), bert.link.client_id());
  EXPECT_TRUE(rig.ask(anna, hand_over).has_error());
  EXPECT_TRUE(anna.saw_event(joblink::EVENT_CONTROL));
  EXPECT_TRUE(bert.saw_event(joblink::EVENT_CONTROL));
  EXPECT_FALSE(rig.ask(anna, take_control(true)).has_error());
  EXPECT_EQ(rig.control.holder(), anna.link.client_id());
}

TEST(JobLink, AClientThatVanishesLosesControlAndHasItBackWhenItReturns) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.ask(anna, take_control());
  rig.unplug(anna);
  EXPECT_EQ(rig.control.holder(), 0U);
  rig.plug(anna);
  EXPECT_EQ(rig.control.holder(), anna.link.client_id());
  rig.unplug(anna);
  LinkedClient& bert = rig.connect("bert");
  rig.ask(bert, take_control());
  rig.plug(anna);
  EXPECT_EQ(rig.control.holder(), bert.link.client_id());
}

TEST(JobLink, AClientThatFallsSilentLosesControl) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.ask(anna, take_control());
  const auto session = std::move(anna.session);
  rig.machine.run_for(9s);
  session->on_time(rig.machine.now);
  EXPECT_EQ(rig.control.holder(), 0U);
}

TEST(JobLink, AClientThatIsBackBeforeItsOldStreamDiedKeepsControl) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.ask(anna, take_control());
  const auto dead = std::move(anna.session);
  anna.link.on_disconnected(rig.machine.now, "unplugged");
  rig.plug(anna);
  EXPECT_EQ(rig.control.holder(), anna.link.client_id());
  EXPECT_TRUE(dead->ended());
}

TEST(JobLink, GarbageNeverMovesTheMachineNorEndsTheServer) {
  std::mt19937 random(11);
  LinkRig rig;
  LinkedClient& good = rig.connect("good");
  for (int round = 0; round < 300; ++round) {
    const auto session = rig.server->open(rig.machine.now, {});
    std::string bytes;
    for (std::uint32_t sequence = 0; sequence < 5; ++sequence) {
      std::string message(random() % 200, '\0');
      for (char& c : message) c = static_cast<char>(random());
      joblink::append_frame(bytes, 3, sequence, message);
    }
    if (round % 2 == 0) bytes[random() % bytes.size()] ^= 0x40;
    session->on_bytes(rig.machine.now, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    rig.worker.run();
    session->on_time(rig.machine.now + 1s);
    session->on_closed(rig.machine.now, "end");
  }
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kOff);
  EXPECT_FALSE(rig.ask(good, plain(&ClientMessage::mutable_ping)).has_error());
}

TEST(JobLink, ALostFrameBeginsANewSessionAndControlStays) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.ask(anna, take_control());
  // One request never arrives.
  anna.link.send(plain(&ClientMessage::mutable_list_jobs));
  anna.link.on_bytes_sent(anna.link.next_bytes().size());
  anna.link.send(plain(&ClientMessage::mutable_list_jobs));
  rig.pump();
  EXPECT_FALSE(anna.link.connected());
  ASSERT_TRUE(rig.run_until([&] { return anna.link.connected(); }, 5s));
  EXPECT_EQ(rig.control.holder(), anna.link.client_id());
}

TEST(JobLink, WhoDoesNotReadIsNotListenedToAndCostsBoundedMemory) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  std::size_t taken = 0;
  while (anna.session->wants_bytes() && taken < 100'000) {
    anna.link.send(plain(&ClientMessage::mutable_get_machine));
    const auto bytes = anna.link.next_bytes();
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    anna.link.on_bytes_sent(copy.size());
    anna.session->on_bytes(rig.machine.now, copy);
    anna.session->on_time(rig.machine.now);
    ++taken;
  }
  EXPECT_FALSE(anna.session->wants_bytes());
  EXPECT_LT(anna.session->next_bytes().size(), 3U << 20);
}

TEST(JobLink, MachineFileIsReadCheckedAndWritten) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  const auto file = rig.ask(anna, plain(&ClientMessage::mutable_read_machine_file)).machine_file();
  EXPECT_EQ(file.text(), rig.machine_file.text);
  ClientMessage check;
  check.mutable_check_machine_file()->set_text("name = 3\n");
  const auto wrong = rig.ask(anna, check).machine_file_check();
  ASSERT_GT(wrong.problems_size(), 0);
  EXPECT_EQ(wrong.problems(0).line(), 1U);
  ClientMessage write;
  write.mutable_write_machine_file()->set_text("name = 3\n");
  EXPECT_EQ(rig.ask(anna, write).error().code(), joblink::ERROR_BAD_VALUE);
  write.mutable_write_machine_file()->set_text(write_machine(default_m1()));
  write.mutable_write_machine_file()->set_expected_sha256(joblink::sha256_of("an older text"));
  EXPECT_EQ(rig.ask(anna, write).error().code(), joblink::ERROR_CONFLICT);
  write.mutable_write_machine_file()->set_expected_sha256(file.sha256());
  EXPECT_FALSE(rig.ask(anna, write).has_error());
  EXPECT_EQ(rig.machine_file.text, write_machine(default_m1()));
}

TEST(JobLink, TheMachineFileIsWrittenByWhoHasControlAlone) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  rig.ask(anna, take_control());
  const std::string before = rig.machine_file.text;
  ClientMessage write;
  write.mutable_write_machine_file()->set_text(write_machine(default_m1()));
  EXPECT_EQ(rig.ask(bert, write).error().code(), joblink::ERROR_NO_CONTROL);
  EXPECT_EQ(rig.machine_file.text, before);
  EXPECT_FALSE(rig.ask(anna, write).has_error());
}

// What a client can make long: every reply fits into a message.

TEST(JobLink, AMachineFileFullOfErrorsIsAnsweredWithTheFirstOfThem) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  std::string text;
  for (int i = 0; i < 20'000; ++i) text += "no_such_key_" + std::to_string(i) + " = 1\n";
  ClientMessage check;
  check.mutable_check_machine_file()->set_text(text);
  const auto found = rig.ask(anna, check).machine_file_check();
  EXPECT_GT(found.problems_size(), 100);
  EXPECT_GT(found.more(), 10'000U);
}

TEST(JobLink, AListOfThousandsOfJobsComesInParts) {
  std::vector<std::string> names;
  for (int i = 0; i < 6000; ++i) names.push_back(std::to_string(100'000 + i) + std::string(190, 'n'));
  LinkRig rig({}, names);
  LinkedClient& anna = rig.connect("anna");
  std::vector<std::string> listed;
  for (bool more = true; more;) {
    ClientMessage request;
    request.mutable_list_jobs()->set_after_name(listed.empty() ? "" : listed.back());
    const auto reply = rig.ask(anna, request);
    ASSERT_GT(reply.jobs().jobs_size(), 0) << reply.error().rule();
    for (const auto& job : reply.jobs().jobs()) listed.push_back(job.name());
    more = reply.jobs().more();
  }
  EXPECT_EQ(listed, names);
}

TEST(JobLink, ManyLongMessagesOfAJobComeInParts) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.unplug(anna);
  for (int i = 0; i < 300; ++i) {
    MachineEvent event;
    event.kind = MachineEvent::Kind::kMessage;
    event.words = Sentence::verbatim(std::string(9000, static_cast<char>('a' + i % 26)));
    rig.server->on_event(rig.machine.now, event);
  }
  rig.plug(anna);
  std::size_t heard = 0;
  std::uint64_t last = 0;
  for (bool more = true; more;) {
    ClientMessage request;
    request.mutable_get_events()->set_max_events(1000);
    request.mutable_get_events()->set_after_id(last);
    const auto reply = rig.ask(anna, request);
    ASSERT_GT(reply.events().events_size(), 0) << reply.error().rule();
    for (const auto& event : reply.events().events()) {
      last = event.id();
      if (event.kind() == joblink::EVENT_MESSAGE) ++heard;
    }
    more = reply.events().more();
  }
  EXPECT_EQ(heard, 300U);
}

TEST(JobLink, AnAnswerThatFitsIntoNoMessageIsAnError) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.machine_file.text = std::string(joblink::kMaxMessageBytes + 1, '#');
  EXPECT_EQ(rig.ask(anna, plain(&ClientMessage::mutable_read_machine_file)).error().code(),
            joblink::ERROR_BAD_VALUE);
  EXPECT_FALSE(rig.ask(anna, plain(&ClientMessage::mutable_ping)).has_error());
  // Nor does the client's own end send what no message can carry.
  ClientMessage check;
  check.mutable_check_machine_file()->set_text(std::string(joblink::kMaxMessageBytes, '#'));
  EXPECT_EQ(rig.ask(anna, check).error().code(), joblink::ERROR_BAD_VALUE);
  EXPECT_TRUE(anna.link.connected());
}

// Words of others.

TEST(JobLink, ANameCutWithinACharacterHarmsNobodysStatus) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  rig.connect(std::string(99, 'x') + "\xC3\xA4");
  const auto status = rig.ask(anna, plain(&ClientMessage::mutable_get_status)).status();
  ASSERT_EQ(status.clients_size(), 2);
  EXPECT_EQ(status.clients(1).name(), std::string(99, 'x'));
}

TEST(JobLink, NamesAndMessagesAreShownWithoutWhatATerminalObeys) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna\x1B[2J\xE2\x80\xAE");
  MachineEvent event;
  event.kind = MachineEvent::Kind::kMessage;
  event.words = Sentence::verbatim(
      "\x1B]0;title\x07\xC2\x9B"
      "31m");
  rig.server->on_event(rig.machine.now, event);
  rig.pump();
  EXPECT_EQ(rig.control.clients()[0].name, "anna?[2J?");
  const auto events = anna.all<joblink::Event>();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().words(), "?]0;title??31m");
  EXPECT_EQ(events.back().said().text(), "?]0;title??31m");
}

TEST(JobLink, AFloodOfRequestsIsWorkedOffInBoundedPartsAndAStopIsNotBehindIt) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  ASSERT_FALSE(rig.ask(anna, plain(&ClientMessage::mutable_bring_up)).has_error());
  for (int i = 0; i < 500; ++i) anna.link.send(plain(&ClientMessage::mutable_get_status));
  anna.link.send(plain(&ClientMessage::mutable_stop));
  const auto bytes = anna.link.next_bytes();
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  anna.link.on_bytes_sent(copy.size());
  anna.session->on_bytes(rig.machine.now, copy);
  EXPECT_TRUE(anna.session->next_bytes().empty());
  EXPECT_NE(rig.machine.gateway->state(), MachineState::kBringUp);
  EXPECT_LE(anna.session->next_deadline(), rig.machine.now);
  std::size_t longest = 0;
  for (int turn = 0; turn < 20; ++turn) {
    const std::size_t before = anna.session->next_bytes().size();
    anna.session->on_time(rig.machine.now);
    longest = std::max(longest, anna.session->next_bytes().size() - before);
  }
  // A status of some hundred bytes, four times.
  EXPECT_LT(longest, 16'000U);
  rig.pump();
  EXPECT_EQ(anna.all<joblink::Answer>().size(), 502U);
}

}  // namespace
}  // namespace kinebus
