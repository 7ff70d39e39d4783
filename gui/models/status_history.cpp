#include "gui/models/status_history.hpp"

#include <algorithm>

#include "gui/session/session.hpp"

namespace kinebus::gui {

StatusHistory::StatusHistory(Session& session, QObject* parent) : QObject(parent) {
  connect(&session, &Session::status_changed, this, [this, &session] {
    const joblink::Status& s = session.status();
    if (!samples_.empty() && s.time_s() < samples_.back().time_s) samples_.clear();  // another gateway
    if (!samples_.empty() && s.time_s() < samples_.back().time_s + kPeriod_s) return;
    double sync = 0, queue = 1;
    for (const auto& node : s.nodes()) {
      sync = std::max(sync, node.sync_error_s() * 1e6);
      if (node.queue_capacity() > 0)
        queue = std::min(queue, static_cast<double>(node.queue_records()) / node.queue_capacity());
    }
    if (s.nodes_size() == 0) queue = 0;
    const auto f = [](double v) { return static_cast<float>(v); };
    samples_.push_back({s.time_s(), {f(s.bus_load()), f(sync), f(queue), f(s.rate())}});
    while (samples_.front().time_s < s.time_s() - kKept_s) samples_.pop_front();
    emit changed();
  });
}

}  // namespace kinebus::gui
