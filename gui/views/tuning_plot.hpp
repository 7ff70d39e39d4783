#pragma once
// The curve of a heater's measurement: time to the right, temperature upwards, the time of full power shaded,
// and the temperature that it shall be good at.

#include <QPaintEvent>
#include <QSize>
#include <QWidget>

#include "gui/models/tuning_curves.hpp"
#include "gui/views/theme.hpp"

namespace kinebus::gui {

class TuningPlot : public QWidget {
  Q_OBJECT
 public:
  explicit TuningPlot(const Theme& theme, QWidget* parent = nullptr);
  /// nullptr: nothing was measured. It belongs to the caller and is read until the next call.
  void show_curve(const TuningCurve* curve);
  QSize sizeHint() const override { return {420, 260}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  const Theme& theme_;
  const TuningCurve* curve_ = nullptr;
  double last_s_ = 0;  ///< of its points, as painted
};

}  // namespace kinebus::gui
