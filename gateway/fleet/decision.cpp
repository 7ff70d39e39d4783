#include "gateway/fleet/decision.hpp"

namespace kinebus::fleet {
namespace {

Action without_job(const GatewayFacts& gateway, const Policy& policy) {
  if (gateway.interrupted) return policy.give_up ? Action::kCancelRun : Action::kWait;
  if (gateway.takes_job) return Action::kClaim;
  return policy.home && gateway.can_home ? Action::kHome : Action::kWait;
}

Action before_start(const QueuedJob& job, const GatewayFacts& gateway, const Policy& policy) {
  if (gateway.history_is_short) return Action::kAskOperator;
  // What was noted as started and is in no history: only a person can tell.
  if (job.started) return Action::kAskOperator;
  if (job.cancel) return Action::kUseUp;
  if (gateway.interrupted) return policy.give_up ? Action::kCancelRun : Action::kWait;
  if (gateway.takes_job) return Action::kStart;
  return policy.home && gateway.can_home ? Action::kHome : Action::kWait;
}

Action under_way(const QueuedJob& job, const GatewayFacts& gateway, const Policy& policy) {
  if (!job.started) return Action::kNoteStarted;
  if (job.cancel || (gateway.interrupted && policy.give_up)) return Action::kCancelRun;
  return Action::kWait;
}

}  // namespace

std::string ticket_of(const QueuedJob& job) {
  return "fleet-" + std::to_string(job.id) + "-" + std::to_string(job.attempt) + ".once.gcode";
}

const char* to_word(Result result) {
  switch (result) {
    case Result::kComplete:
      return "complete";
    case Result::kCancelled:
      return "cancelled";
    case Result::kRefused:
      return "refused";
    case Result::kFailed:
      return "failed";
    case Result::kInterrupted:
      return "interrupted";
  }
  return "?";
}

Action decide(const std::optional<QueuedJob>& job, const GatewayFacts& gateway, const Policy& policy) {
  if (!job) return without_job(gateway, policy);
  if (!gateway.run) return before_start(*job, gateway, policy);
  const TicketRun& run = *gateway.run;
  if (run.text_hash != job->text_hash) return run.ended ? Action::kNoteNotRun : Action::kWait;
  const bool goes_on = gateway.interrupted && gateway.job == ticket_of(*job);
  if (!run.ended || goes_on) return under_way(*job, gateway, policy);
  const bool never_taken = run.result == Result::kRefused && run.duration_s == 0;
  if (never_taken) return job->cancel ? Action::kNoteNotRun : Action::kNextAttempt;
  return Action::kNoteEnded;
}

}  // namespace kinebus::fleet
