#include "gui/models/tuning_curves.hpp"

#include <algorithm>

#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

/// Every second point, and from now on half as many.
void thin(TuningCurve& curve) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < curve.points.size(); i += 2) curve.points[kept++] = curve.points[i];
  curve.points.resize(kept);
  curve.period_s *= 2;
}

}  // namespace

bool measures(joblink::TuningStage stage) {
  return stage >= joblink::TUNING_BEGINS && stage <= joblink::TUNING_KEEPS;
}

double progress_of(const TuningCurve& curve) {
  if (curve.points.empty()) return 0;
  const TuningCurve::Point &first = curve.points.front(), &last = curve.points.back();
  // The second half has no number of its own: it is over when the model fits.
  constexpr double kHalf = 0.5, kFollowed = 0.95;
  switch (curve.stage) {
    case joblink::TUNING_HEATS: {
      const double way = (curve.target_celsius - first.celsius) / 2;
      return way > 0 ? kHalf * std::clamp((last.celsius - first.celsius) / way, 0.0, 1.0) : 0;
    }
    case joblink::TUNING_COOLS: {
      const double heated = curve.power_off_s - first.time_s;
      const double share = heated > 0 ? (last.time_s - curve.power_off_s) / heated : 0;
      return kHalf + (kFollowed - kHalf) * std::clamp(share, 0.0, 1.0);
    }
    case joblink::TUNING_FITS:
    case joblink::TUNING_KEEPS:
      return kFollowed;
    case joblink::TUNING_DONE:
      return 1;
    default:
      return 0;
  }
}

TuningCurves::TuningCurves(Session& session, QObject* parent) : QObject(parent) {
  connect(&session, &Session::status_changed, this, [this, &session] { take(session.status()); });
}

const TuningCurve* TuningCurves::of(const std::string& heater) const {
  const auto found = curves_.find(heater);
  return found != curves_.end() ? &found->second : nullptr;
}

void TuningCurves::take(const joblink::Status& status) {
  bool news = false;
  if (status.time_s() < time_s_ && !curves_.empty()) {  // another gateway
    curves_.clear();
    news = true;
  }
  time_s_ = status.time_s();
  for (const joblink::Heater& heater : status.heaters()) {
    const joblink::TuningStage stage = heater.tuning().stage();
    const auto found = curves_.find(heater.name());
    const bool followed = found != curves_.end() && measures(found->second.stage);
    if (!measures(stage) && !followed) continue;
    if (!followed) {
      curves_[heater.name()] = {.points = {},
                                .target_celsius = heater.tuning().celsius(),
                                .power_off_s = -1,
                                .stage = joblink::TUNING_NONE,
                                .began_s = status.time_s()};
    }
    TuningCurve& curve = curves_[heater.name()];
    const double at_s = status.time_s() - curve.began_s;
    const bool next = curve.stage != stage;
    if (next && curve.power_off_s < 0 && stage > joblink::TUNING_HEATS) curve.power_off_s = at_s;
    curve.stage = stage;
    if (!next && !curve.points.empty() && at_s < curve.points.back().time_s + curve.period_s) continue;
    curve.points.push_back({at_s, heater.actual_celsius()});
    if (curve.points.size() > kMostPoints) thin(curve);
    news = true;
  }
  if (news) emit changed();
}

}  // namespace kinebus::gui
