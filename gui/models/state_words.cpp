#include "gui/models/state_words.hpp"

namespace kinebus::gui {
using namespace joblink;

QString StateWords::title(State state) {
  switch (state) {
    case STATE_OFF:
      return tr("Motors off");
    case STATE_BRING_UP:
      return tr("Waking the nodes");
    case STATE_UNHOMED:
      return tr("Not homed");
    case STATE_HOMING:
      return tr("Homing");
    case STATE_READY:
      return tr("Ready");
    case STATE_MOVING:
      return tr("Moving");
    case STATE_CHECKING:
      return tr("Checking the job");
    case STATE_RUNNING:
      return tr("Printing");
    case STATE_HOLDING:
      return tr("Pausing");
    case STATE_HELD:
      return tr("Paused");
    case STATE_CANCELLING:
      return tr("Cancelling");
    case STATE_STOPPING:
      return tr("Stopping");
    case STATE_STOPPED:
      return tr("Stopped");
    case STATE_ALARM:
      return tr("Alarm");
    default:
      return tr("Unknown");
  }
}

QString StateWords::next(State state) {
  switch (state) {
    case STATE_OFF:
      return tr("Home the machine to wake the motors and find the carriages.");
    case STATE_UNHOMED:
      return tr("Home the machine: positions are not known yet.");
    case STATE_READY:
      return tr("Choose a job and start it, or jog the tool.");
    case STATE_HELD:
      return tr("All carriages rest on the path. Resume or cancel.");
    case STATE_STOPPED:
      return tr("Make sure that the machine is safe, then clear the stop.");
    case STATE_ALARM:
      return tr("Read the alarm, remove its cause, then clear it.");
    default:
      return {};
  }
}

StateTone StateWords::tone(State state) {
  switch (state) {
    case STATE_READY:
      return StateTone::kReady;
    case STATE_BRING_UP:
    case STATE_HOMING:
    case STATE_MOVING:
    case STATE_CHECKING:
    case STATE_RUNNING:
      return StateTone::kBusy;
    case STATE_UNHOMED:
    case STATE_HOLDING:
    case STATE_HELD:
    case STATE_CANCELLING:
      return StateTone::kWaiting;
    case STATE_STOPPING:
    case STATE_STOPPED:
    case STATE_ALARM:
      return StateTone::kAlarm;
    default:
      return StateTone::kNeutral;
  }
}

}  // namespace kinebus::gui
