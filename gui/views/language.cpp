#include "gui/views/language.hpp"

#include <QApplication>
#include <QLibraryInfo>
#include <QLocale>

namespace kinebus::gui {

const QVector<Language::Choice>& Language::choices() {
  static const QVector<Choice> all{{QStringLiteral("en"), QStringLiteral("English")},
                                   {QStringLiteral("tr"), QStringLiteral("Türkçe")},
                                   {QStringLiteral("fa"), QStringLiteral("فارسی")}};
  return all;
}

QString Language::system_code() {
  QString code = QLocale::system().name().left(2);
  for (const Choice& choice : choices())
    if (choice.code == code) return code;
  return QStringLiteral("en");
}

void Language::apply(const QString& code) {
  code_ = code;
  QLocale locale(code);
  locale.setNumberOptions(QLocale::OmitGroupSeparator);
  QLocale::setDefault(locale);
  QApplication::removeTranslator(&program_);
  QApplication::removeTranslator(&qt_);
  // English has a file too: it holds the plurals.
  if (program_.load(QStringLiteral(":/i18n/kinebus_%1.qm").arg(code)))
    QApplication::installTranslator(&program_);
  if (qt_.load(QStringLiteral("qtbase_%1").arg(code), QLibraryInfo::path(QLibraryInfo::TranslationsPath)))
    QApplication::installTranslator(&qt_);
  QApplication::setLayoutDirection(locale.textDirection());
  emit changed();
}

}  // namespace kinebus::gui
