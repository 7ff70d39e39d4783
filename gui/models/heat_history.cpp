#include "gui/models/heat_history.hpp"

#include <algorithm>

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
  connect(&session, &Session::heat_course_told, this,
          [this](const joblink::HeatCourse& course) { take(course); });
}

void HeatHistory::begin_anew(std::vector<std::string> heaters, std::vector<std::string> fans) {
  recent_.clear();
  job_.clear();
  job_name_.clear();
  heaters_ = std::move(heaters);
  fans_ = std::move(fans);
}

std::deque<HeatHistory::Sample> HeatHistory::samples_of(const joblink::HeatSamples& told) const {
  const auto heaters = static_cast<int>(heaters_.size()), fans = static_cast<int>(fans_.size());
  std::deque<Sample> samples;
  const int times = told.time_s_size(), values = times * heaters;
  if (told.actual_decicelsius_size() != values || told.target_decicelsius_size() != values ||
      told.power_permille_size() != values || told.fan_permille_size() != times * fans)
    return samples;
  for (int i = 0; i < times; ++i) {
    Sample sample{.time_s = told.time_s(i), .heaters = {}, .fans = {}};
    for (int h = i * heaters; h < (i + 1) * heaters; ++h) {
      const int power = told.power_permille(h);
      sample.heaters.push_back({static_cast<float>(told.actual_decicelsius(h)) / 10,
                                static_cast<float>(told.target_decicelsius(h)) / 10,
                                power < 0 ? -1.0F : static_cast<float>(power) / 1000});
    }
    for (int f = i * fans; f < (i + 1) * fans; ++f)
      sample.fans.push_back(static_cast<float>(told.fan_permille(f)) / 1000);
    samples.push_back(std::move(sample));
  }
  return samples;
}

void HeatHistory::take(const joblink::HeatCourse& course) {
  std::vector<std::string> heaters(course.heaters().begin(), course.heaters().end());
  std::vector<std::string> fans(course.fans().begin(), course.fans().end());
  if (heaters != heaters_ || fans != fans_) begin_anew(std::move(heaters), std::move(fans));
  const auto join = [](std::deque<Sample> before, const std::deque<Sample>& own) {
    for (const Sample& sample : own)
      if (before.empty() || sample.time_s > before.back().time_s) before.push_back(sample);
    return before;
  };
  recent_ = join(samples_of(course.recent()), recent_);
  // What it has of a job that this client has seen ended is no part of the next one.
  const bool same = course.job_name() == job_name_ || job_name_.empty();
  std::deque<Sample> job = samples_of(course.job());
  job_ = same ? join(std::move(job), job_) : std::move(job);
  job_period_s_ = std::max(kPeriod_s, course.job().period_s());
  job_name_ = course.job_name();
  elapsed_s_ = course.job_elapsed_s();
  while (job_.size() > kMostOfJob) thin_job();
  emit changed();
}

void HeatHistory::take(const joblink::Status& status) {
  auto heaters = names_of(status.heaters()), fans = names_of(status.fans());
  const bool other = heaters != heaters_ || fans != fans_ ||
                     (!recent_.empty() && status.time_s() < recent_.back().time_s);  // another gateway
  if (other) begin_anew(std::move(heaters), std::move(fans));
  // Until they have come up, what they measure is not known.
  const bool up = status.state() != joblink::STATE_OFF && status.state() != joblink::STATE_BRING_UP;
  if (recent_.empty() && !up) return;
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
  if (job_.size() > kMostOfJob) thin_job();
}

void HeatHistory::thin_job() {
  std::deque<Sample> half;
  for (std::size_t i = 0; i < job_.size(); i += 2) half.push_back(std::move(job_[i]));
  job_ = std::move(half);
  job_period_s_ *= 2;
}

}  // namespace kinebus::gui
