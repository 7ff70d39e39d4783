#pragma once
// Alarms by their code: a title and what to do next, in the user's language. The gateway's own words say the
// details.

#include <QCoreApplication>
#include <QString>

namespace kinebus::gui {

class AlarmWords {
  Q_DECLARE_TR_FUNCTIONS(AlarmWords)
 public:
  static QString title(unsigned code);
  /// Empty: the gateway's own advice is used.
  static QString advice(unsigned code);
};

}  // namespace kinebus::gui
