#include "gateway/sessions/run_recorder.hpp"

#include <algorithm>

namespace kinebus {

void RunRecorder::begin(LocalTime now) {
  *this = RunRecorder();
  active_ = true;
  begun_ = now;
}

std::optional<RunRecorder::Ended> RunRecorder::on_event(const MachineEvent& event) {
  if (!active_) return std::nullopt;
  switch (event.kind) {
    case MachineEvent::Kind::kState:
      ran_ = ran_ || event.state == MachineState::kRunning;
      // News from before the job may still be on their way.
      seen_ = seen_ || ran_ || event.state == MachineState::kChecking;
      if (seen_ && (event.state == MachineState::kReady || event.state == MachineState::kUnhomed ||
                    event.state == MachineState::kOff))
        return end(event.when);
      break;
    case MachineEvent::Kind::kProblem:
      if (first_error_.empty() && event.words.starts_with("error"))
        first_error_ = say("line %1: %2", event.line, event.words);
      break;
    case MachineEvent::Kind::kAlarm:
      if (!alarm_) first_error_ = event.words;
      alarm_ = true;
      break;
    case MachineEvent::Kind::kFinished:
      finished_ = true;
      break;
    case MachineEvent::Kind::kMessage:
      break;
  }
  return std::nullopt;
}

void RunRecorder::on_status(const MachineStatus& status) {
  if (!active_) return;
  line_ = std::max(line_, status.line);
  if (estimate_s_ == 0 && status.state == MachineState::kRunning && status.remaining_s > 0)
    estimate_s_ = status.elapsed_s + status.remaining_s;
}

RunRecorder::Ended RunRecorder::end(LocalTime now) {
  active_ = false;
  Ended ended{Result::kCancelled, to_seconds(now - begun_), estimate_s_, line_, first_error_};
  if (alarm_)
    ended.result = Result::kFailed;
  else if (finished_)
    ended.result = ran_ ? Result::kComplete : Result::kRefused;
  return ended;
}

}  // namespace kinebus
