#include "gui/views/theme.hpp"

#include <QApplication>
#include <QByteArray>
#include <QFile>
#include <QIODevice>
#include <QLatin1String>
#include <QPainter>
#include <QPalette>
#include <QPixmap>
#include <QStyle>
#include <QStyleFactory>
#include <QSvgRenderer>
#include <QVector3D>

namespace kinebus::gui {
namespace {

const ThemeColours& light_colours() {
  static const ThemeColours colours{.window = "#f2f4f7",
                                    .card = "#ffffff",
                                    .raised = "#f7f9fb",
                                    .border = "#dde2e8",
                                    .text = "#18212c",
                                    .muted = "#5b6878",
                                    .accent = "#0b7285",
                                    .accent_text = "#ffffff",
                                    .hover = "#e8eef2",
                                    .selection = "#d5ebef",
                                    .danger = "#d3271b",
                                    .danger_text = "#ffffff",
                                    .good = "#127a54",
                                    .waiting = "#a65f00",
                                    .busy = "#1864c4"};
  return colours;
}

const ThemeColours& dark_colours() {
  static const ThemeColours colours{.window = "#11151a",
                                    .card = "#191f26",
                                    .raised = "#1f262e",
                                    .border = "#2b343e",
                                    .text = "#e7ebf0",
                                    .muted = "#95a2b2",
                                    .accent = "#2aa9bf",
                                    .accent_text = "#06181c",
                                    .hover = "#242d36",
                                    .selection = "#173b43",
                                    .danger = "#e5372b",
                                    .danger_text = "#ffffff",
                                    .good = "#3cc28c",
                                    .waiting = "#f0a73a",
                                    .busy = "#62a7f7"};
  return colours;
}

QVector3D linear(const char* colour) {
  const QColor c(colour);
  return {static_cast<float>(c.redF()), static_cast<float>(c.greenF()), static_cast<float>(c.blueF())};
}

}  // namespace

void Theme::apply(bool dark) {
  dark_ = dark;
  colours_ = dark ? dark_colours() : light_colours();
  if (qApp->style()->name() != QLatin1String("fusion"))
    QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
  QPalette p;
  p.setColor(QPalette::Window, colours_.window);
  p.setColor(QPalette::WindowText, colours_.text);
  p.setColor(QPalette::Base, colours_.card);
  p.setColor(QPalette::AlternateBase, colours_.raised);
  p.setColor(QPalette::Text, colours_.text);
  p.setColor(QPalette::Button, colours_.card);
  p.setColor(QPalette::ButtonText, colours_.text);
  p.setColor(QPalette::Highlight, colours_.accent);
  p.setColor(QPalette::HighlightedText, colours_.accent_text);
  p.setColor(QPalette::ToolTipBase, colours_.raised);
  p.setColor(QPalette::ToolTipText, colours_.text);
  p.setColor(QPalette::PlaceholderText, colours_.muted);
  p.setColor(QPalette::Link, colours_.accent);
  p.setColor(QPalette::Mid, colours_.border);
  p.setColor(QPalette::Disabled, QPalette::Text, colours_.muted);
  p.setColor(QPalette::Disabled, QPalette::ButtonText, colours_.muted);
  QApplication::setPalette(p);
  qApp->setStyleSheet(style_sheet());
  emit changed();
}

QColor Theme::tone(StateTone tone) const {
  switch (tone) {
    case StateTone::kReady:
      return colours_.good;
    case StateTone::kBusy:
      return colours_.busy;
    case StateTone::kWaiting:
      return colours_.waiting;
    case StateTone::kAlarm:
      return colours_.danger;
    case StateTone::kNeutral:
      break;
  }
  return colours_.muted;
}

SceneColours Theme::scene() const {
  if (dark_)
    return {.sky_low = linear("#12161b"),
            .sky_high = linear("#27313c"),
            .ground = linear("#1a2027"),
            .grid = linear("#434d58"),
            .reach = linear("#2aa9bf"),
            .text = linear("#e7ebf0"),
            .travel = linear("#5f7f9c"),
            .remaining = linear("#4b5560"),
            .dark = true};
  return {.sky_low = linear("#f7f9fb"),
          .sky_high = linear("#d5dee6"),
          .ground = linear("#e5e9ee"),
          .grid = linear("#5d6671"),
          .reach = linear("#0b7285"),
          .text = linear("#18212c"),
          .travel = linear("#7d94aa"),
          .remaining = linear("#a9b3bd"),
          .dark = false};
}

QIcon Theme::icon(const QString& name, const QColor& colour) const {
  QFile file(QStringLiteral(":/icons/%1.svg").arg(name));
  if (!file.open(QIODevice::ReadOnly)) return {};
  const QByteArray drawing = file.readAll();
  QIcon icon;
  const auto add = [&](const QColor& c, QIcon::Mode mode) {
    QByteArray coloured = drawing;
    coloured.replace("currentColor", c.name().toLatin1());
    QSvgRenderer renderer(coloured);
    for (const int size : {16, 20, 24, 32, 48, 64}) {
      QPixmap pixmap(size, size);
      pixmap.fill(Qt::transparent);
      QPainter painter(&pixmap);
      renderer.render(&painter);
      icon.addPixmap(pixmap, mode);
    }
  };
  add(colour.isValid() ? colour : colours_.text, QIcon::Normal);
  QColor faint = colours_.muted;
  faint = QColor::fromRgbF((faint.redF() + colours_.card.redF()) / 2,
                           (faint.greenF() + colours_.card.greenF()) / 2,
                           (faint.blueF() + colours_.card.blueF()) / 2);
  add(faint, QIcon::Disabled);
  return icon;
}

QString Theme::style_sheet() const {
  QFile file(QStringLiteral(":/style.qss"));
  if (!file.open(QIODevice::ReadOnly)) return {};
  QString sheet = QString::fromUtf8(file.readAll());
  const std::pair<const char*, QColor> tokens[] = {{"@window", colours_.window},
                                                   {"@card", colours_.card},
                                                   {"@raised", colours_.raised},
                                                   {"@border", colours_.border},
                                                   {"@text", colours_.text},
                                                   {"@muted", colours_.muted},
                                                   {"@accent_text", colours_.accent_text},
                                                   {"@accent", colours_.accent},
                                                   {"@hover", colours_.hover},
                                                   {"@selection", colours_.selection},
                                                   {"@danger_text", colours_.danger_text},
                                                   {"@danger", colours_.danger},
                                                   {"@good", colours_.good},
                                                   {"@waiting", colours_.waiting},
                                                   {"@busy", colours_.busy}};
  // Longer names first where one begins with another.
  for (const auto& [token, colour] : tokens) sheet.replace(QLatin1String(token), colour.name());
  return sheet;
}

}  // namespace kinebus::gui
