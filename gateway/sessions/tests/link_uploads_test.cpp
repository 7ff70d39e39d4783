// Jobs on their way into the store, wherever the cable is pulled.

#include <fstream>
#include <random>
#include <sstream>

#include "gateway/sessions/tests/raw_client.hpp"
#include "protocol/joblink/sha256.hpp"

namespace kinebus {
namespace {

using joblink::ClientMessage;
using namespace std::chrono_literals;
using UploadPhase = joblink::UploadNews::Phase;

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

/// Of the job "a": the upload's id.
std::uint32_t begin_upload(LinkRig& rig, LinkedClient& client, const std::string& text) {
  ClientMessage begin;
  begin.mutable_upload_begin()->set_name("a");
  begin.mutable_upload_begin()->set_size_bytes(text.size());
  begin.mutable_upload_begin()->set_hash(joblink::job_hash_of(text));
  return rig.ask(client, begin).upload().upload_id();
}

TEST(LinkUploads, AnUploadIsStoredAndAllHearOfIt) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  const std::string text = gcode_of(700'000);
  rig.upload(anna, "part.gcode", text);
  rig.pump();
  ASSERT_FALSE(anna.all<joblink::UploadNews>().empty());
  EXPECT_EQ(anna.all<joblink::UploadNews>().back().phase, UploadPhase::kStored);
  EXPECT_EQ(stored_text(rig, "part.gcode"), text);
  EXPECT_TRUE(bert.saw_event(joblink::EVENT_JOBS));
  const auto jobs = rig.ask(bert, plain(&ClientMessage::mutable_list_jobs)).jobs();
  ASSERT_EQ(jobs.jobs_size(), 1);
  EXPECT_EQ(jobs.jobs(0).size_bytes(), text.size());
}

TEST(LinkUploads, AnUploadGoesOnWhereverTheCableIsPulled) {
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
    ASSERT_EQ(anna.all<joblink::UploadNews>().back().phase, UploadPhase::kStored) << "cut after " << cut;
    ASSERT_EQ(stored_text(rig, name), text) << "cut after " << cut;
    anna.news.clear();
  }
}

TEST(LinkUploads, BadNamesQuotaAndWrongSumsAreRefusedWithTheRule) {
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

TEST(LinkUploads, AnUploadIsThatOfWhoBeganIt) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  const std::string text = gcode_of(1000);
  const std::uint32_t id = begin_upload(rig, anna, text);
  ASSERT_NE(id, 0U);
  ClientMessage chunk, commit, abort;
  chunk.mutable_upload_chunk()->set_upload_id(id);
  chunk.mutable_upload_chunk()->set_data(text);
  commit.mutable_upload_commit()->set_upload_id(id);
  abort.mutable_upload_abort()->set_upload_id(id);
  abort.mutable_upload_abort()->set_discard(true);
  for (const ClientMessage& foreign : {chunk, commit, abort})
    EXPECT_EQ(rig.ask(bert, foreign).error().code(), joblink::ERROR_BAD_VALUE);
  EXPECT_FALSE(rig.ask(anna, chunk).has_error());
  EXPECT_EQ(rig.ask(bert, commit).error().code(), joblink::ERROR_BAD_VALUE) << "though it is whole";
  EXPECT_TRUE(rig.ask(anna, commit).upload().stored());
}

TEST(LinkUploads, AHalfUploadIsListedAndCanBeDiscarded) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  const std::string text = gcode_of(1000);
  const std::uint32_t id = begin_upload(rig, anna, text);
  ClientMessage discard, abort;
  discard.mutable_discard_upload()->set_name("a");
  discard.mutable_discard_upload()->set_size_bytes(text.size());
  discard.mutable_discard_upload()->set_hash(joblink::job_hash_of(text));
  EXPECT_EQ(rig.ask(anna, discard).error().code(), joblink::ERROR_BUSY);
  abort.mutable_upload_abort()->set_upload_id(id);
  rig.ask(anna, abort);
  const auto list = rig.ask(anna, plain(&ClientMessage::mutable_list_jobs)).jobs();
  ASSERT_EQ(list.partial_uploads_size(), 1);
  EXPECT_EQ(list.partial_uploads(0).name(), "a");
  EXPECT_FALSE(list.partial_uploads(0).open());
  EXPECT_FALSE(rig.ask(anna, discard).has_error());
  EXPECT_EQ(rig.ask(anna, plain(&ClientMessage::mutable_list_jobs)).jobs().partial_uploads_size(), 0);
}

ClientMessage begin_of(const std::string& name, const std::string& text) {
  ClientMessage begin;
  begin.mutable_upload_begin()->set_name(name);
  begin.mutable_upload_begin()->set_size_bytes(text.size());
  begin.mutable_upload_begin()->set_hash(joblink::job_hash_of(text));
  return begin;
}
ClientMessage chunk_of(std::uint32_t id, const std::string& data, std::uint64_t offset = 0) {
  ClientMessage chunk;
  chunk.mutable_upload_chunk()->set_upload_id(id);
  chunk.mutable_upload_chunk()->set_offset_bytes(offset);
  chunk.mutable_upload_chunk()->set_data(data);
  return chunk;
}
ClientMessage commit_of(std::uint32_t id) {
  ClientMessage commit;
  commit.mutable_upload_commit()->set_upload_id(id);
  return commit;
}
/// Of the half uploads, how many are open.
int open_uploads(LinkRig& rig) {
  const auto listing = rig.store->list();
  return static_cast<int>(std::count_if(listing->partials.begin(), listing->partials.end(),
                                        [](const PartialUpload& partial) { return partial.open; }));
}

TEST(LinkUploads, AThirdUploadSetsTheFirstOfAClientAside) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const std::string text = gcode_of(1000);
  std::vector<std::uint32_t> ids;
  for (const char* name : {"a", "b", "c"}) {
    ids.push_back(raw.ask(begin_of(name, text)).upload().upload_id());
    EXPECT_EQ(open_uploads(rig), name[0] == 'a' ? 1 : 2);
  }
  EXPECT_EQ(raw.ask(chunk_of(ids[0], text)).error().code(), joblink::ERROR_BAD_VALUE);
  for (const std::uint32_t id : {ids[1], ids[2]}) EXPECT_FALSE(raw.ask(chunk_of(id, text)).has_error());
}

TEST(LinkUploads, WhoGoesLeavesNothingOpenHoweverItGoes) {
  for (const char how : {'c', 'd', 'h', 's', 'b'}) {
    LinkRig rig;
    auto raw = std::make_unique<RawClient>(rig);
    raw->greet(1);
    const std::string text = gcode_of(1000);
    if (how == 'b') {
      // Before the store has answered.
      std::string bytes;
      joblink::append_frame(bytes, 1, 1, begin_of("a", text).SerializeAsString());
      raw->send(bytes);
      raw->stream->on_time(rig.machine.now);
      raw->stream->on_closed(rig.machine.now, "unplugged");
    } else {
      ASSERT_NE(raw->ask(begin_of("a", text)).upload().upload_id(), 0U);
      EXPECT_EQ(open_uploads(rig), 1);
    }
    if (how == 'c') raw->stream->on_closed(rig.machine.now, "unplugged");
    if (how == 'd') raw.reset();
    if (how == 'h') raw->greet(2);
    if (how == 's') raw->stream->on_time(rig.machine.now + 9s);
    rig.worker.run();
    EXPECT_EQ(open_uploads(rig), 0) << how;
    EXPECT_EQ(rig.store->list()->partials.size(), 1U) << "it goes on when it is begun again";
  }
}

TEST(LinkUploads, ACommitThatComesTooEarlyLeavesTheUploadOpenAndOneThatIsDoneEndsIt) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const std::string text = gcode_of(1000);
  const std::uint32_t id = raw.ask(begin_of("a", text)).upload().upload_id();
  ASSERT_FALSE(raw.ask(chunk_of(id, text.substr(0, 500))).has_error());
  EXPECT_TRUE(raw.ask(commit_of(id)).has_error());
  EXPECT_EQ(raw.ask(chunk_of(id, text.substr(500), 500)).upload().received_bytes(), 1000U);
  EXPECT_TRUE(raw.ask(commit_of(id)).upload().stored());
  EXPECT_EQ(raw.ask(commit_of(id)).error().code(), joblink::ERROR_BAD_VALUE);
  // One that is not what was announced is over, too.
  ClientMessage wrong = begin_of("b", text);
  const std::uint32_t other = raw.ask(wrong).upload().upload_id();
  ASSERT_FALSE(raw.ask(chunk_of(other, std::string(1000, 'x'))).has_error());
  EXPECT_EQ(raw.ask(commit_of(other)).error().code(), joblink::ERROR_CHECKSUM);
  const auto after = raw.ask(chunk_of(other, "x", 1000)).error().rule();
  EXPECT_NE(after.find("not open"), std::string::npos) << after;
}

TEST(LinkUploads, WhatIsStoredAlreadyIsNotSentAgain) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const std::string text = gcode_of(1000);
  const std::uint32_t id = raw.ask(begin_of("a", text)).upload().upload_id();
  raw.ask(chunk_of(id, text));
  ASSERT_TRUE(raw.ask(commit_of(id)).upload().stored());
  const auto again = raw.ask(begin_of("a", text)).upload();
  EXPECT_TRUE(again.stored());
  EXPECT_EQ(again.upload_id(), 0U);
  EXPECT_TRUE(raw.ask(chunk_of(0, text)).has_error());
}

TEST(LinkUploads, BytesThatTheDiskHasNotTakenYetAreBounded) {
  LinkRig rig;
  RawClient raw(rig);
  raw.greet(1);
  const std::string text = gcode_of(8 << 20);
  const std::uint32_t id = raw.ask(begin_of("a", text)).upload().upload_id();
  std::size_t sent = 0;
  while (raw.stream->wants_bytes() && sent < text.size()) {
    std::string bytes;
    joblink::append_frame(bytes, 1, raw.sequence++,
                          chunk_of(id, text.substr(sent, 100'000), sent).SerializeAsString());
    raw.send(bytes);
    raw.stream->on_time(rig.machine.now);
    sent += 100'000;
  }
  EXPECT_NEAR(static_cast<double>(sent), 2.0 * (1 << 20), 110'000);
  rig.worker.run();
  EXPECT_TRUE(raw.stream->wants_bytes());
}

TEST(LinkUploads, WhatWasDiscardedOrDeletedIsToldToAllAndWhatWasNotIsNot) {
  LinkRig rig;
  LinkedClient& anna = rig.connect("anna");
  LinkedClient& bert = rig.connect("bert");
  const std::string text = gcode_of(1000);
  const auto told = [&](const ClientMessage& request) {
    bert.news.clear();
    rig.ask(anna, request);
    return bert.saw_event(joblink::EVENT_JOBS);
  };
  const std::uint32_t id = begin_upload(rig, anna, text);
  ClientMessage discard, remove, abort;
  discard.mutable_discard_upload()->set_name("a");
  discard.mutable_discard_upload()->set_size_bytes(text.size());
  discard.mutable_discard_upload()->set_hash(joblink::job_hash_of(text));
  remove.mutable_delete_job()->set_name("a");
  abort.mutable_upload_abort()->set_upload_id(id);
  EXPECT_FALSE(told(discard)) << "it is open";
  EXPECT_FALSE(told(remove)) << "it is not stored";
  EXPECT_FALSE(told(commit_of(id))) << "it is not whole";
  rig.ask(anna, abort);
  EXPECT_TRUE(rig.ask(anna, abort).has_error()) << "it is over";
  EXPECT_TRUE(told(discard));
  rig.upload(anna, "a", text);
  rig.pump();
  EXPECT_TRUE(told(remove));
  ASSERT_FALSE(bert.all<joblink::Event>().empty());
  EXPECT_EQ(bert.all<joblink::Event>().back().job(), "a");
}

}  // namespace
}  // namespace kinebus
