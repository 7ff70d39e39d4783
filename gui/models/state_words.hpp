#pragma once
// The machine's state in plain words, what to do next, and which commands make sense now.

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

/// What the gateway would accept in this state, so that only such buttons are lit.
struct Allowed {
  bool bring_up = false, home = false, reference = false, jog = false, start = false, hold = false,
       resume = false;
  bool cancel = false, clear = false, motors_off = false, heat = false;
};
Allowed allowed_in(joblink::State state, bool interrupted = false);  ///< interrupted: a job waits to go on

}  // namespace kinebus::gui
