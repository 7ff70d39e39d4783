#include "gui/views/plot_widget.hpp"

#include <QColor>
#include <QFont>
#include <QFontMetricsF>
#include <QLocale>
#include <QPaintEvent>
#include <QPainter>
#include <QPainterPath>
#include <QPen>
#include <QPointF>
#include <QRectF>
#include <algorithm>

namespace kinebus::gui {

PlotWidget::PlotWidget(const StatusHistory& history, const Theme& theme, StatusHistory::Series series,
                       double full_scale, Words words, QWidget* parent)
    : QWidget(parent),
      history_(history),
      theme_(theme),
      series_(series),
      full_scale_(full_scale),
      words_(std::move(words)) {
  setMinimumHeight(86);
  connect(&history, &StatusHistory::changed, this, [this] { update(); });
}

void PlotWidget::set_title(const QString& title) {
  title_ = title;
  setAccessibleName(title);
  update();
}

void PlotWidget::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const ThemeColours& colours = theme_.colours();
  painter.setPen(QPen(colours.border, 1));
  painter.setBrush(colours.card);
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 10, 10);
  const auto& samples = history_.samples();
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  const QRectF head(14, 8, width() - 28, fontMetrics().height() + 2);
  QFont bold = font();
  bold.setWeight(QFont::DemiBold);
  painter.setPen(colours.muted);
  // The painter would turn left and right round once more.
  constexpr int kLeft = Qt::AlignAbsolute | Qt::AlignLeft, kRight = Qt::AlignAbsolute | Qt::AlignRight;
  painter.drawText(head, mirrored ? kRight : kLeft, title_);
  const auto s = static_cast<std::size_t>(series_);
  double top = full_scale_;
  for (const auto& sample : samples)
    if (const double value = sample.values[s]; value > full_scale_) top = std::max(top, value * 1.1);
  // The scale stands on the left in every language: time goes to the right, as on every instrument.
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.8);
  const QFontMetricsF metrics(small);
  double scale_width = 0;
  for (const double share : {0.0, 0.5, 1.0})
    scale_width = std::max(scale_width, metrics.horizontalAdvance(words_(top * share)));
  const double line = metrics.height();
  const QRectF area(14 + scale_width + 8, head.bottom() + 8, width() - 28 - scale_width - 8,
                    height() - head.bottom() - 16 - line);
  painter.setFont(small);
  for (int i = 0; i <= 2; ++i)
    painter.drawText(QRectF(14, area.top() + area.height() * i / 2 - line / 2, scale_width, line), kRight,
                     words_(top * (2 - i) / 2));
  const QRectF times(area.left(), area.bottom() + 3, area.width(), line);
  painter.drawText(times, kLeft, tr("%1 s ago").arg(QLocale().toString(StatusHistory::kKept_s, 'f', 0)));
  painter.drawText(times, kRight, tr("now"));
  painter.setPen(QPen(colours.border, 1));
  for (int i = 0; i <= 2; ++i) {
    const double y = area.top() + area.height() * i / 2;
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
  }
  if (samples.empty()) return;
  painter.setPen(colours.text);
  painter.setFont(bold);
  painter.drawText(head, mirrored ? kLeft : kRight, words_(static_cast<double>(samples.back().values[s])));
  const double now = samples.back().time_s;
  QPainterPath curve;
  for (const auto& sample : samples) {
    const QPointF at(
        area.right() - (now - sample.time_s) / StatusHistory::kKept_s * area.width(),
        area.bottom() - std::clamp(static_cast<double>(sample.values[s]) / top, 0.0, 1.0) * area.height());
    curve.elementCount() == 0 ? curve.moveTo(at) : curve.lineTo(at);
  }
  QPainterPath filled = curve;
  filled.lineTo(area.right(), area.bottom());
  filled.lineTo(curve.elementAt(0).x, area.bottom());
  QColor fill = colours.accent;
  fill.setAlpha(38);
  painter.fillPath(filled, fill);
  painter.strokePath(curve, QPen(colours.accent, 1.8));
}

}  // namespace kinebus::gui
