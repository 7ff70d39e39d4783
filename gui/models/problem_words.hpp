#pragma once
// What the gateway finds wrong with a job, in the user's language.

#include <QCoreApplication>
#include <QString>

namespace kinebus::gui {

class ProblemWords {
  Q_DECLARE_TR_FUNCTIONS(ProblemWords)
 public:
  /// The gateway's words where they are of the kinds that jobs really have; others stay as they are.
  static QString translated(const QString& words);
};

}  // namespace kinebus::gui
