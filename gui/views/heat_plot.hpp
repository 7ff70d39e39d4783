#pragma once
// Temperatures of all heaters over time with their targets, dashed, and below them their power and the fans.
// The last ten minutes, or the whole job.

#include <QColor>
#include <QComboBox>
#include <QPaintEvent>
#include <QPainter>
#include <QPen>
#include <QRectF>
#include <QSize>
#include <cstddef>
#include <functional>
#include <vector>

#include "gui/models/heat_history.hpp"
#include "gui/views/theme.hpp"
#include "gui/views/widgets.hpp"

namespace kinebus::gui {

class HeatPlot : public SpeakingWidget {
  Q_OBJECT
 public:
  HeatPlot(const HeatHistory& history, const Theme& theme, QWidget* parent = nullptr);
  void show_span(HeatHistory::Span span) { span_->setCurrentIndex(span == HeatHistory::Span::kJob ? 1 : 0); }
  QSize sizeHint() const override { return {540, 260}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  /// A value of a sample; < 0: none.
  using Value = std::function<double(const HeatHistory::Sample&)>;
  HeatHistory::Span span() const;
  QColor colour(std::size_t n) const;
  double draw_legend(QPainter& painter, double top) const;
  void draw_curve(QPainter& painter, const QRectF& area, const Value& share, const QPen& pen) const;
  double from_s() const;
  double length_s() const;

  const HeatHistory& history_;
  const Theme& theme_;
  QComboBox* span_ = nullptr;
};

}  // namespace kinebus::gui
