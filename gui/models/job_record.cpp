#include "gui/models/job_record.hpp"

#include <algorithm>
#include <utility>

#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

/// In the midst of motion: queues fill before it and are empty at its end, as they should.
bool streams(const joblink::Status& status) {
  constexpr double kEnding_s = 3;
  return status.doing() == "moving" && status.rate() > 0.99 && status.remaining_s() > kEnding_s;
}

std::uint32_t stalls_of(const joblink::Status& status) {
  const joblink::Counters& counters = status.counters();
  return counters.starvation_holds() + counters.bus_slowdowns() + counters.underruns();
}

}  // namespace

JobRecord::JobRecord(Session& session, QObject* parent) : QObject(parent) {
  connect(&session, &Session::event_arrived, this, [this](const joblink::Event& event) {
    if (event.kind() != joblink::EVENT_PROBLEM) return;
    joblink::Problem problem;
    problem.set_rule(event.words());
    *problem.mutable_rule_said() = event.said();
    const bool error = event.words().starts_with("error");
    found_.push_back({error, static_cast<int>(event.line()), 0, std::move(problem)});
  });
  connect(&session, &Session::status_changed, this, [this, &session] { take(session.status()); });
  connect(&session, &Session::link_changed, this, [this, &session] {
    if (session.link_state() != Session::LinkState::kNone) return;
    name_.clear();
    end_ = End::kNone;
    under_way_ = false;
  });
}

void JobRecord::take(const joblink::Status& status) {
  const joblink::State before = std::exchange(before_, status.state());
  if (status.job().empty()) {
    if (under_way_)
      finish(before == joblink::STATE_CHECKING     ? End::kRefused
             : before == joblink::STATE_RUNNING    ? End::kComplete
             : before == joblink::STATE_CANCELLING ? End::kCancelled
             : status.state() == joblink::STATE_READY || status.state() == joblink::STATE_UNHOMED ||
                     status.state() == joblink::STATE_OFF
                 ? End::kCancelled
                 : End::kStopped);
    return;
  }
  const bool another = !under_way_ || status.job() != name_;
  if (another) begin(status);
  const bool runs = status.state() == joblink::STATE_RUNNING;
  if (runs && before == joblink::STATE_CHECKING) {
    problems_ = std::exchange(found_, {});
    emit checked();
  }
  if (status.has_job_filament_mm()) figures_.filament_mm = status.job_filament_mm();
  figures_.elapsed_s = std::max(figures_.elapsed_s, status.elapsed_s());
  figures_.stalls = stalls_of(status) >= stalls_before_ ? stalls_of(status) - stalls_before_ : 0;
  const bool streamed = std::exchange(streamed_, runs && streams(status));
  if (!runs) return;
  figures_.bus_load = std::max(figures_.bus_load, status.bus_load());
  for (const auto& node : status.nodes()) {
    figures_.clock_error_us = std::max(figures_.clock_error_us, node.sync_error_s() * 1e6);
    if (node.queue_capacity() > 0 && streamed && streamed_)
      figures_.emptiest_queue = std::min(figures_.emptiest_queue,
                                         static_cast<double>(node.queue_records()) / node.queue_capacity());
  }
}

void JobRecord::begin(const joblink::Status& status) {
  name_ = status.job();
  end_ = End::kNone;
  figures_ = {};
  problems_.clear();
  found_.clear();
  under_way_ = true;
  stalls_before_ = stalls_of(status);
}

void JobRecord::finish(End end) {
  under_way_ = false;
  end_ = end;
  problems_ = std::exchange(found_, {});
  emit ended();
}

}  // namespace kinebus::gui
