#pragma once
// Heaters, fan and spindle behind one interface, and their simulation: heat is a first-order model with a
// thermostat, the spindle gains speed evenly, so that waits (M109, M3) take time on the virtual machine too.

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "gateway/result.hpp"
#include "gateway/sentence.hpp"
#include "gateway/status/status.hpp"
#include "protocol/time.hpp"

namespace kinebus {

enum class Heater : std::uint8_t { kHotend, kBed };

/// What the gateway asks of heaters and spindle, real or simulated. Temperatures in deg C.
class ThermalDevice {
 public:
  virtual ~ThermalDevice() = default;
  virtual void set_target(Heater heater, double celsius) = 0;  ///< 0: off
  virtual void set_fan(double ratio) = 0;                      ///< 0..1
  virtual HeaterStatus heater(Heater heater) const = 0;
  virtual double fan() const = 0;
  virtual void set_spindle(double rpm) = 0;  ///< > 0 clockwise, < 0 the other way, 0: off
  virtual SpindleStatus spindle() const = 0;
  virtual void on_time(BusTime now) = 0;
  /// Plain words when a heater is out of control (sensor broken, no rise); then all heaters are off already.
  virtual std::optional<Sentence> fault() const = 0;
};

/// T' = (ambient + rise * power - T) / time_constant, solved exactly for any step; the thermostat is a
/// proportional band of `band` around the target with the model's own holding power, so the temperature
/// settles on the target.
class SimulatedThermal : public ThermalDevice {
 public:
  struct Model {
    double rise_celsius = 320;  ///< above ambient at full power, in the end
    double time_constant_s = 90;
    double band_celsius = 4;
  };
  struct Options {
    double ambient_celsius = 22;
    Model hotend{};
    Model bed{110, 240, 2};
    double spindle_rpm_per_s = 6000;
  };
  SimulatedThermal() : SimulatedThermal(Options{}) {}
  explicit SimulatedThermal(Options options);

  void set_target(Heater heater, double celsius) override;
  void set_fan(double ratio) override { fan_ = ratio; }
  HeaterStatus heater(Heater heater) const override;
  double fan() const override { return fan_; }
  void set_spindle(double rpm) override { spindle_.target_rpm = rpm; }
  SpindleStatus spindle() const override { return spindle_; }
  void on_time(BusTime now) override;
  std::optional<Sentence> fault() const override { return std::nullopt; }

 private:
  struct State {
    Model model;
    double celsius = 0;
    double target = 0;
  };
  void advance(State& state, double seconds) const;

  double ambient_;
  std::array<State, 2> heaters_;
  double fan_ = 0;
  double spindle_rpm_per_s_;
  SpindleStatus spindle_;
  std::optional<BusTime> last_;
};

/// A wait for a temperature: reached within the window (and not above it when cooling counts too).
struct TemperatureWait {
  Heater heater{};
  double celsius = 0;
  double window_celsius = 1;
  bool cooling_too = false;
  bool over(const ThermalDevice& device) const;
};

}  // namespace kinebus
