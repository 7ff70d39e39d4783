#pragma once
// Heaters, fans, outputs and spindle as the machine uses them: by command, by a job in its order, and again
// when an interrupted job goes on. The one place that tells devices what to do.

#include <functional>
#include <optional>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/devices.hpp"
#include "gateway/devices/temperature_wait.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/result.hpp"
#include "gateway/status/refusal.hpp"
#include "gateway/status/status.hpp"

namespace kinebus {

constexpr ContactProbe::PinOrder pin_order(const canonical::ProbePin& asked) {
  using What = canonical::ProbePin::What;
  using Order = ContactProbe::PinOrder;
  return asked.what == What::kOut        ? Order::kOut
         : asked.what == What::kIn       ? Order::kIn
         : asked.what == What::kSelfTest ? Order::kTest
                                         : Order::kReset;
}

class Heat {
 public:
  Heat(const MachineDescription& machine, Devices& devices) : machine_(machine), devices_(devices) {}

  // By command: refused with what this machine can have.
  Result<void, Refusal> set_temperature(HeaterId heater, double celsius);  ///< 0: off
  /// Its node measures it, to be good at `celsius`; 0: where its kind usually works.
  Result<void, Refusal> tune(HeaterId heater, double celsius);
  /// The heater that is measured now.
  const HeaterDescription* tuned() const;
  HeaterTuning tuning(HeaterId heater) const { return devices_.tuning(heater); }
  Result<void, Refusal> set_fan(std::uint8_t index, double ratio);     ///< 0..1
  Result<void, Refusal> set_output(std::uint8_t index, double ratio);  ///< 0..1
  Result<void, Refusal> set_spindle(double rpm);

  // By a job: it was checked before.
  void execute(const canonical::Thermal& thermal);
  void execute(const canonical::Spindle& spindle) { devices_.turn_spindle(spindle.rpm); }
  void stop_spindle() { devices_.turn_spindle(0); }
  enum class Beds : std::uint8_t { kOff, kStay };
  void heaters_off(Beds beds = Beds::kOff);
  /// The hot end that melts what is fed: T0, until a job, a line or a hand chooses another.
  HeaterId tool() const { return {HeaterKind::kHotend, tool_}; }
  void select(int hotend);
  /// The filament that will be fed, mm/s: means over steps of kFlowAheadStep, the first from now.
  void feed_ahead(const FlowAhead& mm_per_s);
  /// Where the extruder is now, mm.
  void follow_extruder(double mm) { devices_.follow_extruder(mm); }
  /// A heater has a target, or is measured.
  bool heats() const;

  bool reached(const TemperatureWait& wait) const { return wait.over(devices_); }
  bool spindle_on() const { return devices_.spindle().target_rpm != 0; }
  SpindleStatus spindle() const { return devices_.spindle(); }
  std::optional<SpindleAngle> spindle_angle() const { return devices_.spindle().angle; }
  bool spindle_at_speed() const { return devices_.spindle().at_speed(); }
  /// Those that are not off.
  HotendTargets hotend_targets() const;
  /// Of the hot end that is to be hottest, deg C; 0: all are off.
  double hottest_target() const;
  /// What a job finds them set to: 0 where one is off. None: nobody knows, a simulated one stands for heat
  /// that others look after.
  HotendTargets hotends_found() const;
  /// Hot ends that are hotter are to be at `celsius`.
  void stand_by(double celsius);
  /// Why no filament may be fed now; none: it may.
  std::optional<Sentence> too_cold() const;
  /// What is fed melts, and will while the path stops. Without hot end nothing has to.
  bool melts() const;
  /// What to say of a hot end that does not.
  DeviceFault feeds_cold() const;
  /// The job that is kept feeds filament with its hot end as cold as this; none: it melts.
  struct Cold {
    HeaterId hotend;
    double celsius = 0;
  };
  std::optional<Cold> kept_too_cold() const;
  /// What the hot end's node does not let anybody believe: that others look after its heat.
  bool melts_by_node() const;
  double target(HeaterId heater) const { return devices_.heater(heater).target_celsius; }
  void report(MachineStatus& status) const;
  /// What is mended may heat again.
  void clear_faults() { devices_.clear_faults(); }
  /// Of a device that is out of order; the new one tells each once.
  std::optional<DeviceFault> fault() const { return devices_.fault(); }
  std::optional<DeviceFault> new_fault() { return devices_.new_fault(); }
  /// There is nothing to print with, or it does not come.
  std::optional<DeviceFault> filament_trouble() const { return devices_.filament_trouble(); }

  Result<void, Refusal> move_pin(ContactProbe::PinOrder order);

  /// nullptr: the machine has none of this index.
  const Input* input(int index) const {
    return index >= 0 && index < kMostOfAKind ? devices_.input(static_cast<std::uint8_t>(index)) : nullptr;
  }
  /// nullptr: the machine has none.
  ContactProbe* probe() { return devices_.probe(); }

  // What the job under way wants. It is kept while the job is interrupted, whatever is switched off.
  void begin_job();
  /// As the gateway before has noted it.
  void take_up(const std::optional<journal::Heat>& noted);
  /// Notes what has changed, unless it is kept.
  void note(journal::Queue& journal);
  void keep();
  bool kept() const { return kept_.has_value(); }
  void forget_kept() { kept_.reset(); }
  /// The job that goes on wants heat that is off.
  bool kept_heat() const;
  /// The hot ends' of the job that goes on; none: off, or nothing is kept.
  HotendTargets kept_hotends() const;
  /// The hot end that the job under way uses, whatever was chosen since it was interrupted.
  std::uint8_t tool_of_job() const { return kept_ ? kept_->tool() : tool_; }
  /// The spindle turns again as the job wants it; false: it wants none.
  bool start_kept_spindle();
  /// What leads back to it: waits for heaters and spindle. Fans and outputs are as they were at once.
  std::vector<canonical::Line> lead_back();
  /// The job goes on: what it does not want goes off.
  void finish_return();

 private:
  journal::Heat told_now() const;
  HotendTargets hotends(const std::function<std::optional<double>(const HeaterDescription&)>& of) const;

  const MachineDescription& machine_;
  Devices& devices_;
  std::optional<journal::Heat> kept_;
  journal::Heat noted_;
  std::uint8_t tool_ = 0;
};

/// One wait of a job for a temperature: over when it was within the window for the settling time. It goes
/// with a target that is changed by hand meanwhile.
class HeatWait {
 public:
  /// The heater has been told its target.
  void begin(const canonical::Thermal& thermal, const HeaterDescription& heater, const Heat& heat);
  void restart() { since_.reset(); }
  /// Somebody has switched the heater off: it does not get there.
  bool in_vain(const Heat& heat) const { return told_ > 0 && heat.target(wait_.heater) <= 0; }
  HeaterId heater() const { return wait_.heater; }
  bool over(const Heat& heat, BusTime now);

 private:
  TemperatureWait wait_;
  double told_ = 0;
  BusTime settle_{0};
  std::optional<BusTime> since_;
};

}  // namespace kinebus
