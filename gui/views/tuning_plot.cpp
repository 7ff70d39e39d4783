#include "gui/views/tuning_plot.hpp"

#include <QColor>
#include <QFont>
#include <QFontMetricsF>
#include <QPaintEvent>
#include <QPainter>
#include <QPainterPath>
#include <QPen>
#include <QPointF>
#include <QRectF>
#include <algorithm>
#include <cmath>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

/// A round number of which at most `most` make up the span: 1, 2 or 5 times a power of ten.
double step_of(double span, int most) {
  const double least = span / most, power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

}  // namespace

TuningPlot::TuningPlot(const Theme& theme, QWidget* parent) : QWidget(parent), theme_(theme) {
  setMinimumHeight(150);
  connect(&theme, &Theme::changed, this, [this] { update(); });
}

void TuningPlot::show_curve(const TuningCurve* curve) {
  const std::size_t points = curve != nullptr ? curve->points.size() : 0;
  const double last_s = points > 0 ? curve->points.back().time_s : 0;
  const bool same = curve == curve_ && last_s == last_s_;
  curve_ = curve;
  last_s_ = last_s;
  if (!same) update();
}

void TuningPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const ThemeColours& colours = theme_.colours();
  if (curve_ == nullptr || curve_->points.empty()) {
    painter.setPen(colours.muted);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("The curve is drawn here while a heater is measured."));
    return;
  }
  const auto& points = curve_->points;
  double low = points.front().celsius, high = curve_->target_celsius;
  for (const auto& point : points) low = std::min(low, point.celsius), high = std::max(high, point.celsius);
  constexpr int kLines = 5;
  const double step = step_of(std::max(high - low, 10.0), kLines);
  low = std::floor(low / step) * step;
  high = std::ceil(high * 1.02 / step) * step;
  constexpr double kLeast_s = 10;
  const double last_s = std::max(points.back().time_s, kLeast_s);
  // Time goes to the right and the scale stands on the left in every language, as on every instrument.
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.85);
  painter.setFont(small);
  const QFontMetricsF metrics(small);
  const auto words = [](double celsius) { return Format::isolated(Format::temperature(celsius)); };
  const double scale =
      std::max(metrics.horizontalAdvance(words(low)), metrics.horizontalAdvance(words(high)));
  const double line = metrics.height();
  const QRectF area(scale + 8, line / 2 + 1, width() - scale - 12, height() - 2 * line - 4);
  const auto x = [&](double time_s) { return area.left() + time_s / last_s * area.width(); };
  const auto y = [&](double celsius) {
    return area.bottom() - (celsius - low) / (high - low) * area.height();
  };
  const double off_s = curve_->power_off_s < 0 ? points.back().time_s : curve_->power_off_s;
  QColor heat = colours.waiting;
  heat.setAlpha(34);
  painter.fillRect(QRectF(QPointF(x(0), area.top()), QPointF(x(off_s), area.bottom())), heat);
  constexpr int kRight = Qt::AlignAbsolute | Qt::AlignRight | Qt::AlignVCenter;
  for (double celsius = low; celsius < high + step / 2; celsius += step) {
    painter.setPen(QPen(colours.border, 1));
    painter.drawLine(QPointF(area.left(), y(celsius)), QPointF(area.right(), y(celsius)));
    painter.setPen(colours.muted);
    painter.drawText(QRectF(0, y(celsius) - line / 2, scale, line), kRight, words(celsius));
  }
  const double times = step_of(last_s, kLines);
  for (double time_s = 0; time_s < last_s + times / 2; time_s += times) {
    const QString text = Format::isolated(Format::duration(time_s));
    const double half = metrics.horizontalAdvance(text) / 2 + 1;
    const double middle = std::min(x(time_s), width() - half);
    if (x(time_s) > area.right() + 1) break;
    painter.drawText(QRectF(middle - half, area.bottom() + 3, 2 * half, line), Qt::AlignCenter, text);
  }
  painter.setPen(QPen(colours.muted, 1.2, Qt::DashLine));
  painter.drawLine(QPointF(area.left(), y(curve_->target_celsius)),
                   QPointF(area.right(), y(curve_->target_celsius)));
  painter.setPen(colours.muted);
  painter.drawText(QRectF(area.left() + 6, y(curve_->target_celsius) + 2, area.width() - 12, line), kRight,
                   tr("Target"));
  painter.drawText(QRectF(x(0) + 6, area.bottom() - line - 2, std::max(0.0, x(off_s) - x(0) - 8), line),
                   Qt::AlignAbsolute | Qt::AlignLeft | Qt::AlignVCenter,
                   metrics.elidedText(tr("full power"), Qt::ElideRight, std::max(0.0, x(off_s) - x(0) - 8)));
  QPainterPath path(QPointF(x(points.front().time_s), y(points.front().celsius)));
  for (const auto& point : points) path.lineTo(x(point.time_s), y(point.celsius));
  painter.strokePath(path, QPen(colours.accent, 2));
}

}  // namespace kinebus::gui
