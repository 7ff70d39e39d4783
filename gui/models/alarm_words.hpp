#pragma once
// Alarms by their code, in the user's language: the headlines of protocol/canopen/alarm_table.hpp. The
// gateway's own words say the details.

#include <QString>

namespace kinebus::gui {

class AlarmWords {
 public:
  static QString title(unsigned code);
  /// Of a gateway that gives none.
  static QString advice(unsigned code);
  /// With a capital letter and a full stop: the gateway says parts of sentences.
  static QString sentence(const QString& words);
};

}  // namespace kinebus::gui
