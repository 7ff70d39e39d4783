#include "gui/models/heat_history.hpp"

#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

template <typename List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& each : list) names.push_back(each.name());
  return names;
}

}  // namespace

HeatHistory::HeatHistory(Session& session, QObject* parent) : QObject(parent) {
  connect(&session, &Session::status_changed, this, [this, &session] { take(session.status()); });
}

void HeatHistory::take(const joblink::Status& status) {
  auto heaters = names_of(status.heaters()), fans = names_of(status.fans());
  const bool other = heaters != heaters_ || fans != fans_ ||
                     (!recent_.empty() && status.time_s() < recent_.back().time_s);  // another gateway
  if (other) {
    recent_.clear();
    job_.clear();
    job_name_.clear();
    heaters_ = std::move(heaters);
    fans_ = std::move(fans);
  }
  if (!recent_.empty() && status.time_s() < recent_.back().time_s + kPeriod_s) return;
  Sample sample{.time_s = status.time_s(), .heaters = {}, .fans = {}};
  const auto f = [](double v) { return static_cast<float>(v); };
  for (const joblink::Heater& h : status.heaters())
    sample.heaters.push_back(
        {f(h.actual_celsius()), f(h.target_celsius()), h.has_power() ? f(h.power()) : -1.0F});
  for (const joblink::Output& fan : status.fans()) sample.fans.push_back(f(fan.ratio()));
  take_job(status, sample);
  recent_.push_back(std::move(sample));
  while (recent_.front().time_s < status.time_s() - kRecent_s) recent_.pop_front();
  emit changed();
}

/// A job is kept when it is over, until the next one begins.
void HeatHistory::take_job(const joblink::Status& status, const Sample& sample) {
  if (status.job().empty()) {
    job_name_.clear();
    return;
  }
  if (status.job() != job_name_ || status.elapsed_s() < elapsed_s_) {
    job_.clear();
    job_period_s_ = kPeriod_s;
    job_name_ = status.job();
  }
  elapsed_s_ = status.elapsed_s();
  if (!job_.empty() && sample.time_s < job_.back().time_s + job_period_s_) return;
  job_.push_back(sample);
  if (job_.size() <= kMostOfJob) return;
  std::deque<Sample> half;
  for (std::size_t i = 0; i < job_.size(); i += 2) half.push_back(std::move(job_[i]));
  job_ = std::move(half);
  job_period_s_ *= 2;
}

}  // namespace kinebus::gui
