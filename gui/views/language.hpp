#pragma once
// The language of the program, switched while it runs.

#include <QObject>
#include <QTranslator>
#include <QVector>

namespace kinebus::gui {

class Language : public QObject {
  Q_OBJECT
 public:
  struct Choice {
    QString code, own_name;
  };
  using QObject::QObject;
  static const QVector<Choice>& choices();
  /// Code of the system's language if there is a translation, else "en".
  static QString system_code();
  void apply(const QString& code);
  const QString& code() const { return code_; }

 signals:
  void changed();

 private:
  QTranslator program_, qt_;
  QString code_ = QStringLiteral("en");
};

}  // namespace kinebus::gui
