#include "gui/scene/camera.hpp"

#include <QPointF>
#include <QVector3D>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {
constexpr float kRadPerDeg = std::numbers::pi_v<float> / 180.0F;
}

QVector3D Camera::eye_mm() const {
  const float a = azimuth_deg * kRadPerDeg, e = elevation_deg * kRadPerDeg;
  return target_mm +
         distance_mm * QVector3D(std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e));
}

QMatrix4x4 Camera::view() const {
  QMatrix4x4 m;
  // Straight from above "up" would be undefined: the picture's top is then where the camera looks to.
  const float a = azimuth_deg * kRadPerDeg;
  const QVector3D up =
      std::abs(elevation_deg) > 89 ? QVector3D(-std::sin(a), std::cos(a), 0) : QVector3D(0, 0, 1);
  m.lookAt(eye_mm(), target_mm, up);
  return m;
}

QMatrix4x4 Camera::projection(QSize pixels) const {
  QMatrix4x4 m;
  const float aspect = static_cast<float>(pixels.width()) / static_cast<float>(std::max(1, pixels.height()));
  m.perspective(field_of_view_deg, aspect, std::max(1.0F, distance_mm * 0.02F), distance_mm + 6000);
  return m;
}

float Camera::mm_per_pixel(QSize pixels) const {
  return 2 * distance_mm * std::tan(field_of_view_deg * kRadPerDeg / 2) /
         static_cast<float>(std::max(1, pixels.height()));
}

void Camera::orbit(float right_deg, float up_deg) {
  azimuth_deg = std::remainder(azimuth_deg + right_deg, 360.0F);
  elevation_deg = std::clamp(elevation_deg + up_deg, -89.5F, 89.5F);
}

void Camera::pan(QPointF pixels_moved, QSize pixels) {
  const QMatrix4x4 v = view();
  const QVector3D right = v.row(0).toVector3D(), up = v.row(1).toVector3D();
  const float scale = mm_per_pixel(pixels);
  target_mm += -scale * static_cast<float>(pixels_moved.x()) * right +
               scale * static_cast<float>(pixels_moved.y()) * up;
}

void Camera::zoom(float factor) {
  distance_mm = std::clamp(distance_mm * factor, 15.0F, 8000.0F);
}

void Camera::fit(const Box& box_mm, QSize pixels) {
  if (box_mm.empty()) return;
  const QVector3D low(box_mm.low_mm[0], box_mm.low_mm[1], box_mm.low_mm[2]);
  const QVector3D high(box_mm.high_mm[0], box_mm.high_mm[1], box_mm.high_mm[2]);
  target_mm = (low + high) / 2;
  // Every corner inside both half angles, as seen from where the camera will be.
  const QMatrix4x4 v = view();
  const float tan_up = std::tan(field_of_view_deg * kRadPerDeg / 2);
  const float tan_right =
      tan_up * static_cast<float>(pixels.width()) / static_cast<float>(std::max(1, pixels.height()));
  float needed = 20;
  for (int corner = 0; corner < 8; ++corner) {
    const QVector3D p((corner & 1) != 0 ? high.x() : low.x(), (corner & 2) != 0 ? high.y() : low.y(),
                      (corner & 4) != 0 ? high.z() : low.z());
    const QVector3D seen = v.mapVector(p - target_mm);
    needed =
        std::max({needed, std::abs(seen.x()) / tan_right + seen.z(), std::abs(seen.y()) / tan_up + seen.z()});
  }
  distance_mm = std::clamp(needed * 1.06F, 15.0F, 8000.0F);
}

}  // namespace kinebus::gui
