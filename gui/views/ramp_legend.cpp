#include "gui/views/ramp_legend.hpp"

#include <QColor>
#include <QFontMetrics>
#include <QLinearGradient>
#include <QPalette>
#include <QRect>
#include <QRectF>
#include <QSizePolicy>
#include <utility>

namespace kinebus::gui {
namespace {
constexpr int kChip = 10, kChipGap = 5;
/// Of a kind beside its name.
constexpr int kKindRoom = kChip + kChipGap + 14;
}  // namespace

RampLegend::RampLegend(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Fixed);
}

void RampLegend::set(PathColouring colouring, const QString& low, const QString& high) {
  colouring_ = colouring;
  low_ = low;
  high_ = high;
  kinds_.clear();
  updateGeometry();
  update();
}

void RampLegend::set(std::vector<Kind> kinds) {
  kinds_ = std::move(kinds);
  updateGeometry();
  update();
}

QSize RampLegend::sizeHint() const {
  const QFontMetrics metrics = fontMetrics();
  if (!kinds_.empty()) {
    int width = 0;
    for (const Kind& kind : kinds_) width += metrics.horizontalAdvance(kind.name) + kKindRoom;
    return {width, metrics.height() + 4};
  }
  return {metrics.horizontalAdvance(low_) + metrics.horizontalAdvance(high_) + 150, metrics.height() + 4};
}

void RampLegend::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  if (!kinds_.empty()) return paint_kinds(painter);
  const QFontMetrics metrics = fontMetrics();
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  const QString &first = mirrored ? high_ : low_, &last = mirrored ? low_ : high_;
  const int before = metrics.horizontalAdvance(first) + 8, after = metrics.horizontalAdvance(last) + 8;
  const QRectF bar(before, height() / 2.0 - 4, width() - before - after, 8);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  const auto& ramp = colour_ramp(colouring_);
  for (std::size_t i = 0; i < ramp.size(); ++i) {
    const double at = static_cast<double>(i) / static_cast<double>(ramp.size() - 1);
    gradient.setColorAt(mirrored ? 1 - at : at, QColor::fromRgbF(ramp[i][0], ramp[i][1], ramp[i][2]));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 4, 4);
  painter.setPen(palette().color(QPalette::PlaceholderText));
  painter.drawText(QRect(0, 0, before, height()), Qt::AlignLeft | Qt::AlignVCenter | Qt::TextForceLeftToRight,
                   first);
  painter.drawText(QRect(width() - after, 0, after, height()),
                   Qt::AlignRight | Qt::AlignVCenter | Qt::TextForceLeftToRight, last);
}

void RampLegend::paint_kinds(QPainter& painter) {
  const QFontMetrics metrics = fontMetrics();
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  int at = 0;
  for (const Kind& kind : kinds_) {
    const int room = metrics.horizontalAdvance(kind.name) + kKindRoom;
    const int left = mirrored ? width() - at - room : at;
    const QRectF chip(mirrored ? left + room - kChip : left, (height() - kChip) / 2.0, kChip, kChip);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor::fromRgbF(kind.colour[0], kind.colour[1], kind.colour[2]));
    painter.drawRoundedRect(chip, 2, 2);
    painter.setPen(palette().color(QPalette::PlaceholderText));
    const QRect words(mirrored ? left : left + kChip + kChipGap, 0, room - kChip - kChipGap, height());
    painter.drawText(
        words,
        static_cast<int>(Qt::AlignAbsolute | Qt::AlignVCenter | (mirrored ? Qt::AlignRight : Qt::AlignLeft)),
        kind.name);
    at += room;
  }
}

}  // namespace kinebus::gui
