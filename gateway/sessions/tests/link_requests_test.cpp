// Requests about jobs, the machine file and the gateway itself: their bounds, and what is refused.

#include "gateway/description/machine_file.hpp"
#include "gateway/sessions/tests/raw_client.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;

/// Its server may be started anew, and reads the machine file elsewhere.
struct Restartable {
  explicit Restartable(MachineFilePort* file = nullptr, const std::string& mark = "mark") {
    rig.server = std::make_unique<JobLinkServer>(
        *rig.machine.gateway, rig.machine.machine, *rig.store, rig.worker,
        file != nullptr ? *file : rig.machine_file, rig.control,
        JobLinkServer::Options{
            .version = {}, .gateway_id = {}, .machine_mark = mark, .restart = [this] { ++restarts; }});
    rig.machine_file.text = write_machine(default_m1());
  }
  LinkRig rig;
  int restarts = 0;
};
const ClientMessage kRestart = plain(&ClientMessage::mutable_restart_gateway);
const ClientMessage kReadFile = plain(&ClientMessage::mutable_read_machine_file);

class BrokenFile : public MachineFilePort {
 public:
  Result<Text, Sentence> read() override { return Error<Sentence>(say("the disk is gone")); }
  Result<void, Sentence> write(std::string_view) override { return Error<Sentence>(say("the disk is gone")); }
};

ClientMessage check_job(const std::string& name) {
  ClientMessage message;
  message.mutable_check_job()->set_name(name);
  return message;
}

TEST(LinkRequests, TheGatewayStartsAnewForWhoHasControlWhereItCan) {
  LinkRig fixed;
  EXPECT_EQ(fixed.ask(fixed.connect("anna"), kRestart).error().code(), joblink::ERROR_OTHER) << "it cannot";
  Restartable able;
  LinkedClient& anna = able.rig.connect("anna");
  LinkedClient& bert = able.rig.connect("bert");
  able.rig.ask(anna, take_control());
  EXPECT_EQ(able.rig.ask(bert, kRestart).error().code(), joblink::ERROR_NO_CONTROL);
  EXPECT_EQ(able.restarts, 0);
  EXPECT_FALSE(able.rig.ask(anna, kRestart).has_error());
  EXPECT_EQ(able.restarts, 1);
}

TEST(LinkRequests, TheGatewayDoesNotStartAnewWithAWrongFileNorInMotionNorOverAJob) {
  Restartable able;
  LinkRig& rig = able.rig;
  LinkedClient& anna = rig.connect("anna");
  const std::string right = rig.machine_file.text;
  rig.machine_file.text = "name = 3\n";
  EXPECT_EQ(rig.ask(anna, kRestart).error().code(), joblink::ERROR_BAD_VALUE);
  rig.machine_file.text = right;
  ASSERT_TRUE(rig.machine.make_ready());
  rig.upload(anna, "a", "G21 G90\nG0 X0 Y0 Z5\nG1 X20 F600\nG1 X0\n");
  rig.pump();
  ClientMessage start;
  start.mutable_start_job()->set_name("a");
  ASSERT_FALSE(rig.ask(anna, start).has_error());
  ASSERT_TRUE(rig.run_until([&] { return rig.machine.gateway->status().line > 2; }, 30s));
  EXPECT_EQ(rig.ask(anna, kRestart).error().code(), joblink::ERROR_MACHINE_STATE) << "it moves";
  rig.ask(anna, plain(&ClientMessage::mutable_stop));
  ASSERT_TRUE(rig.run_until([&] { return rig.machine.gateway->state() == MachineState::kStopped; }, 5s));
  EXPECT_EQ(rig.ask(anna, kRestart).error().code(), joblink::ERROR_MACHINE_STATE) << "a job is interrupted";
  ClientMessage remove;
  remove.mutable_delete_job()->set_name("a");
  EXPECT_EQ(rig.ask(anna, remove).error().code(), joblink::ERROR_JOB_IN_USE);
  EXPECT_EQ(able.restarts, 0);
  rig.ask(anna, plain(&ClientMessage::mutable_clear));
  ASSERT_TRUE(rig.run_until([&] { return rig.machine.gateway->state() == MachineState::kHeld; }, 5s));
  rig.ask(anna, plain(&ClientMessage::mutable_cancel));
  ASSERT_TRUE(rig.run_until([&] { return rig.machine.gateway->state() == MachineState::kReady; }, 5s));
  EXPECT_FALSE(rig.ask(anna, kRestart).has_error());
  EXPECT_EQ(able.restarts, 1);
}

TEST(LinkRequests, AMachineFileHasAtMostHalfAMegabyte) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  const std::string before = rig.machine_file.text;
  for (const std::size_t size : {std::size_t{512U << 10}, (std::size_t{512U << 10}) + 1}) {
    const bool fits = size <= (512U << 10);
    std::string text = write_machine(default_m1());
    text.resize(size, '\n');
    ClientMessage check, write;
    check.mutable_check_machine_file()->set_text(text);
    EXPECT_EQ(!rig.ask(anna, check).has_error(), fits) << size;
    write.mutable_write_machine_file()->set_text(text);
    EXPECT_EQ(!rig.ask(anna, write).has_error(), fits) << size;
    EXPECT_EQ(rig.machine_file.text == text, fits);
  }
}

TEST(LinkRequests, AMachineFileThatCannotBeReadOrWrittenIsSaidToBeSo) {
  BrokenFile broken;
  Restartable able(&broken);
  LinkedClient& anna = able.rig.connect("anna");
  EXPECT_EQ(able.rig.ask(anna, kReadFile).error().code(), joblink::ERROR_STORAGE);
  ClientMessage write;
  write.mutable_write_machine_file()->set_text(write_machine(default_m1()));
  EXPECT_EQ(able.rig.ask(anna, write).error().code(), joblink::ERROR_STORAGE);
  LinkRig rig;
  rig.machine_file.text = "name = \"\xFF\"\n";
  EXPECT_EQ(rig.ask(rig.connect("anna"), kReadFile).error().code(), joblink::ERROR_BAD_VALUE) << "no text";
}

TEST(LinkRequests, AReaderIsToldWhetherTheGatewayRunsWithTheFileThatIsThere) {
  const std::string text = write_machine(default_m1());
  for (const bool same : {true, false}) {
    Restartable able(nullptr, joblink::to_hex(joblink::sha256_of(same ? text : "another")));
    const auto file = able.rig.ask(able.rig.connect("anna"), kReadFile).machine_file();
    EXPECT_EQ(file.restart_needed(), !same);
    EXPECT_EQ(file.sha256(), joblink::sha256_of(text));
    EXPECT_EQ(file.path(), "machine.toml");
    EXPECT_TRUE(file.writable());
  }
}

TEST(LinkRequests, AJobIsReadInPartsOfAtMostHalfAMegabyte) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  std::string text;
  while (text.size() < 700'000) text += "G1 X" + std::to_string(text.size()) + "\n";
  rig.upload(anna, "a", text);
  rig.pump();
  ClientMessage read;
  read.mutable_read_job()->set_name("a");
  read.mutable_read_job()->set_offset_bytes(100);
  read.mutable_read_job()->set_max_bytes(10);
  auto part = rig.ask(anna, read).job_text();
  EXPECT_EQ(part.data(), text.substr(100, 10));
  EXPECT_EQ(part.offset_bytes(), 100U);
  EXPECT_EQ(part.size_bytes(), text.size());
  read.mutable_read_job()->set_max_bytes(1U << 30);
  EXPECT_EQ(rig.ask(anna, read).job_text().data(), text.substr(100, 512U << 10));
  read.mutable_read_job()->set_name("b");
  EXPECT_EQ(rig.ask(anna, read).error().code(), joblink::ERROR_NO_SUCH_JOB);
}

TEST(LinkRequests, AtMostEightJobsAreCheckedAtOnce) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  std::string bytes;
  for (int i = 0; i < 10; ++i)
    joblink::append_frame(bytes, 1, raw.sequence++, check_job("none").SerializeAsString());
  raw.send(bytes);
  for (int i = 0; i < 10; ++i) raw.stream->on_time(rig.machine.now);
  int busy = 0;
  for (const auto& message : raw.hear())
    busy += message.reply().error().code() == joblink::ERROR_BUSY ? 1 : 0;
  EXPECT_EQ(busy, 2);
  rig.worker.run();
  for (const auto& message : raw.hear())
    EXPECT_EQ(message.reply().error().code(), joblink::ERROR_NO_SUCH_JOB);
  EXPECT_EQ(raw.ask(check_job("none")).error().code(), joblink::ERROR_NO_SUCH_JOB) << "there is room again";
}

TEST(LinkRequests, ALongCheckTellsItsProgressAndIsKeptOnlyWithoutOffsets) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  std::string text = "G21 G90\nG0 X0 Y0 Z5\n";
  for (int i = 0; i < 20'000; ++i) text += "G1 X" + std::to_string(i % 7) + " F6000\n";
  rig.upload(anna, "a", text);
  rig.pump();
  ClientMessage offset;
  offset.mutable_set_work_offset()->set_system(1);
  offset.mutable_set_work_offset()->mutable_offset()->set_x_mm(1);
  ASSERT_FALSE(rig.ask(anna, offset).has_error());
  const auto kept = [&] {
    return rig.ask(anna, plain(&ClientMessage::mutable_list_jobs)).jobs().jobs(0).has_preflight();
  };
  EXPECT_EQ(rig.ask(anna, check_job("a")).preflight().summary().lines(), 20'002U);
  EXPECT_FALSE(kept());
  offset.mutable_set_work_offset()->mutable_offset()->set_x_mm(0);
  ASSERT_FALSE(rig.ask(anna, offset).has_error());
  anna.news.clear();
  const auto found = rig.ask(anna, check_job("a")).preflight();
  EXPECT_TRUE(kept());
  EXPECT_EQ(found.name(), "a");
  EXPECT_EQ(found.hash(), joblink::job_hash_of(text));
  double last = 0;
  int told = 0;
  for (const auto& event : anna.all<joblink::Event>()) {
    if (event.kind() != joblink::EVENT_PREFLIGHT) continue;
    EXPECT_EQ(event.job(), "a");
    EXPECT_GE(event.progress(), last + 0.1);
    EXPECT_LE(event.progress(), 1);
    last = event.progress();
    ++told;
  }
  EXPECT_GE(told, 3);
}

TEST(LinkRequests, TheHistoryComesNewestFirstInParts) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  for (int i = 0; i < 120; ++i) {
    StoredRun run;
    run.name = "run" + std::to_string(i);
    ASSERT_TRUE(rig.store->begin_run(run));
  }
  ClientMessage history;
  history.mutable_get_history();
  const auto newest = rig.ask(anna, history).history();
  ASSERT_EQ(newest.runs_size(), 100);
  EXPECT_EQ(newest.runs(0).name(), "run119");
  history.mutable_get_history()->set_before_id(newest.runs(99).id());
  history.mutable_get_history()->set_max_runs(3);
  const auto older = rig.ask(anna, history).history();
  ASSERT_EQ(older.runs_size(), 3);
  EXPECT_EQ(older.runs(0).name(), "run19");
}

TEST(LinkRequests, EventsAreToldFromWhereOneAsksAndAlarmsAreKeptLonger) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  const auto happens = [&](MachineEvent::Kind kind, const std::string& words) {
    MachineEvent event;
    event.kind = kind;
    event.words = Sentence::verbatim(words);
    rig.server->on_event(rig.machine.now, event);
  };
  for (int i = 0; i < 310; ++i) happens(MachineEvent::Kind::kAlarm, "alarm" + std::to_string(i));
  for (int i = 0; i < 1100; ++i) happens(MachineEvent::Kind::kMessage, std::to_string(i));
  ClientMessage ask;
  joblink::GetEvents& request = *ask.mutable_get_events();
  request.set_after_id(0);
  auto told = rig.ask(anna, ask).events();
  EXPECT_EQ(told.events_size(), 200);
  EXPECT_EQ(told.events(0).words(), "100") << "a thousand are kept";
  const std::uint64_t last = told.events(199).id();
  request.set_after_id(last);
  request.set_max_events(2);
  told = rig.ask(anna, ask).events();
  ASSERT_EQ(told.events_size(), 2);
  EXPECT_EQ(told.events(0).id(), last + 1);
  EXPECT_GT(told.events(0).unix_s(), -1);
  request.set_after_id(0);
  request.set_max_events(1000);
  request.set_alarms_only(true);
  told = rig.ask(anna, ask).events();
  ASSERT_EQ(told.events_size(), 300);
  EXPECT_EQ(told.events(0).words(), "alarm10");
  EXPECT_EQ(told.events(299).words(), "alarm309");
}

}  // namespace
}  // namespace kinebus
