#pragma once
// A printer that parks and stands by, with a job under way.

#include <cmath>
#include <string>

#include "gateway/machine/tests/hand_rig.hpp"

namespace kinebus {

class HeldRig : public HandRig {
 protected:
  static MachineDescription that_parks() {
    MachineDescription machine = with_devices(default_m1());
    machine.pause.lift_mm = 12;
    machine.pause.park = true;
    machine.pause.park_x_mm = -40;
    machine.pause.park_y_mm = 30;
    machine.pause.standby_c = 120;
    machine.pause.standby_after = std::chrono::seconds{20};
    machine.pause.unload_mm = 7;
    machine.pause.load_mm = 5;
    machine.thermal.idle_off = std::chrono::seconds{120};
    return machine;
  }
  HeldRig() : HandRig(that_parks()) {}
  /// Feeds on its way to X 60 and back; hot at once.
  ::testing::AssertionResult prints_to(double x_mm) {
    return runs_to("M104 S200\nM140 S60\nM3 S5000\nG1 X60 E6 F1200\nG1 X0 E12\n", x_mm);
  }
  ::testing::AssertionResult goes_on_to_the_end(double z_mm) {
    told_until_now.clear();
    told();
    if (!asks(command::Resume{})) return ::testing::AssertionFailure() << "resume is refused";
    if (!rig.run_until([&] { return told_until_now.find("goes on\n") != std::string::npos || note(); },
                       std::chrono::seconds{90}))
      return ::testing::AssertionFailure() << "it does not go on: " << told_until_now;
    if (std::abs(z() - z_mm) > 5e-3) return ::testing::AssertionFailure() << "goes on at Z " << z();
    if (!rig.reach(MachineState::kReady))
      return ::testing::AssertionFailure() << "it does not end: " << told_until_now << told();
    if (std::abs(x()) > 2e-3) return ::testing::AssertionFailure() << "ends at X " << x();
    return ::testing::AssertionSuccess();
  }
  bool note() {
    told_until_now += told();
    return false;
  }
  std::string told_until_now;
};

}  // namespace kinebus
