#pragma once
// Devices that are not there: heat is a first-order model with a thermostat, the spindle gains speed evenly,
// so that waits (M109, M3) take time on the virtual machine too.

#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/device.hpp"

namespace kinebus {

/// T' = (ambient + rise * power - T) / time_constant, solved exactly for any step; the thermostat is a
/// proportional band of `band` around the target with the model's own holding power, so the temperature
/// settles on the target.
struct HeatModel {
  double ambient_celsius = 22;
  double rise_celsius = 320;  ///< above ambient at full power, in the end
  double time_constant_s = 90;
  double band_celsius = 4;
};

class SimulatedHeater : public Heater {
 public:
  explicit SimulatedHeater(HeatModel model)
      : model_(model), status_{.actual_celsius = model.ambient_celsius} {}
  void set_target(double celsius) override { status_.target_celsius = celsius; }
  HeaterStatus status() const override { return status_; }
  void on_time(BusTime now) override;

 private:
  HeatModel model_;
  HeaterStatus status_;
  std::optional<BusTime> last_;
};

class SimulatedOutput : public Output {
 public:
  void set(double ratio) override { ratio_ = ratio; }
  double ratio() const override { return ratio_; }

 private:
  double ratio_ = 0;
};

/// A load that comes and goes makes it slow, with a lag; its encoder tells whole counts.
class SimulatedSpindle : public SpindleDrive {
 public:
  explicit SimulatedSpindle(const SpindleDescription& spindle) : spindle_(spindle) {}
  void set(double rpm) override { status_.target_rpm = rpm; }
  SpindleStatus status() const override { return status_; }
  void on_time(BusTime now) override;

 private:
  void turn(double seconds);

  SpindleDescription spindle_;
  SpindleStatus status_;
  double drive_rpm_ = 0;  ///< without load
  double droop_ = 0;      ///< what the load takes, of that
  double turns_ = 0;      ///< since the program began, from where it stood
  double load_s_ = 0;     ///< into the load's period
  std::optional<BusTime> last_;
};

class SimulatedInput : public Input {
 public:
  /// `change_s`: it changes so often; 0: never.
  SimulatedInput(bool on, double change_s) : on_(on), left_s_(change_s), change_s_(change_s) {}
  InputLevel level() const override { return on_ ? InputLevel::kOn : InputLevel::kOff; }
  Changes changes() const override { return changes_; }
  void on_time(BusTime now) override;

 private:
  bool on_;
  double left_s_, change_s_;
  Changes changes_;
  std::optional<BusTime> last_;
};

class SimulatedSensor : public Sensor {
 public:
  explicit SimulatedSensor(double celsius) : celsius_(celsius) {}
  double celsius() const override { return celsius_; }

 private:
  double celsius_;
};

/// Of spools of one length each: when one has run out, the next is put in as soon as the rest is drawn out.
class SimulatedFilament : public FilamentSensor {
 public:
  /// 0: it never ends.
  explicit SimulatedFilament(double length_mm) : length_mm_(length_mm) {}
  FilamentCondition condition() const override {
    return out_at_mm_ ? FilamentCondition::kOut : FilamentCondition::kInOrder;
  }
  void follow(double mm) override;

 private:
  double length_mm_, fed_mm_ = 0;
  std::optional<double> last_mm_;
  std::optional<double> out_at_mm_;  ///< of the extruder, when it ran out
};

class SimulatedProbe : public ContactProbe {
 public:
  bool touches() const override { return false; }
};

// For the registry.
std::unique_ptr<Heater> simulate(const HeaterDescription& heater, const MachineDescription& machine);
std::unique_ptr<Output> simulate(const FanDescription& fan, const MachineDescription& machine);
std::unique_ptr<Output> simulate(const OutputDescription& output, const MachineDescription& machine);
std::unique_ptr<Input> simulate(const InputDescription& input, const MachineDescription& machine);
std::unique_ptr<Sensor> simulate(const SensorDescription& sensor, const MachineDescription& machine);
std::unique_ptr<FilamentSensor> simulate(const FilamentSensorDescription& sensor,
                                         const MachineDescription& machine);
std::unique_ptr<SpindleDrive> simulate(const SpindleDescription& spindle, const MachineDescription& machine);
std::unique_ptr<ContactProbe> simulate(const ProbeDescription& probe, const MachineDescription& machine);

}  // namespace kinebus
