#include "gateway/sessions/http/slicers/octoprint_events.hpp"

#include <algorithm>

#include "gateway/sessions/http/slicers/octoprint.hpp"

namespace kinebus::http {
namespace {

/// "OPERATIONAL" of "Operational", as state_id has it.
std::string state_id(const joblink::Status& status) {
  std::string id = octoprint_state(status);
  std::transform(id.begin(), id.end(), id.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return id;
}

}  // namespace

OctoPrintEvents::OctoPrintEvents(const joblink::Status& status, bool in_job)
    : state_(status.state()),
      in_job_(in_job),
      runs_(in_job && status.state() != joblink::STATE_CHECKING),
      name_(status.job()),
      begun_s_(status.time_s() - status.elapsed_s()),
      pause_began_s_(status.time_s()) {}

Json OctoPrintEvents::job() const {
  return {{"name", name_}, {"path", name_}, {"origin", "local"}};
}
Json OctoPrintEvents::ended(double time_s, const char* reason) const {
  Json payload = job();
  payload["time"] = std::max(time_s - begun_s_ - paused_s_, 0.0);
  if (reason != nullptr) payload["reason"] = reason;
  return payload;
}

OctoPrintEvents::Told OctoPrintEvents::of(const joblink::Event& event, const joblink::Status& status) {
  Told told;
  switch (event.kind()) {
    case joblink::EVENT_STATE:
      if (!status.job().empty()) name_ = status.job();
      told.emplace_back("PrinterStateChanged",
                        Json{{"state_id", state_id(status)}, {"state_string", octoprint_state(status)}});
      on_state(event, told);
      break;
    case joblink::EVENT_ALARM:
      told.emplace_back("Error", Json{{"error", event.words()}, {"reason", event.advice()}});
      break;
    case joblink::EVENT_JOBS:
      told.emplace_back("UpdatedFiles", Json::object({{"type", "printables"}}));
      break;
    default:
      break;
  }
  return told;
}

void OctoPrintEvents::on_state(const joblink::Event& event, Told& told) {
  const joblink::State before = std::exchange(state_, event.state());
  const double now_s = event.time_s();
  const bool had_job = in_job_;
  switch (event.state()) {
    case joblink::STATE_CHECKING:
      in_job_ = true;
      runs_ = cancelled_ = false;
      begun_s_ = now_s;
      paused_s_ = 0;
      break;
    case joblink::STATE_RUNNING:
      if (!in_job_ || !std::exchange(runs_, true)) {
        in_job_ = true;
        told.emplace_back("PrintStarted", job());
      } else if (before == joblink::STATE_HELD) {
        paused_s_ += now_s - pause_began_s_;
        told.emplace_back("PrintResumed", job());
      }
      break;
    case joblink::STATE_HELD:
      pause_began_s_ = now_s;
      if (in_job_) told.emplace_back("PrintPaused", job());
      break;
    case joblink::STATE_CANCELLING:
      cancelled_ = true;
      if (in_job_) told.emplace_back("PrintCancelling", job());
      break;
    case joblink::STATE_READY:
      in_job_ = false;
      if (!had_job) break;
      if (runs_ && !cancelled_) {
        told.emplace_back("PrintDone", ended(now_s, nullptr));
      } else {
        told.emplace_back("PrintFailed", ended(now_s, cancelled_ ? "cancelled" : "error"));
        if (cancelled_) told.emplace_back("PrintCancelled", ended(now_s, nullptr));
      }
      break;
    case joblink::STATE_STOPPED:
    case joblink::STATE_ALARM:
      in_job_ = false;
      if (had_job) told.emplace_back("PrintFailed", ended(now_s, "error"));
      break;
    default:
      break;
  }
}

}  // namespace kinebus::http
