#pragma once
// Heaters, fan and spindle as the machine uses them: by command, by a job in its order, and again when an
// interrupted job goes on. The one place that knows the device behind them.

#include <optional>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/journal/journal_queue.hpp"
#include "gateway/result.hpp"
#include "gateway/run/thermal.hpp"
#include "gateway/status/refusal.hpp"
#include "gateway/status/status.hpp"

namespace kinebus {

class Heat {
 public:
  explicit Heat(const MachineDescription& machine);

  void on_time(BusTime now) { device_.on_time(now); }

  // By command: refused with what this machine can have.
  Result<void, Refusal> set_temperature(bool bed, double celsius);  ///< 0: off
  Result<void, Refusal> set_fan(double ratio);                      ///< 0..1
  Result<void, Refusal> set_spindle(double rpm);

  // By a job: it was checked before.
  void execute(const canonical::Thermal& thermal);
  void execute(const canonical::Spindle& spindle) { device_.set_spindle(spindle.rpm); }
  void stop_spindle() { device_.set_spindle(0); }
  void heaters_off();

  bool reached(const TemperatureWait& wait) const { return wait.over(device_); }
  bool spindle_on() const { return device_.spindle().target_rpm != 0; }
  bool spindle_at_speed() const { return device_.spindle().at_speed(); }
  /// deg C; none: off.
  std::optional<double> hotend_target() const;
  /// Why no filament may be fed now; none: it may.
  std::optional<Sentence> too_cold() const;
  void report(MachineStatus& status) const;

  // What the job under way wants. It is kept while the job is interrupted, whatever is switched off.
  void begin_job();
  /// As the gateway before has noted it.
  void take_up(const std::optional<journal::Thermal>& noted);
  /// Notes what has changed, unless it is kept.
  void note(journal::Queue& journal);
  void keep();
  bool kept() const { return kept_.has_value(); }
  void forget_kept() { kept_.reset(); }
  /// Of the job that goes on, deg C; none: off, or nothing is kept.
  std::optional<double> kept_hotend() const;
  /// The spindle turns again as the job wants it; false: it wants none.
  bool start_kept_spindle();
  /// What leads back to it: waits for heaters and spindle. The fan has its speed at once.
  std::vector<canonical::Line> lead_back();
  /// The job goes on: what it does not want goes off.
  void finish_return();

 private:
  const MachineDescription& machine_;
  SimulatedThermal device_;
  std::optional<journal::Thermal> kept_;
  journal::Thermal noted_;
};

/// One wait of a job for a temperature: over when it was within the window for the settling time.
class HeatWait {
 public:
  void begin(const canonical::Thermal& thermal, const HeaterDescription& heater);
  void restart() { since_.reset(); }
  bool over(const Heat& heat, BusTime now);

 private:
  TemperatureWait wait_;
  BusTime settle_{0};
  std::optional<BusTime> since_;
};

}  // namespace kinebus
