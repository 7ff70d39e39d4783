#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "gateway/jobs/store/tests/job_store_fixture.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
using joblink::job_hash_of;
using testing_store::identity_of;
using testing_store::JobStoreTest;

std::string text_of(std::size_t size, unsigned seed = 1) {
  std::string text(size, '\0');
  for (char& c : text) c = static_cast<char>((seed = seed * 1'103'515'245U + 12'345U) >> 16);
  return text;
}
std::string file_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}
TEST_F(JobStoreTest, AnUploadIsInvisibleUntilItIsWhole) {
  const std::string text = text_of(5000);
  const auto begun = store_->begin_upload(identity_of("a.gcode", text), false, 1000);
  ASSERT_TRUE(begun);
  ASSERT_TRUE(store_->append(begun->id, 0, std::string_view(text).substr(0, 4999)));
  EXPECT_TRUE(store_->list()->jobs.empty());
  EXPECT_EQ(store_->commit(begun->id, 1234).error().kind, StoreError::Kind::kOrder);
  ASSERT_TRUE(store_->append(begun->id, 4999, std::string_view(text).substr(4999)));
  ASSERT_TRUE(store_->commit(begun->id, 1234));
  const auto jobs = store_->list()->jobs;
  ASSERT_EQ(jobs.size(), 1U);
  EXPECT_EQ(jobs[0].name, "a.gcode");
  EXPECT_EQ(jobs[0].hash, job_hash_of(text));
  EXPECT_EQ(jobs[0].stored_unix_s, 1234);
  EXPECT_EQ(file_text(options_.folder / "a.gcode"), text);
}

TEST_F(JobStoreTest, AnUploadGoesOnAfterTheStoreWasClosedAtAnyByte) {
  const std::string text = text_of(3000);
  for (std::size_t cut = 0; cut <= text.size(); cut += 271) {
    const std::string name = "cut" + std::to_string(cut);
    const auto begun = store_->begin_upload(identity_of(name, text), false, 1000);
    ASSERT_TRUE(begun);
    ASSERT_TRUE(store_->append(begun->id, 0, std::string_view(text).substr(0, cut)));
    store_->abort(begun->id, false);
    reopen();
    const auto again = store_->begin_upload(identity_of(name, text), false, 1000);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->received_bytes, cut);
    ASSERT_TRUE(store_->append(again->id, cut, std::string_view(text).substr(cut)));
    ASSERT_TRUE(store_->commit(again->id, 1)) << "cut at " << cut;
    EXPECT_EQ(file_text(options_.folder / name), text);
  }
}

TEST_F(JobStoreTest, ASecondBeginTakesTheUploadOver) {
  const std::string text = text_of(100);
  const auto first = store_->begin_upload(identity_of("a", text), false, 1000);
  ASSERT_TRUE(store_->append(first->id, 0, std::string_view(text).substr(0, 60)));
  const auto second = store_->begin_upload(identity_of("a", text), false, 1000);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->received_bytes, 60U);
  EXPECT_EQ(store_->append(first->id, 60, "x").error().kind, StoreError::Kind::kOrder);
}

TEST_F(JobStoreTest, BytesThatAreNotThoseAnnouncedAreNotStored) {
  const std::string text = text_of(100);
  const auto begun = store_->begin_upload({"a", 100, job_hash_of("another text")}, false, 1000);
  ASSERT_TRUE(store_->append(begun->id, 0, text));
  EXPECT_EQ(store_->commit(begun->id, 1).error().kind, StoreError::Kind::kChecksum);
  EXPECT_TRUE(store_->list()->jobs.empty());
  EXPECT_EQ(store_->list()->used_bytes, 0U);
  EXPECT_EQ(store_->append(begun->id, 0, text).error().kind, StoreError::Kind::kOrder);
}

TEST_F(JobStoreTest, PiecesOutOfPlaceAreRefused) {
  const auto begun = store_->begin_upload(identity_of("a", text_of(100)), false, 1000);
  EXPECT_EQ(store_->append(begun->id, 1, "x").error().kind, StoreError::Kind::kOrder);
  EXPECT_EQ(store_->append(begun->id, 0, text_of(101)).error().kind, StoreError::Kind::kOrder);
  EXPECT_EQ(store_->append(begun->id + 1, 0, "x").error().kind, StoreError::Kind::kOrder);
}

TEST_F(JobStoreTest, NamesStayWithinTheFolder) {
  for (const char* name :
       {"", ".", "..", "../a", "a/b", "/etc/passwd", ".hidden", ".jobs.sqlite", "a\\b", "a\nb"}) {
    EXPECT_EQ(store_->begin_upload({name, 1, std::string(32, 'x')}, true, 1).error().kind,
              StoreError::Kind::kName)
        << name;
    EXPECT_FALSE(store_->open_job(name)) << name;
    EXPECT_FALSE(store_->read(name, 0, 10)) << name;
    EXPECT_FALSE(store_->remove(name)) << name;
  }
  EXPECT_EQ(store_->begin_upload({std::string(201, 'a'), 1, std::string(32, 'x')}, true, 1).error().kind,
            StoreError::Kind::kName);
  EXPECT_EQ(put("Würfel kalibriert (2).gcode", "G0"), "");
}

TEST_F(JobStoreTest, ALinkInTheFolderIsNoJob) {
  fs::create_symlink("/etc/passwd", options_.folder / "link");
  reopen();
  EXPECT_TRUE(store_->list()->jobs.empty());
  EXPECT_EQ(store_->open_job("link").error().kind, StoreError::Kind::kNoSuchJob);
}

TEST_F(JobStoreTest, TheQuotaHoldsAndAReplacedJobDoesNotCountTwice) {
  options_.quota_bytes = 1000;
  reopen();
  EXPECT_EQ(put("a", text_of(600)), "");
  const auto over = store_->begin_upload(identity_of("b", text_of(401)), false, 1);
  EXPECT_EQ(over.error().kind, StoreError::Kind::kQuota);
  EXPECT_EQ(put("a", text_of(900, 5)), "");
  EXPECT_EQ(store_->list()->used_bytes, 900U);
  EXPECT_TRUE(store_->remove("a"));
  EXPECT_EQ(put("b", text_of(1000)), "");
}

TEST_F(JobStoreTest, HalfUploadsCountForTheQuota) {
  options_.quota_bytes = 1000;
  reopen();
  const auto half = store_->begin_upload(identity_of("a", text_of(800)), false, 1);
  ASSERT_TRUE(store_->append(half->id, 0, text_of(500)));
  EXPECT_EQ(store_->begin_upload(identity_of("b", text_of(501)), false, 1).error().kind,
            StoreError::Kind::kQuota);
}

TEST_F(JobStoreTest, OldHalfUploadsAreForgotten) {
  const std::string text = text_of(100);
  const auto begun = store_->begin_upload(identity_of("a", text), false, 1000);
  ASSERT_TRUE(store_->append(begun->id, 0, std::string_view(text).substr(0, 50)));
  store_->abort(begun->id, false);
  reopen(1000 + options_.forget_uploads_after_s + 1);
  EXPECT_EQ(store_->list()->used_bytes, 0U);
}

TEST_F(JobStoreTest, ADiskThatIsFullIsReportedAndTheUploadGoesOnLater) {
  const std::string text = text_of(300'000);
  const auto begun = store_->begin_upload(identity_of("a", text), false, 1000);
  ASSERT_TRUE(begun);
  ASSERT_TRUE(store_->append(begun->id, 0, std::string_view(text).substr(0, 100'000)));
  rlimit old{};
  ::getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{150'000, old.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &small);
  const auto full = store_->append(begun->id, 100'000, std::string_view(text).substr(100'000));
  ::setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(full.error().kind, StoreError::Kind::kDiskFull);
  ASSERT_TRUE(store_->append(begun->id, 100'000, std::string_view(text).substr(100'000)));
  EXPECT_TRUE(store_->commit(begun->id, 1));
  EXPECT_EQ(file_text(options_.folder / "a"), text);
}

TEST_F(JobStoreTest, ADiskWithoutRoomIsReportedBeforeAnyByteIsSent) {
  options_.margin_bytes = 1ULL << 60;
  reopen();
  EXPECT_EQ(store_->begin_upload(identity_of("a", "x"), false, 1).error().kind, StoreError::Kind::kDiskFull);
}

TEST_F(JobStoreTest, AFolderThatCannotBeWrittenGivesAStoreThatReads) {
  options_.folder = "/dev/null/jobs";
  reopen();
  EXPECT_FALSE(store_->writable());
  EXPECT_FALSE(store_->notes().empty());
  EXPECT_EQ(store_->begin_upload(identity_of("a", "x"), false, 1).error().kind, StoreError::Kind::kReadOnly);
  EXPECT_TRUE(store_->list()->jobs.empty());
}

TEST_F(JobStoreTest, FilesPutInOrTakenOutByHandAreSeenAtTheNextStart) {
  EXPECT_EQ(put("gone", "1"), "");
  EXPECT_EQ(put("changed", "2"), "");
  fs::remove(options_.folder / "gone");
  std::ofstream(options_.folder / "changed") << "changed by hand";
  std::ofstream(options_.folder / "new.gcode") << "G0 X1";
  reopen();
  const auto jobs = store_->list()->jobs;
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_EQ(jobs[0].name, "changed");
  EXPECT_EQ(jobs[0].hash, job_hash_of("changed by hand"));
  EXPECT_EQ(jobs[1].hash, job_hash_of("G0 X1"));
}

TEST_F(JobStoreTest, AStoreOfAnOlderGatewayKeepsItsJobsAndHistory) {
  EXPECT_EQ(put("a", "G0 X1"), "");
  const auto run = store_->begin_run({.name = "a", .hash = "an old one", .begun_unix_s = 10});
  ASSERT_TRUE(run);
  ASSERT_TRUE(store_->end_run(*run, RunResult::kComplete, 5, 5, 1, ""));
  store_.reset();
  {
    auto older = Database::open(options_.folder / ".jobs.sqlite");
    ASSERT_TRUE(older);
    ASSERT_TRUE(
        older->run("ALTER TABLE runs RENAME COLUMN hash TO sha256;"
                   "ALTER TABLE jobs RENAME COLUMN hash TO sha256; UPDATE jobs SET sha256 = x'00112233';"
                   "ALTER TABLE preflights RENAME COLUMN hash TO sha256;"));
  }
  for (int start = 0; start < 2; ++start) {
    reopen();
    const auto jobs = store_->list()->jobs;
    ASSERT_EQ(jobs.size(), 1U);
    EXPECT_EQ(jobs[0].hash, job_hash_of("G0 X1"));
    EXPECT_EQ(jobs[0].times_run, 1U);
    ASSERT_EQ(store_->history(0, 9)->size(), 1U);
  }
}

TEST_F(JobStoreTest, AFileOfAPrintHostIsNoJobUntilItIsTakenOver) {
  const fs::path written = options_.folder / ".serial-1";
  std::ofstream(written) << "G28\n";
  reopen();
  EXPECT_FALSE(store_->find("host.gcode"));
  ASSERT_TRUE(store_->adopt(written, "host.gcode", 1500));
  EXPECT_FALSE(fs::exists(written));
  EXPECT_EQ(file_text(options_.folder / "host.gcode"), "G28\n");
  EXPECT_TRUE(store_->find("host.gcode"));
  EXPECT_FALSE(store_->adopt(written, "again.gcode", 1500));
  EXPECT_FALSE(store_->find("again.gcode"));
}

TEST_F(JobStoreTest, APreflightIsThatOfItsMachineAndText) {
  EXPECT_EQ(put("a", "1"), "");
  store_->set_machine("m1");
  EXPECT_TRUE(store_->save_preflight(job_hash_of("1"), "m1", {.errors = 2, .lines = 7, .motion_s = 1.5}));
  ASSERT_TRUE(store_->list()->jobs[0].preflight);
  EXPECT_EQ(store_->list()->jobs[0].preflight->errors, 2U);
  store_->set_machine("m2");
  EXPECT_FALSE(store_->list()->jobs[0].preflight);
  store_->set_machine("m1");
  EXPECT_EQ(put("a", "2"), "");
  EXPECT_FALSE(store_->list()->jobs[0].preflight);
}

TEST_F(JobStoreTest, ReadsAnyPartOfAJob) {
  EXPECT_EQ(put("a", "0123456789"), "");
  EXPECT_EQ(*store_->read("a", 3, 4), "3456");
  EXPECT_EQ(*store_->read("a", 8, 100), "89");
  EXPECT_EQ(*store_->read("a", 10, 100), "");
  EXPECT_EQ(store_->read("b", 0, 1).error().kind, StoreError::Kind::kNoSuchJob);
}

TEST_F(JobStoreTest, AJobThatIsReplacedGoesOnToBeReadByWhoHasItOpen) {
  EXPECT_EQ(put("a", "old text"), "");
  auto source = store_->open_job("a");
  ASSERT_TRUE(source);
  EXPECT_EQ(put("a", "new"), "");
  std::string text(8, '\0');
  EXPECT_EQ((*source)->read(text), 8U);
  EXPECT_EQ(text, "old text");
}

TEST_F(JobStoreTest, UploadsThatAreUnderWayHaveTheirPlaceInTheQuota) {
  options_.quota_bytes = 1000;
  reopen();
  const std::string text = text_of(900);
  const auto first = store_->begin_upload(identity_of("a", text), false, 1);
  ASSERT_TRUE(first);
  for (const std::string name : {"b", "c"})
    EXPECT_EQ(store_->begin_upload(identity_of(name, text_of(900, 7)), false, 1).error().kind,
              StoreError::Kind::kQuota);
  store_->abort(first->id, true);
  EXPECT_EQ(put("b", text_of(900, 7)), "");
  // What is replaced makes room once, not for everybody.
  ASSERT_TRUE(store_->begin_upload(identity_of("b", text_of(950, 8)), true, 1));
  EXPECT_EQ(store_->begin_upload(identity_of("b", text_of(950, 9)), true, 1).error().kind,
            StoreError::Kind::kQuota);
}

TEST_F(JobStoreTest, HalfUploadsAreListedAndCanBeDiscarded) {
  const std::string text = text_of(100);
  const auto begun = store_->begin_upload(identity_of("a", text), false, 1000);
  ASSERT_TRUE(store_->append(begun->id, 0, std::string_view(text).substr(0, 60)));
  auto partials = store_->list()->partials;
  ASSERT_EQ(partials.size(), 1U);
  EXPECT_EQ(partials[0].identity.name, "a");
  EXPECT_EQ(partials[0].received_bytes, 60U);
  EXPECT_TRUE(partials[0].open);
  EXPECT_EQ(store_->discard(identity_of("a", text)).error().kind, StoreError::Kind::kBusy);
  store_->abort(begun->id, false);
  EXPECT_FALSE(store_->list()->partials[0].open);
  EXPECT_TRUE(store_->discard(identity_of("a", text)));
  EXPECT_TRUE(store_->list()->partials.empty());
  EXPECT_EQ(store_->list()->used_bytes, 0U);
  EXPECT_EQ(store_->discard(identity_of("a", text)).error().kind, StoreError::Kind::kNoSuchJob);
}

TEST_F(JobStoreTest, OldHalfUploadsAreForgottenWithoutARestart) {
  const std::string text = text_of(100);
  store_->abort(store_->begin_upload(identity_of("a", text), false, 1000)->id, false);
  const double later = 1000 + options_.forget_uploads_after_s + 1;
  ASSERT_TRUE(store_->begin_upload(identity_of("b", text), false, later));
  ASSERT_EQ(store_->list()->partials.size(), 1U);
  EXPECT_EQ(store_->list()->partials[0].identity.name, "b");
}

TEST_F(JobStoreTest, TheRunningJobsTextStaysWhoeverDeletesOrReplacesIt) {
  const std::string text = text_of(500);
  const auto read = [&](std::unique_ptr<ByteSource> source) {
    std::string all(1000, '\0');
    all.resize(source->read(all));
    return all;
  };
  ASSERT_EQ(put("a", text), "");
  ASSERT_TRUE(store_->open_to_run("a"));
  store_->keep_what_runs("a");
  EXPECT_EQ(store_->list()->used_bytes, 500U);
  ASSERT_EQ(put("a", text_of(400, 9)), "");
  EXPECT_EQ(store_->list()->used_bytes, 900U);
  // A start that is refused changes nothing.
  ASSERT_TRUE(store_->open_to_run("a"));
  reopen();
  EXPECT_EQ(read(std::move(*store_->open_kept("a"))), text);
  ASSERT_TRUE(store_->remove("a"));
  EXPECT_EQ(read(std::move(*store_->open_kept("a"))), text);
  store_->forget_kept();
  EXPECT_FALSE(store_->open_kept("a"));
}

TEST_F(JobStoreTest, AStoreThatCouldNotBeWrittenAtTheStartCanBeWhenTheDiskCan) {
  std::ofstream(folder_.path() / "blocked") << "x";
  options_.folder = folder_.path() / "blocked" / "jobs";
  reopen();
  EXPECT_EQ(put("a", "x"), store_->folder().string() + " cannot be written");
  fs::remove(folder_.path() / "blocked");
  EXPECT_EQ(put("a", "x"), "");
  EXPECT_TRUE(store_->writable());
  EXPECT_EQ(store_->list()->jobs.size(), 1U);
}

TEST_F(JobStoreTest, AFileOfAPrintHostKeepsToTheQuota) {
  options_.quota_bytes = 1000;
  reopen();
  const fs::path written = options_.folder / ".serial-1";
  std::ofstream(written) << text_of(1001);
  EXPECT_EQ(store_->adopt(written, "a", 1).error().kind, StoreError::Kind::kQuota);
  EXPECT_FALSE(fs::exists(written));
}

}  // namespace
}  // namespace kinebus
