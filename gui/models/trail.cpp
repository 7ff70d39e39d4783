#include "gui/models/trail.hpp"

#include <algorithm>

#include "gui/session/session.hpp"

namespace kinebus::gui {
namespace {

/// Nearer to the last one a point tells nothing new.
constexpr float kStep_mm = 0.05F;

QVector3D place(const joblink::Pose& pose) {
  return {static_cast<float>(pose.x_mm()), static_cast<float>(pose.y_mm()), static_cast<float>(pose.z_mm())};
}

}  // namespace

Trail::Trail(Session& session, QObject* parent) : QObject(parent) {
  connect(&session, &Session::link_changed, this, [this, &session] {
    broken_ = true;
    if (session.link_state() != Session::LinkState::kNone) return;
    points_.clear();
    lines_.reset();
  });
  connect(&session, &Session::status_changed, this, [this, &session] {
    const joblink::Status& s = session.status();
    if (!points_.empty() && s.time_s() < points_.back().time_s) {  // another gateway, or begun anew
      points_.clear();
      lines_.reset();
    }
    if (!s.positions_known()) {
      broken_ = true;
      return;
    }
    measured_ = s.has_measured_tool();
    const QVector3D at = place(measured_ ? s.measured_tool() : s.tool());
    if (!broken_ && !points_.empty() && (at - points_.back().place_mm).length() < kStep_mm) return;
    points_.push_back({s.time_s(), at, (at - place(s.tool())).length(), broken_});
    broken_ = false;
    while (points_.front().time_s < s.time_s() - kKept_s) points_.pop_front();
    lines_.reset();
  });
}

std::shared_ptr<const std::vector<QVector3D>> Trail::lines() const {
  if (lines_ == nullptr) {
    auto lines = std::make_shared<std::vector<QVector3D>>();
    for (std::size_t i = 1; i < points_.size(); ++i) {
      if (points_[i].first) continue;
      lines->push_back(points_[i - 1].place_mm);
      lines->push_back(points_[i].place_mm);
    }
    lines_ = std::move(lines);
  }
  return lines_;
}

double Trail::farthest_off_mm() const {
  float most = 0;
  for (const Point& point : points_) most = std::max(most, point.off_mm);
  return static_cast<double>(most);
}

}  // namespace kinebus::gui
