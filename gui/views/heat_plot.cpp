#include "gui/views/heat_plot.hpp"

#include <QFont>
#include <QFontMetricsF>
#include <QPainterPath>
#include <QPointF>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "gui/models/format.hpp"

namespace kinebus::gui {
namespace {

constexpr double kEdge = 14;
constexpr double kLeastTop = 100;  // C
constexpr double kStrip = 0.22;    // of the height: power and fans
constexpr int kLeading = Qt::AlignAbsolute | Qt::AlignLeft | Qt::AlignVCenter;
constexpr int kTrailing = Qt::AlignAbsolute | Qt::AlignRight | Qt::AlignVCenter;

QString words_of(double celsius) {
  return Format::isolated(Format::temperature(celsius));
}

}  // namespace

HeatPlot::HeatPlot(const HeatHistory& history, const Theme& theme, QWidget* parent)
    : SpeakingWidget(parent), history_(history), theme_(theme) {
  setMinimumHeight(220);
  span_ = new QComboBox(this);
  turn_with_focus_only(*span_);
  span_->addItems({{}, {}});
  connect(span_, &QComboBox::currentIndexChanged, this, [this] { update(); });
  connect(&history, &HeatHistory::changed, this, [this] { update(); });
  connect(&theme, &Theme::changed, this, [this] { update(); });
  says([this] {
    setAccessibleName(tr("Temperatures"));
    span_->setAccessibleName(tr("Time that is shown"));
    span_->setItemText(0, tr("10 minutes"));
    span_->setItemText(1, tr("Whole job"));
    span_->adjustSize();
    update();
  });
}

HeatHistory::Span HeatPlot::span() const {
  return span_->currentIndex() == 1 ? HeatHistory::Span::kJob : HeatHistory::Span::kRecent;
}

QColor HeatPlot::colour(std::size_t n) const {
  const ThemeColours& c = theme_.colours();
  const QColor all[] = {c.danger, c.accent, c.good, c.waiting, c.busy};
  return all[n % std::size(all)];
}

double HeatPlot::length_s() const {
  const auto& samples = history_.samples(span());
  if (span() == HeatHistory::Span::kRecent) return HeatHistory::kRecent_s;
  return samples.empty() ? 1 : std::max(60.0, samples.back().time_s - samples.front().time_s);
}

double HeatPlot::from_s() const {
  const auto& samples = history_.samples(span());
  if (samples.empty()) return 0;
  return span() == HeatHistory::Span::kRecent ? samples.back().time_s - length_s() : samples.front().time_s;
}

void HeatPlot::draw_curve(QPainter& painter, const QRectF& area, const Value& share, const QPen& pen) const {
  QPainterPath path;
  bool drawn = false;
  for (const HeatHistory::Sample& sample : history_.samples(span())) {
    const double value = share(sample);
    if (value < 0) {
      drawn = false;
      continue;
    }
    const QPointF at(area.left() + (sample.time_s - from_s()) / length_s() * area.width(),
                     area.bottom() - std::min(value, 1.0) * area.height());
    std::exchange(drawn, true) ? path.lineTo(at) : path.moveTo(at);
  }
  painter.strokePath(path, pen);
}

/// What stands where, with its values now. Returns where it ends below.
double HeatPlot::draw_legend(QPainter& painter, double top) const {
  const auto& samples = history_.samples(span());
  const QFontMetricsF metrics(painter.font());
  const double line = metrics.height() + 2;
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  constexpr double kSwatch = 10, kName = kSwatch + 4;
  double at = kEdge;  // from the side where the language begins
  const auto put = [&](const QColor& of, const QString& text) {
    const double wide = metrics.horizontalAdvance(text) + 24;
    if (at + wide > width() - kEdge && at > kEdge) {
      at = kEdge;
      top += line;
    }
    const double swatch = mirrored ? width() - at - kSwatch : at;
    painter.setPen(QPen(of, 3));
    painter.drawLine(QPointF(swatch, top + line / 2), QPointF(swatch + kSwatch, top + line / 2));
    painter.setPen(theme_.colours().text);
    painter.drawText(QRectF(mirrored ? width() - at - kName - wide : at + kName, top, wide, line),
                     mirrored ? kTrailing : kLeading, text);
    at += wide + 8;
  };
  for (std::size_t i = 0; i < history_.heaters().size(); ++i) {
    QString text = QString::fromStdString(history_.heaters()[i]);
    if (!samples.empty()) {
      const HeatHistory::Heat& now = samples.back().heaters[i];
      text += QStringLiteral("  ") + words_of(now.celsius);
      if (now.target > 0) text += QStringLiteral(" / ") + words_of(now.target);
      if (now.power >= 0) text += QStringLiteral("  ") + Format::isolated(Format::percent(now.power));
    }
    put(colour(i), text);
  }
  for (std::size_t i = 0; i < history_.fans().size(); ++i) {
    QString text = QString::fromStdString(history_.fans()[i]);
    if (!samples.empty())
      text += QStringLiteral("  ") + Format::isolated(Format::percent(samples.back().fans[i]));
    put(theme_.colours().muted, text);
  }
  return top + line;
}

void HeatPlot::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const ThemeColours& colours = theme_.colours();
  painter.setPen(QPen(colours.border, 1));
  painter.setBrush(colours.card);
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 10, 10);
  painter.setBrush(Qt::NoBrush);
  const bool mirrored = layoutDirection() == Qt::RightToLeft;
  span_->move(mirrored ? static_cast<int>(kEdge) : width() - span_->width() - static_cast<int>(kEdge), 8);
  const QRectF head(kEdge, 8, width() - 2 * kEdge, span_->height());
  painter.setPen(colours.muted);
  painter.drawText(head, (mirrored ? kTrailing : kLeading), tr("Temperatures, power and fans"));
  QFont small = font();
  small.setPointSizeF(small.pointSizeF() * 0.85);
  painter.setFont(small);
  const double below = draw_legend(painter, head.bottom() + 4) + 6;
  const auto& samples = history_.samples(span());
  double top = kLeastTop;
  for (const HeatHistory::Sample& sample : samples)
    for (const HeatHistory::Heat& heat : sample.heaters)
      top = std::max({top, static_cast<double>(heat.celsius), static_cast<double>(heat.target)});
  constexpr double kStep = 50;
  top = std::ceil(top * 1.02 / kStep) * kStep;
  const QFontMetricsF metrics(small);
  const double line = metrics.height(), scale = metrics.horizontalAdvance(words_of(top));
  // Time goes to the right and the scale stands on the left in every language, as on every instrument.
  const QRectF all(kEdge + scale + 8, below + line / 2, width() - 2 * kEdge - scale - 8,
                   height() - below - 2 * line - 6);
  const QRectF warm(all.left(), all.top(), all.width(), all.height() * (1 - kStrip) - 8);
  const QRectF strip(all.left(), warm.bottom() + 8, all.width(), all.bottom() - warm.bottom() - 8);
  for (int i = 0; i <= 2; ++i) {
    const double y = warm.bottom() - warm.height() * i / 2;
    painter.setPen(QPen(colours.border, 1));
    painter.drawLine(QPointF(warm.left(), y), QPointF(warm.right(), y));
    painter.setPen(colours.muted);
    painter.drawText(QRectF(kEdge, y - line / 2, scale, line), kTrailing, words_of(top * i / 2));
  }
  painter.setPen(QPen(colours.border, 1));
  painter.drawRect(strip);
  painter.setPen(colours.muted);
  painter.drawText(QRectF(kEdge, strip.top(), scale, line), kTrailing, Format::isolated(Format::percent(1)));
  const QRectF times(all.left(), all.bottom() + 3, all.width(), line);
  const bool job = span() == HeatHistory::Span::kJob;
  painter.drawText(times, kLeading, job ? tr("begin") : tr("10 minutes ago"));
  painter.drawText(times, kTrailing, job ? Format::isolated(Format::duration(length_s())) : tr("now"));
  painter.setClipRect(all.adjusted(-1, -1, 1, 1));
  for (std::size_t i = 0; i < history_.fans().size(); ++i)
    draw_curve(
        painter, strip, [i](const auto& s) { return s.fans[i]; }, QPen(colours.muted, 1, Qt::DashLine));
  for (std::size_t i = 0; i < history_.heaters().size(); ++i) {
    draw_curve(
        painter, warm,
        [i, top](const auto& s) { return s.heaters[i].target > 0 ? s.heaters[i].target / top : -1; },
        QPen(colour(i), 1, Qt::DashLine));
    draw_curve(
        painter, strip, [i](const auto& s) { return s.heaters[i].power; }, QPen(colour(i), 1.2));
    draw_curve(
        painter, warm, [i, top](const auto& s) { return std::max(0.0, s.heaters[i].celsius / top); },
        QPen(colour(i), 1.8));
  }
}

}  // namespace kinebus::gui
