#pragma once
// The machine's state in plain words, and what to do next.

#include <QCoreApplication>
#include <QString>

#include "protocol/joblink/kinebus.pb.h"

namespace kinebus::gui {

enum class StateTone { kNeutral, kReady, kBusy, kWaiting, kAlarm };

class StateWords {
  Q_DECLARE_TR_FUNCTIONS(StateWords)
 public:
  static QString title(joblink::State state);
  static QString next(joblink::State state);  ///< what the user can do; may be empty
  static StateTone tone(joblink::State state);
};

}  // namespace kinebus::gui
