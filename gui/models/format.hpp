#pragma once
// Numbers as people read them, in the language at work.

#include <QCoreApplication>
#include <QString>

namespace kinebus::gui {

class Format {
  Q_DECLARE_TR_FUNCTIONS(Format)
 public:
  static QString bytes(double bytes);
  static QString bytes_per_s(double bytes_per_s);
  static QString duration(double seconds);  ///< "1:02:03", "4:05"
  static QString percent(double share, int decimals = 0);
  static QString number(double value, int decimals);
  static QString date_time(double unix_s);
  static QString temperature(double celsius);
  /// Keeps "12.5 mm" in its order within a right-to-left sentence.
  static QString isolated(const QString& text);
};

}  // namespace kinebus::gui
