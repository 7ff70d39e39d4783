#include "gui/models/alarm_words.hpp"

#include <QCoreApplication>
#include <QLocale>

#include "protocol/canopen/alarm_table.hpp"

namespace kinebus::gui {
namespace {

const AlarmRow& row_of(unsigned code) {
  return code <= 0xFFFF ? alarm_row(static_cast<std::uint16_t>(code)) : kUnknownAlarm;
}

}  // namespace

QString AlarmWords::title(unsigned code) {
  return QCoreApplication::translate("Gateway", row_of(code).name);
}

QString AlarmWords::advice(unsigned code) {
  return QCoreApplication::translate("Gateway", row_of(code).advice);
}

QString AlarmWords::sentence(const QString& words) {
  if (words.isEmpty()) return words;
  return QLocale().toUpper(words.left(1)) + words.mid(1) +
         (words.endsWith(u'.') ? QString() : QStringLiteral("."));
}

}  // namespace kinebus::gui
