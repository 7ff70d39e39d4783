// What the history holds of a job: how it ended, and what was said first.

#include "gateway/sessions/run_recorder.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace kinebus {
namespace {

using namespace std::chrono_literals;
using Kind = MachineEvent::Kind;
using Result = RunRecorder::Result;
using S = MachineState;

MachineEvent event(Kind kind, const char* words = "") {
  MachineEvent made;
  made.kind = kind;
  made.words = Sentence::verbatim(words);
  return made;
}
MachineEvent state(S to) {
  MachineEvent made = event(Kind::kState);
  made.when = 10s;
  made.state = to;
  return made;
}
MachineEvent problem(const char* words, std::uint32_t line) {
  MachineEvent made = event(Kind::kProblem, words);
  made.line = line;
  return made;
}
MachineEvent alarm(const char* words) {
  return event(Kind::kAlarm, words);
}
const MachineEvent kFinished = event(Kind::kFinished);

/// Of a job that begins at 2 s; all but the last leave it under way.
RunRecorder::Ended end_of(const std::vector<MachineEvent>& events) {
  RunRecorder recorder;
  recorder.begin(2s);
  std::optional<RunRecorder::Ended> ended;
  for (const MachineEvent& event : events) {
    EXPECT_FALSE(ended) << "before its end";
    EXPECT_TRUE(recorder.active());
    ended = recorder.on_event(event);
  }
  EXPECT_TRUE(ended);
  EXPECT_FALSE(recorder.active());
  return ended.value_or(RunRecorder::Ended{});
}

TEST(RunRecorder, TellsHowAJobEnded) {
  EXPECT_EQ(end_of({state(S::kChecking), state(S::kRunning), kFinished, state(S::kReady)}).result,
            Result::kComplete);
  EXPECT_EQ(end_of({state(S::kChecking), kFinished, state(S::kReady)}).result, Result::kRefused);
  EXPECT_EQ(end_of({state(S::kChecking), state(S::kReady)}).result, Result::kCancelled);
  EXPECT_EQ(end_of({state(S::kRunning), state(S::kUnhomed)}).result, Result::kCancelled);
  EXPECT_EQ(end_of({state(S::kRunning), alarm("silent"), kFinished, state(S::kOff)}).result, Result::kFailed);
  EXPECT_EQ(end_of({state(S::kRunning), state(S::kReady)}).duration_s, 8);
}

TEST(RunRecorder, NewsFromBeforeTheJobDoNotEndIt) {
  EXPECT_EQ(end_of({state(S::kReady), state(S::kUnhomed), state(S::kOff), state(S::kChecking),
                    state(S::kRunning), state(S::kHeld), state(S::kAlarm), state(S::kReady)})
                .result,
            Result::kCancelled);
  RunRecorder idle;
  EXPECT_FALSE(idle.on_event(state(S::kRunning)));
  EXPECT_FALSE(idle.on_event(state(S::kReady))) << "no job is under way";
}

TEST(RunRecorder, KeepsTheFirstErrorAndRatherTheFirstAlarm) {
  const auto said = [](std::vector<MachineEvent> events) {
    events.insert(events.begin(), state(S::kRunning));
    events.push_back(state(S::kReady));
    return end_of(events).first_error.english();
  };
  EXPECT_EQ(said({problem("warning: hot", 3), problem("error: far", 4), problem("error: more", 5)}),
            "line 4: error: far");
  EXPECT_EQ(said({problem("error: far", 4), alarm("silent"), alarm("stopped")}), "silent");
  EXPECT_EQ(said({alarm("silent"), problem("error: far", 4)}), "silent");
  EXPECT_EQ(said({}), "");
}

TEST(RunRecorder, TellsHowFarItCameAndWhatWasEstimatedWhenItBeganToMove) {
  RunRecorder recorder;
  MachineStatus status;
  status.line = 90;
  recorder.on_status(status);  // before it has begun
  recorder.begin(2s);
  for (const auto& [at, line, elapsed_s, remaining_s] :
       {std::tuple{S::kChecking, 3U, 0., 50.}, std::tuple{S::kRunning, 5U, 1., 0.},
        std::tuple{S::kRunning, 9U, 2., 40.}, std::tuple{S::kRunning, 7U, 3., 60.}}) {
    status.state = at;
    status.line = line;
    status.elapsed_s = elapsed_s;
    status.remaining_s = remaining_s;
    recorder.on_status(status);
  }
  recorder.on_event(state(S::kRunning));
  const auto ended = recorder.on_event(state(S::kOff));
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->line, 9U);
  EXPECT_EQ(ended->estimate_s, 42);
}

}  // namespace
}  // namespace kinebus
