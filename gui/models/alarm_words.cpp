#include "gui/models/alarm_words.hpp"

namespace kinebus::gui {

// Codes FF80h and above are the gateway's; below are the EMCY codes of CiA 301 and 402, by their first byte.
QString AlarmWords::title(unsigned code) {
  switch (code) {
    case 0xFF80:
      return tr("A node does not answer");
    case 0xFF81:
      return tr("The wrong node is connected");
    case 0xFF82:
      return tr("A node refuses its settings");
    case 0xFF83:
      return tr("A drive does not switch on");
    case 0xFF84:
      return tr("There is a second gateway on the bus");
    case 0xFF85:
      return tr("A node has gone silent");
    case 0xFF86:
      return tr("A node has restarted");
    case 0xFF87:
      return tr("The clocks have drifted apart");
    case 0xFF88:
      return tr("Homing has failed");
    case 0xFF89:
      return tr("The carriages are too far apart");
    case 0xFF8A:
      return tr("Homing took too long");
    case 0xFF8B:
      return tr("Motion was interrupted");
    case 0xFF8C:
      return tr("The nodes disagree about the path");
    case 0xFF8D:
      return tr("The bus has failed");
    case 0xFF8E:
      return tr("A heater is not as it should be");
    case 0xFF8F:
      return tr("The job went wrong");
    case 0xFF90:
      return tr("Stopped by the operator");
    case 0xFF91:
      return tr("The machine did not come to rest");
    case 0xFF92:
      return tr("Two nodes use the same id");
    default:
      break;
  }
  switch (code >> 8) {
    case 0x23:
      return tr("Too much current in a motor");
    case 0x31:
    case 0x32:
      return tr("The supply voltage is wrong");
    case 0x42:
      return tr("A drive is too hot");
    case 0x81:
      return tr("Communication trouble on the bus");
    case 0x86:
      return tr("A carriage is not where it should be");
    default:
      return code == 0 ? tr("Message") : tr("A node reports a fault");
  }
}

QString AlarmWords::advice(unsigned code) {
  switch (code) {
    case 0xFF80:
      return tr("Check the node's power and the bus cable, then home again.");
    case 0xFF81:
      return tr("Connect the right node or update its firmware.");
    case 0xFF82:
      return tr("Check the machine file against the node's limits.");
    case 0xFF83:
      return tr("Look at the drive's fault, clear the alarm, then home again.");
    case 0xFF84:
      return tr("Switch one of the gateways off.");
    case 0xFF85:
      return tr("Check the node's power and the bus cable, then clear and home again.");
    case 0xFF86:
      return tr("Check the node's power, then clear and home again.");
    case 0xFF87:
      return tr("Check the bus for errors, then clear.");
    case 0xFF88:
      return tr("Check the switch and its wiring, then clear and home again.");
    case 0xFF89:
      return tr("Check the switches of the carriages that went on, then clear and home again.");
    case 0xFF8A:
      return tr("Check the switches and the homing speeds, then clear and home again.");
    case 0xFF8B:
      return tr("Clear: positions are known, the job can be run again.");
    case 0xFF8C:
      return tr("Clear. If it comes again, check the bus for lost frames.");
    case 0xFF8D:
      return tr("Check cable and termination of the bus, then clear and home again.");
    case 0xFF8E:
      return tr("Check the heater and its sensor, then clear.");
    case 0xFF8F:
      return tr("Correct the job, then clear.");
    case 0xFF90:
      return tr("Clear when the machine is safe.");
    case 0xFF91:
      return tr("Switch the machine off and on, then home again.");
    case 0xFF92:
      return tr("Give one of them another id or take it off the bus, then home again.");
    default:
      return {};
  }
}

}  // namespace kinebus::gui
