// The store is killed at random moments, and its files are cut where a disk without power may have left them.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "gateway/jobs/store/job_store.hpp"
#include "gateway/jobs/store/tests/temporary_folder.hpp"
#include "protocol/joblink/job_hash.hpp"

namespace kinebus {
namespace {

namespace fs = std::filesystem;
using joblink::job_hash_of;

std::string text_of(int version) {
  return std::string(static_cast<std::size_t>(200 + version * 37 % 5000),
                     static_cast<char>('a' + version % 26));
}

/// Stores version after version under four names and keeps a history; tells by one byte whatever was
/// acknowledged.
[[noreturn]] void work(const fs::path& folder, int pipe, int first) {
  auto store = JobStore::open({.folder = folder, .margin_bytes = 0}, 1000);
  for (int version = first;; ++version) {
    const std::string text = text_of(version), name = "job" + std::to_string(version % 4);
    const auto run = store->begin_run({.name = name, .hash = job_hash_of(text)});
    const auto begun = store->begin_upload({name, text.size(), job_hash_of(text)}, true, 1000);
    if (!run || !begun) ::_exit(1);
    // Stored by the process before, which was killed before it could say so.
    if (!begun->stored && (!store->append(begun->id, 0, text) || !store->commit(begun->id, version)))
      ::_exit(2);
    if (!store->end_run(*run, RunResult::kComplete, 1, 1, 1, "")) ::_exit(3);
    if (::write(pipe, "x", 1) != 1) ::_exit(1);
  }
}

TEST(PowerCut, WhatWasAcknowledgedIsThereAfterAKillAtAnyMoment) {
  const unsigned seed = std::random_device()();
  std::mt19937 random(seed);
  SCOPED_TRACE("seed " + std::to_string(seed));
  TemporaryFolder folder;
  int version = 0;
  std::size_t runs = 0;
  for (int round = 0; round < 25; ++round) {
    int ends[2];
    ASSERT_EQ(::pipe(ends), 0);
    const pid_t child = ::fork();
    if (child == 0) work(folder.path(), ends[1], version);
    ::close(ends[1]);
    const auto acknowledged = static_cast<unsigned>(1 + random() % 6);
    char byte = 0;
    for (unsigned i = 0; i < acknowledged; ++i) ASSERT_EQ(::read(ends[0], &byte, 1), 1);
    // Somewhere within the next version: some rounds of the loop more, of no fixed duration.
    volatile auto wait = static_cast<unsigned>(random() % 400'000);
    while (wait > 0) wait = wait - 1;
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    unsigned done = acknowledged;
    while (::read(ends[0], &byte, 1) == 1) ++done;
    ::close(ends[0]);
    version += static_cast<int>(done);
    runs += done;

    auto store = JobStore::open({.folder = folder.path(), .margin_bytes = 0}, 1000);
    ASSERT_TRUE(store->notes().empty()) << store->notes().front();
    const auto listing = store->list();
    ASSERT_TRUE(listing);
    for (const StoredJob& job : listing->jobs) {
      std::ostringstream text;
      text << std::ifstream(folder.path() / job.name).rdbuf();
      EXPECT_EQ(job.hash, job_hash_of(text.str())) << job.name;
    }
    // The last four acknowledged versions, or one that was stored but not acknowledged yet.
    for (int v = std::max(0, version - 4); v < version; ++v) {
      const auto job = store->find("job" + std::to_string(v % 4));
      ASSERT_TRUE(job);
      EXPECT_TRUE(job->hash == job_hash_of(text_of(v)) ||
                  (v == version - 4 && job->hash == job_hash_of(text_of(version))));
    }
    std::size_t complete = 0;
    const auto history = store->history(0, 1000);
    ASSERT_TRUE(history);
    for (const StoredRun& run : *history) complete += run.result == RunResult::kComplete ? 1 : 0;
    EXPECT_GE(complete, runs);
    EXPECT_LE(complete, runs + 1);
    runs = complete;
  }
}

TEST(PowerCut, BytesThatNeverReachedTheDiskAreSentAgain) {
  TemporaryFolder folder;
  const std::string text(40U << 20, 'g');
  const UploadIdentity identity{"big", text.size(), job_hash_of(text)};
  for (const std::size_t left : {0UL, 5UL << 20, 20UL << 20, 34UL << 20}) {
    {
      auto store = JobStore::open({.folder = folder.path(), .margin_bytes = 0}, 1000);
      const auto begun = store->begin_upload(identity, true, 1000);
      ASSERT_TRUE(begun);
      std::size_t at = begun->received_bytes;
      for (; at < (35U << 20); at += 1U << 20)
        ASSERT_TRUE(store->append(begun->id, at, std::string_view(text).substr(at, 1U << 20)));
    }
    // The file's length was on the disk, its last bytes were not.
    for (const auto& entry : fs::directory_iterator(folder.path()))
      if (entry.path().filename().string().starts_with(".upload-")) {
        fs::resize_file(entry.path(), left);
        fs::resize_file(entry.path(), 35U << 20);
      }
    auto store = JobStore::open({.folder = folder.path(), .margin_bytes = 0}, 1000);
    const auto begun = store->begin_upload(identity, true, 1000);
    ASSERT_TRUE(begun);
    if (left >= (32U << 20)) {
      EXPECT_EQ(begun->received_bytes, 32U << 20);
    }
    std::size_t at = begun->received_bytes;
    ASSERT_TRUE(store->append(begun->id, at, std::string_view(text).substr(at)));
    const auto stored = store->commit(begun->id, 1);
    // Secured bytes that the disk lost all the same are found by the checksum, and nothing wrong is stored.
    EXPECT_EQ(bool(stored), left >= (32U << 20)) << left;
    static_cast<void>(store->remove("big"));
  }
}

TEST(PowerCut, ADatabaseCutAnywhereIsMadeAnewFromTheJobs) {
  TemporaryFolder folder;
  {
    auto store = JobStore::open({.folder = folder.path(), .margin_bytes = 0}, 1000);
    for (int v = 0; v < 4; ++v) {
      const std::string text = text_of(v);
      const auto begun =
          store->begin_upload({"job" + std::to_string(v), text.size(), job_hash_of(text)}, true, 1000);
      ASSERT_TRUE(begun && store->append(begun->id, 0, text) && store->commit(begun->id, 1));
    }
  }
  const fs::path database = folder.path() / ".jobs.sqlite", whole = folder.path() / ".whole";
  fs::copy_file(database, whole);
  for (std::uintmax_t size = 0; size < fs::file_size(whole); size += 1511) {
    fs::copy_file(whole, database, fs::copy_options::overwrite_existing);
    fs::resize_file(database, size);
    auto store = JobStore::open({.folder = folder.path(), .margin_bytes = 0}, 1000);
    const auto listing = store->list();
    ASSERT_TRUE(listing) << "cut to " << size;
    ASSERT_EQ(listing->jobs.size(), 4U) << "cut to " << size;
    EXPECT_EQ(listing->jobs[3].hash, job_hash_of(text_of(3)));
    EXPECT_TRUE(store->begin_run({.name = "job0"})) << "cut to " << size;
  }
}

}  // namespace
}  // namespace kinebus
