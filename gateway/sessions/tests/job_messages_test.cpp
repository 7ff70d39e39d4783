// Stored jobs, runs and checks as messages: every value is where its name says, and long lists say that they
// go on.

#include <numeric>

#include "gateway/sessions/console.hpp"
#include "gateway/sessions/messages.hpp"
#include "gateway/sessions/tests/message_text.hpp"

namespace kinebus {
namespace {

StoredRun run_of(RunResult result) {
  StoredRun run{.id = 1, .name = "part", .hash = "h"};
  run.begun_unix_s = 2;
  run.duration_s = 3;
  run.estimate_s = 4;
  run.result = result;
  run.line = 5;
  return run;
}

TEST(JobMessages, AJobIsToldWithWhatIsKnownOfIt) {
  StoredJob job;
  job.name = "part";
  job.hash = "h";
  job.size_bytes = 1;
  job.stored_unix_s = 2;
  expect_says(to_message(job), R"(name: "part" hash: "h" size_bytes: 1 stored_unix_s: 2)");
  job.times_run = 3;
  job.preflight = {.errors = 11, .warnings = 12, .lines = 13, .motion_s = 14, .dwell_s = 15};
  job.last_run = run_of(RunResult::kComplete);
  job.notes.set_slicer("S");
  expect_says(to_message(job), R"(name: "part" hash: "h" size_bytes: 1 stored_unix_s: 2
      preflight { errors: 11 warnings: 12 lines: 13 motion_s: 14 dwell_s: 15 } times_run: 3
      last_run { id: 1 name: "part" hash: "h" begun_unix_s: 2 duration_s: 3 estimate_s: 4 result: JOB_COMPLETE line: 5 }
      notes { slicer: "S" })");
}

TEST(JobMessages, ARunTellsWhatWentWrongInWordsThatCanBeTranslated) {
  StoredRun run = run_of(RunResult::kFailed);
  run.first_error = "node 2 is silent";
  EXPECT_FALSE(to_message(run).has_first_error_said());
  run.said = to_message(say("node %1 is silent", 2)).SerializeAsString();
  EXPECT_EQ(to_message(run).first_error_said().text(), "node %1 is silent");
  EXPECT_EQ(to_message(run).first_error(), "node 2 is silent");
  run.result = RunResult::kInterrupted;
  EXPECT_EQ(to_message(run).first_error_said().text(), "node %1 is silent") << "its own words first";
  run.said.clear();
  EXPECT_EQ(to_message(run).first_error_said().text(), "the gateway ended while the job ran");
  // What nobody here wrote is not taken.
  run.result = RunResult::kFailed;
  run.said = to_message(say("%1", std::string(1900, 'x'))).SerializeAsString();
  EXPECT_TRUE(to_message(run).has_first_error_said());
  joblink::Sentence endless;
  endless.set_text(std::string(16'001, 'x'));
  run.said = endless.SerializeAsString();
  EXPECT_FALSE(to_message(run).has_first_error_said());
}

TEST(JobMessages, AListTellsItsRoomAndWhatIsHalfDone) {
  JobListing listing;
  listing.jobs.resize(1);
  listing.jobs[0].name = "a";
  listing.partials = {{{"b", 1, "h"}, 2, 3, true}};
  listing.used_bytes = 4;
  listing.quota_bytes = 5;
  listing.free_bytes = 6;
  expect_says(to_message(listing), R"(jobs { name: "a" } used_bytes: 4 quota_bytes: 5 free_bytes: 6
      partial_uploads { name: "b" hash: "h" size_bytes: 1 received_bytes: 2 begun_unix_s: 3 open: true })");
  listing.more = true;
  EXPECT_TRUE(to_message(listing).more());
}

TEST(JobMessages, LongListsEndWhereAMessageIsFull) {
  JobListing listing;
  for (const std::size_t half : {200, 201}) {
    listing.partials.assign(half, {{"b", 1, "h"}, 2, 3, true});
    EXPECT_EQ(to_message(listing).partial_uploads_size(), 200);
  }
  // Names are at most 255 bytes, and are cut; hashes are as long as somebody says.
  listing.partials.assign(100, {{"b", 1, std::string(10'000, 'h')}, 2, 3, true});
  EXPECT_LE(to_message(listing).ByteSizeLong(), ListRoom::kBytes);
  EXPECT_GT(to_message(listing).partial_uploads_size(), 70);
  listing.partials.clear();
  listing.jobs.resize(100);
  for (StoredJob& job : listing.jobs) job.notes.set_slicer(std::string(10'000, 's'));
  joblink::JobList told = to_message(listing);
  EXPECT_TRUE(told.more());
  EXPECT_GT(told.jobs_size(), 70);
  EXPECT_LE(told.ByteSizeLong(), ListRoom::kBytes);
  listing.jobs.resize(70);
  told = to_message(listing);
  EXPECT_FALSE(told.more());
  EXPECT_EQ(told.jobs_size(), 70);
}

TEST(JobMessages, ACheckTellsWhatItFoundInOrder) {
  JobReport report{.lines = 1,
                   .moves = 2,
                   .motion_s = 3,
                   .dwell_s = 4,
                   .runs = 5,
                   .pauses = 6,
                   .heat_waits = 7,
                   .objects = {}};
  ProblemList problems;
  problems.add({Problem::Severity::kError, 11, 12, say("too far")});
  problems.add({Problem::Severity::kWarning, 13, 14, say("cold")});
  problems.add({Problem::Severity::kWarning, 15, 0, say("cold")});
  expect_says(to_message(report, problems),
              R"(summary { errors: 1 warnings: 2 lines: 1 motion_s: 3 dwell_s: 4 }
      moves: 2 pauses: 6 heat_waits: 7
      problems { error: true line: 11 column: 12 words: "too far" said { text: "too far" } }
      problems { line: 13 column: 14 words: "cold" said { text: "cold" } }
      problems { line: 15 words: "cold" said { text: "cold" } })");
  ProblemList many(5000);
  for (int i = 0; i < 1000; ++i)
    many.add({Problem::Severity::kError, 1, 1, Sentence::verbatim(std::string(2000, 'x'))});
  const auto told = to_message(report, many);
  EXPECT_EQ(told.summary().errors(), 1000U);
  EXPECT_GT(told.problems_size(), 100);
  EXPECT_LE(told.ByteSizeLong(), joblink::kMaxMessageBytes);
}

TEST(JobMessages, ErrorsOfAMachineFileTellWhatWasFoundAndHowManyMoreThereAre) {
  MachineFileErrors errors;
  errors.push_back({"m.toml", 3, "joint.C.node", {}, say("a number")});
  errors.push_back({"m.toml", 4, "name", say("a number"), say("a text")});
  const auto two = to_message(errors);
  ASSERT_EQ(two.problems_size(), 2);
  EXPECT_EQ(two.more(), 0U);
  EXPECT_EQ(two.problems(0).rule(), "missing");
  EXPECT_EQ(two.problems(0).line(), 3U);
  EXPECT_EQ(two.problems(0).place(), "joint.C.node");
  EXPECT_EQ(two.problems(1).rule(), "found a number");
  EXPECT_EQ(two.problems(1).expected(), "a text");
  EXPECT_EQ(two.problems(1).expected_said().text(), "a text");
  errors.resize(300);
  EXPECT_EQ(to_message(errors).problems_size(), 300);
  EXPECT_EQ(to_message(errors).more(), 0U);
  EXPECT_FALSE(to_message(errors).problems(299).has_expected_said());
  errors.resize(302);
  EXPECT_EQ(to_message(errors).problems_size(), 300);
  EXPECT_EQ(to_message(errors).more(), 2U);
  for (MachineFileError& error : errors) error.found = Sentence::verbatim(std::string(2000, 'x'));
  const auto full = to_message(errors);
  EXPECT_LE(full.ByteSizeLong(), joblink::kMaxMessageBytes);
  EXPECT_EQ(static_cast<std::uint32_t>(full.problems_size()) + full.more(), 302U);
}

// Which lines of the console change something.

TEST(Console, OnlyWhatAsksNeedsNoControl) {
  for (const char* line :
       {"",     " ",    "\t",   ";",    " ; M112", "M105", "m105", " M105",     "\tM105 ", "M105 S1", "M27",
        "M112", "M114", "M115", "M119", "M410",    "M503", "M420", "M420 ; S1", "M420 V",  "M956"})
    EXPECT_FALSE(needs_control(line)) << line;
  for (const char* line : {"G28",     "G105",    "G27",     "X1",      "M104 S0", "M106",  "M28",  "M420 S1",
                           "M420 s0", "M420 Z2", "M956 S1", "M421",    "M105.1",  "M1050", "M0",   "M",
                           "M:",      "M/",      "M105105", "M000105", "M99999",  "M 105", "xM105"})
    EXPECT_TRUE(needs_control(line)) << line;
}

}  // namespace
}  // namespace kinebus
