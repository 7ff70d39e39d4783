#include "gateway/sessions/heat_course.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/joblink/shown_text.hpp"

namespace kinebus {
namespace {

/// Tenths of a degree, or thousandths: more than a display shows.
std::int16_t scaled(double value, double scale) {
  constexpr double kMost = 32'000;
  return static_cast<std::int16_t>(std::lround(std::clamp(value * scale, -kMost, kMost)));
}
/// Two looks at the clock a second apart need not be a whole second apart.
constexpr double kTolerance_s = 0.1;

}  // namespace

void HeatCourse::make_room(const MachineStatus& status) {
  for (const NamedHeaterStatus& heater : status.heaters) heaters_.push_back(heater.name);
  for (const OutputStatus& fan : status.fans) fans_.push_back(fan.name);
  const auto reserve = [this](Course& course, std::size_t samples) {
    course.time_s.resize(samples);
    course.values.resize(samples * width());
  };
  reserve(recent_, kRecent);
  reserve(job_, kMostOfJob);
}

void HeatCourse::take(const MachineStatus& status) {
  if (recent_.time_s.empty()) make_room(status);
  if (status.heaters.size() != heaters_.size() || status.fans.size() != fans_.size()) return;
  // Until they have come up, what they measure is not known.
  const bool up = status.state != MachineState::kOff && status.state != MachineState::kBringUp;
  if (recent_.count == 0 && !up) return;
  put(recent_, status);
  take_job(status);
}

/// The oldest makes room.
void HeatCourse::put(Course& course, const MachineStatus& status) {
  const std::size_t places = course.time_s.size();
  if (course.count == places) {
    course.first = (course.first + 1) % places;
    --course.count;
  }
  const std::size_t at = (course.first + course.count++) % places;
  course.time_s[at] = to_seconds(status.now);
  auto value = course.values.begin() + static_cast<std::ptrdiff_t>(at * width());
  for (const NamedHeaterStatus& heater : status.heaters) {
    *value++ = scaled(heater.actual_celsius, 10);
    *value++ = scaled(heater.target_celsius, 10);
    *value++ = heater.power ? scaled(*heater.power, 1000) : std::int16_t{-1};
  }
  for (const OutputStatus& fan : status.fans) *value++ = scaled(fan.ratio, 1000);
}

/// A job is kept when it is over, until the next one begins.
void HeatCourse::take_job(const MachineStatus& status) {
  if (status.job.empty()) {
    job_name_.clear();
    return;
  }
  if (status.job != job_name_ || status.elapsed_s < job_elapsed_s_) {
    job_.first = job_.count = 0;
    job_period_s_ = to_seconds(kPeriod);
    job_name_ = status.job;
  }
  job_elapsed_s_ = status.elapsed_s;
  if (job_.count > 0 && to_seconds(status.now) < job_.time_s[job_.count - 1] + job_period_s_ - kTolerance_s)
    return;
  if (job_.count == kMostOfJob) thin_job();
  put(job_, status);
}

/// It never goes round: its first sample is at the first place.
void HeatCourse::thin_job() {
  const std::size_t half = (job_.count + 1) / 2;
  for (std::size_t i = 1; i < half; ++i) {
    job_.time_s[i] = job_.time_s[2 * i];
    std::copy_n(job_.values.begin() + static_cast<std::ptrdiff_t>(2 * i * width()), width(),
                job_.values.begin() + static_cast<std::ptrdiff_t>(i * width()));
  }
  job_.count = half;
  job_period_s_ *= 2;
}

joblink::HeatSamples HeatCourse::message(const Course& course) const {
  joblink::HeatSamples told;
  for (std::size_t i = 0; i < course.count; ++i) {
    const std::size_t at = (course.first + i) % course.time_s.size();
    told.add_time_s(course.time_s[at]);
    auto value = course.values.begin() + static_cast<std::ptrdiff_t>(at * width());
    for (std::size_t h = 0; h < heaters_.size(); ++h) {
      told.add_actual_decicelsius(*value++);
      told.add_target_decicelsius(*value++);
      told.add_power_permille(*value++);
    }
    for (std::size_t f = 0; f < fans_.size(); ++f)
      told.add_fan_permille(static_cast<std::uint32_t>(std::max<std::int16_t>(0, *value++)));
  }
  return told;
}

joblink::HeatCourse HeatCourse::message() const {
  joblink::HeatCourse told;
  for (const std::string& name : heaters_) told.add_heaters(shown(name));
  for (const std::string& name : fans_) told.add_fans(shown(name));
  *told.mutable_recent() = message(recent_);
  told.mutable_recent()->set_period_s(to_seconds(kPeriod));
  *told.mutable_job() = message(job_);
  told.mutable_job()->set_period_s(job_period_s_);
  told.set_job_name(shown(job_name_));
  told.set_job_elapsed_s(job_elapsed_s_);
  return told;
}

}  // namespace kinebus
