// Jobs on their way into the store, wherever the cable is pulled.

#include <fstream>
#include <random>
#include <sstream>

#include "gateway/sessions/tests/link_rig.hpp"
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

}  // namespace
}  // namespace kinebus
