#include "gui/models/format.hpp"

#include <QChar>
#include <QDate>
#include <QDateTime>
#include <QLocale>
#include <cmath>

namespace kinebus::gui {

QString Format::number(double value, int decimals) {
  return QLocale().toString(value, 'f', decimals);
}

QString Format::bytes(double bytes) {
  if (bytes < 1000) return tr("%1 B").arg(number(bytes, 0));
  if (bytes < 1e6) return tr("%1 kB").arg(number(bytes / 1e3, bytes < 1e4 ? 1 : 0));
  if (bytes < 1e9) return tr("%1 MB").arg(number(bytes / 1e6, bytes < 1e7 ? 1 : 0));
  return tr("%1 GB").arg(number(bytes / 1e9, 1));
}

QString Format::bytes_per_s(double bytes_per_s) {
  return tr("%1/s").arg(bytes(bytes_per_s));
}

QString Format::duration(double seconds) {
  if (!(seconds >= 0) || seconds > 1e8) return QStringLiteral("–");
  const auto total = static_cast<qint64>(std::llround(seconds));
  const QLocale locale;
  const auto two = [&](qint64 v) { return (v < 10 ? locale.toString(0) : QString()) + locale.toString(v); };
  const qint64 hours = total / 3600, minutes = total / 60 % 60;
  if (hours > 0) return QStringLiteral("%1:%2:%3").arg(locale.toString(hours), two(minutes), two(total % 60));
  return QStringLiteral("%1:%2").arg(locale.toString(minutes), two(total % 60));
}

QString Format::percent(double share, int decimals) {
  const auto figure = number(share * 100, decimals);
  const QLocale locale;
  // Turkish writes %50.
  return locale.language() == QLocale::Turkish ? locale.percent() + figure : figure + locale.percent();
}

QString Format::date_time(double unix_s) {
  const QDateTime when = QDateTime::fromMSecsSinceEpoch(static_cast<qint64>(unix_s * 1000));
  const bool today = when.date() == QDate::currentDate();
  return today ? QLocale().toString(when.time(), QStringLiteral("HH:mm:ss"))
               : QLocale().toString(when, QLocale::ShortFormat);
}

QString Format::temperature(double celsius) {
  return tr("%1 °C").arg(number(celsius, 0));
}

QString Format::isolated(const QString& text) {
  return QChar(0x2066) + text + QChar(0x2069);
}

}  // namespace kinebus::gui
