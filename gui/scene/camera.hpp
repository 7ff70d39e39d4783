#pragma once
// A camera that goes round a point.

#include <QMatrix4x4>
#include <QPointF>
#include <QSize>
#include <QVector3D>

#include "gui/scene/tool_path.hpp"

namespace kinebus::gui {

struct Camera {
  QVector3D target_mm{0, 0, 400};
  float azimuth_deg = -58;   ///< 0: seen along +y
  float elevation_deg = 20;  ///< above the horizon
  float distance_mm = 2100;
  float field_of_view_deg = 32;  ///< of the picture's height

  QMatrix4x4 view() const;
  QMatrix4x4 projection(QSize pixels) const;
  QVector3D eye_mm() const;
  /// Size of a pixel at the distance of the target.
  float mm_per_pixel(QSize pixels) const;

  void orbit(float right_deg, float up_deg);
  void pan(QPointF pixels_moved, QSize pixels);
  void zoom(float factor);
  /// Looks at the whole box from where it stands now.
  void fit(const Box& box_mm, QSize pixels);
  friend bool operator==(const Camera&, const Camera&) = default;
};

}  // namespace kinebus::gui
