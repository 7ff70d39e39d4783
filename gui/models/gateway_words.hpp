#pragma once
// What the gateway says of jobs and of what has happened, in the user's language.

#include <QCoreApplication>
#include <QString>

namespace kinebus::gui {

class GatewayWords {
  Q_DECLARE_TR_FUNCTIONS(GatewayWords)
 public:
  /// The gateway's words where they are of the kinds that jobs really have; others stay as they are.
  static QString translated(const QString& words);
};

}  // namespace kinebus::gui
