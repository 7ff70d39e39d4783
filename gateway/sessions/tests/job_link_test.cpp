// Clients and the gateway's end together: hello, control, uploads, and what happens when links break.

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
using Phase = joblink::UploadNews::Phase;

std::string gcode_of(std::size_t size) {
  std::string text;
  for (std::size_t i = 0; text.size() < size; ++i) text += "G1 X" + std::to_string(i % 97) + " F1200\n";
  text.resize(size);
  return text;
}
std::string stored_text(const LinkRig& rig, const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(rig.folder.path() / "jobs" / name, std::ios::binary).rdbuf();
  return std::move(text).str();
}
ClientMessage take_control(bool force = false) {
  ClientMessage message;
  message.mutable_take_control()->set_force(force);
  return message;
}

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
  EXPECT_TRUE(session->next_bytes().empty());
  EXPECT_EQ(rig.machine.gateway->state(), MachineState::kOff);
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

TEST(JobLink, AnUploadIsStoredAndAllHearOfIt) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  const std::string text = gcode_of(700'000);
  rig.upload(anna, "part.gcode", text);
  rig.pump();
  ASSERT_FALSE(anna.all<joblink::UploadNews>().empty());
  EXPECT_EQ(anna.all<joblink::UploadNews>().back().phase, Phase::kStored);
  EXPECT_EQ(stored_text(rig, "part.gcode"), text);
  EXPECT_TRUE(bert.saw_event(joblink::EVENT_JOBS));
  const auto jobs = rig.ask(bert, plain(&ClientMessage::mutable_list_jobs)).jobs();
  ASSERT_EQ(jobs.jobs_size(), 1);
  EXPECT_EQ(jobs.jobs(0).size_bytes(), text.size());
}

TEST(JobLink, AnUploadGoesOnWhereverTheCableIsPulled) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  for (int round = 0; round < 200; ++round) {
    const std::string text = gcode_of(100'000 + random() % 1000), name = "job" + std::to_string(round % 3);
    rig.upload(anna, name, text);
    const std::size_t cut = random() % (text.size() + 2000);
    rig.pump(&anna, cut);
    rig.unplug(anna);
    if (round % 2 == 0) rig.pump();
    rig.plug(anna);
    rig.pump();
    ASSERT_EQ(anna.all<joblink::UploadNews>().back().phase, Phase::kStored) << "cut after " << cut;
    ASSERT_EQ(stored_text(rig, name), text) << "cut after " << cut;
    anna.news.clear();
  }
}

TEST(JobLink, BadNamesQuotaAndWrongSumsAreRefusedWithTheRule) {
  LinkRig rig({.folder = {}, .quota_bytes = 5000});
  LinkedClient& anna = rig.connect("anna");
  const auto error_of = [&](const std::string& name, const std::string& text, const std::string& sum) {
    anna.news.clear();
    anna.link.upload({.name = name, .size_bytes = text.size(), .hash = sum},
                     std::make_unique<TextSource>(text));
    rig.pump();
    return anna.all<joblink::UploadNews>().back().error.code();
  };
  const std::string text = gcode_of(1000);
  EXPECT_EQ(error_of("../a", text, joblink::job_hash_of(text)), joblink::ERROR_NAME);
  EXPECT_EQ(error_of("/a", text, joblink::job_hash_of(text)), joblink::ERROR_NAME);
  EXPECT_EQ(error_of("a", gcode_of(6000), joblink::job_hash_of(gcode_of(6000))), joblink::ERROR_QUOTA);
  EXPECT_EQ(error_of("a", text, joblink::job_hash_of("other")), joblink::ERROR_CHECKSUM);
  EXPECT_EQ(error_of("a", text, "short"), joblink::ERROR_CHECKSUM);
  EXPECT_EQ(rig.ask(anna, plain(&ClientMessage::mutable_list_jobs)).jobs().jobs_size(), 0);
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

}  // namespace
}  // namespace kinebus
