#include "gateway/fleet/decision.hpp"

#include <gtest/gtest.h>

namespace kinebus::fleet {
namespace {

const QueuedJob kJob{.id = 7, .text_hash = "text", .attempt = 2};
const GatewayFacts kReady{.takes_job = true};

QueuedJob started() {
  QueuedJob job = kJob;
  job.started = true;
  return job;
}
QueuedJob cancelled(QueuedJob job) {
  job.cancel = true;
  return job;
}
GatewayFacts with_run(TicketRun run) {
  GatewayFacts facts = kReady;
  facts.run = std::move(run);
  return facts;
}

TEST(Decision, ATicketNamesJobAndAttemptAndRunsOnce) {
  EXPECT_EQ(ticket_of(kJob), "fleet-7-2.once.gcode");
}

TEST(Decision, WithoutAJobAGatewayThatTakesOneAsksForIt) {
  EXPECT_EQ(decide({}, kReady, {}), Action::kClaim);
  EXPECT_EQ(decide({}, {}, {}), Action::kWait);
}

TEST(Decision, OnlyWhatIsInNoHistoryIsStarted) {
  EXPECT_EQ(decide(kJob, kReady, {}), Action::kStart);
  EXPECT_EQ(decide(kJob, {}, {}), Action::kWait);
  for (const bool ended : {false, true})
    for (const Result result : {Result::kComplete, Result::kFailed, Result::kInterrupted, Result::kRefused})
      EXPECT_NE(decide(kJob, with_run({.text_hash = "text", .ended = ended, .result = result}), {}),
                Action::kStart);
}

TEST(Decision, NobodyKnowsWhatAHistoryDoesNotTell) {
  GatewayFacts facts = kReady;
  EXPECT_EQ(decide(started(), facts, {}), Action::kAskOperator);
  facts.history_is_short = true;
  EXPECT_EQ(decide(kJob, facts, {}), Action::kAskOperator);
  EXPECT_EQ(decide(cancelled(kJob), facts, {}), Action::kAskOperator);
}

TEST(Decision, ARunIsNotedFirstAndThenFollowedToItsEnd) {
  const GatewayFacts runs = with_run({.text_hash = "text"});
  EXPECT_EQ(decide(kJob, runs, {}), Action::kNoteStarted);
  EXPECT_EQ(decide(started(), runs, {}), Action::kWait);
  EXPECT_EQ(decide(cancelled(started()), runs, {}), Action::kCancelRun);
  const GatewayFacts done = with_run({.text_hash = "text", .ended = true, .duration_s = 3});
  EXPECT_EQ(decide(kJob, done, {}), Action::kNoteEnded);
  EXPECT_EQ(decide(started(), done, {}), Action::kNoteEnded);
}

TEST(Decision, AnInterruptedJobIsUnderWayAsLongAsItMayGoOn) {
  GatewayFacts facts = with_run({.text_hash = "text", .ended = true, .result = Result::kInterrupted});
  facts.interrupted = true;
  facts.job = ticket_of(kJob);
  EXPECT_EQ(decide(started(), facts, {}), Action::kWait);
  EXPECT_EQ(decide(started(), facts, {.give_up = true}), Action::kCancelRun);
  facts.interrupted = false;
  EXPECT_EQ(decide(started(), facts, {}), Action::kNoteEnded);
}

TEST(Decision, SomebodysInterruptedJobIsNotPushedAside) {
  GatewayFacts facts = kReady;
  facts.interrupted = true;
  facts.job = "annas part.gcode";
  EXPECT_EQ(decide({}, facts, {}), Action::kWait);
  EXPECT_EQ(decide(kJob, facts, {}), Action::kWait);
}

TEST(Decision, AStartThatTheMachineRefusedIsTriedWithAnotherTicket) {
  const GatewayFacts refused =
      with_run({.text_hash = "text", .ended = true, .result = Result::kRefused, .duration_s = 0});
  EXPECT_EQ(decide(kJob, refused, {}), Action::kNextAttempt);
  EXPECT_EQ(decide(cancelled(kJob), refused, {}), Action::kNoteNotRun);
  const GatewayFacts by_check =
      with_run({.text_hash = "text", .ended = true, .result = Result::kRefused, .duration_s = 0.2});
  EXPECT_EQ(decide(kJob, by_check, {}), Action::kNoteEnded);
}

TEST(Decision, AJobThatIsCancelledBeforeItsStartHasItsTicketUsedUp) {
  EXPECT_EQ(decide(cancelled(kJob), kReady, {}), Action::kUseUp);
  EXPECT_EQ(decide(cancelled(kJob), with_run({.text_hash = "void"}), {}), Action::kWait);
  EXPECT_EQ(decide(cancelled(kJob), with_run({.text_hash = "void", .ended = true}), {}), Action::kNoteNotRun);
  // Another agent's start was faster than the one that should use it up.
  EXPECT_EQ(decide(cancelled(kJob), with_run({.text_hash = "text"}), {}), Action::kNoteStarted);
}

TEST(Decision, MachinesAreHomedOnlyWhereItIsAllowed) {
  const GatewayFacts off{.can_home = true};
  EXPECT_EQ(decide({}, off, {}), Action::kWait);
  EXPECT_EQ(decide({}, off, {.home = true}), Action::kHome);
  EXPECT_EQ(decide(kJob, off, {.home = true}), Action::kHome);
}

}  // namespace
}  // namespace kinebus::fleet
