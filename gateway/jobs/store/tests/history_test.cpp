// Runs: what the history tells of them, and what runs once.
#include "gateway/jobs/store/tests/job_store_fixture.hpp"

namespace kinebus {
namespace {

using joblink::job_hash_of;
using HistoryTest = testing_store::JobStoreTest;

TEST_F(HistoryTest, HistoryTellsHowEachRunEnded) {
  EXPECT_EQ(put("a", "1"), "");
  const auto first = store_->begin_run({.name = "a", .hash = job_hash_of("1"), .begun_unix_s = 10});
  ASSERT_TRUE(first);
  EXPECT_TRUE(store_->end_run(*first, RunResult::kComplete, 61.5, 60, 900, ""));
  const auto second = store_->begin_run({.name = "a", .hash = job_hash_of("1"), .begun_unix_s = 100});
  ASSERT_TRUE(second);
  reopen();
  const auto runs = *store_->history(0, 10);
  ASSERT_EQ(runs.size(), 2U);
  EXPECT_EQ(runs[0].result, RunResult::kInterrupted);
  EXPECT_EQ(runs[0].first_error, "the gateway ended while the job ran");
  EXPECT_EQ(runs[1].result, RunResult::kComplete);
  EXPECT_EQ(runs[1].duration_s, 61.5);
  EXPECT_EQ(runs[1].estimate_s, 60);
  EXPECT_EQ(store_->history(runs[0].id, 10)->size(), 1U);
  EXPECT_EQ(store_->list()->jobs[0].times_run, 2U);
  EXPECT_EQ(store_->list()->jobs[0].last_run->id, runs[0].id);
}

TEST_F(HistoryTest, WhatRunsOnceIsBegunOnceAndInTheHistoryBeforeAnythingOfItHappens) {
  EXPECT_EQ(put("part.once.gcode", "1"), "");
  EXPECT_EQ(put("part.gcode", "1"), "");
  ASSERT_TRUE(store_->begin_job("part.gcode", 5));
  const auto begun = store_->begin_job("part.once.gcode", 10);
  ASSERT_TRUE(begun);
  EXPECT_NE(begun->run, 0);
  reopen();  // as after a kill: whether the machine had it already is not known, so it has begun
  EXPECT_TRUE(store_->begin_job("part.gcode", 20));
  const auto again = store_->begin_job("part.once.gcode", 20);
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().words.english(), "part.once.gcode was started before: a job of its name runs once");
  EXPECT_EQ(put("part.once.gcode", "another text"), "");
  EXPECT_FALSE(store_->begin_job("part.once.gcode", 30));
  EXPECT_EQ(store_->history(0, 10)->size(), 3U);
}

TEST_F(HistoryTest, AStartThatTheMachineRefusesIsForgottenAndOfWhatRunsOnceItIsKept) {
  EXPECT_EQ(put("a", "1"), "");
  EXPECT_EQ(put("a.once.gcode", "1"), "");
  store_->refuse_run(store_->begin_job("a", 10)->run, "a", "not homed", "");
  EXPECT_TRUE(store_->history(0, 10)->empty());
  store_->refuse_run(store_->begin_job("a.once.gcode", 10)->run, "a.once.gcode", "not homed", "");
  const auto runs = *store_->history(0, 10);
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].result, RunResult::kRefused);
  EXPECT_EQ(runs[0].duration_s, 0);
  EXPECT_EQ(runs[0].first_error, "not homed");
  EXPECT_FALSE(store_->begin_job("a.once.gcode", 20));
}

}  // namespace
}  // namespace kinebus
