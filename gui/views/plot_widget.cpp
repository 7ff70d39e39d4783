#include "gui/views/plot_widget.hpp"

#include <QPainter>
#include <QPainterPath>
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
  setMinimumHeight(104);
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
  painter.drawText(head, static_cast<int>(mirrored ? Qt::AlignRight : Qt::AlignLeft), title_);
  const QRectF area(14, head.bottom() + 8, width() - 28, height() - head.bottom() - 20);
  painter.setPen(QPen(colours.border, 1));
  for (int i = 0; i <= 2; ++i) {
    const double y = area.top() + area.height() * i / 2;
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
  }
  if (samples.empty()) return;
  const auto s = static_cast<std::size_t>(series_);
  double top = full_scale_;
  for (const auto& sample : samples) top = std::max(top, static_cast<double>(sample.values[s]) * 1.1);
  painter.setPen(colours.text);
  painter.setFont(bold);
  painter.drawText(head, static_cast<int>(mirrored ? Qt::AlignLeft : Qt::AlignRight),
                   words_(static_cast<double>(samples.back().values[s])));
  // Time goes to the right in every language, as on every instrument.
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
