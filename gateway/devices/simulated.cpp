#include "gateway/devices/simulated.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus {
namespace {

/// Seconds since the last call; 0 at the first. Time that stands or goes back counts for nothing.
double elapsed_s(std::optional<BusTime>& last, BusTime now) {
  if (last && now <= *last) return 0;
  const double seconds = last ? to_seconds(now - *last) : 0;
  last = now;
  return seconds;
}

}  // namespace

void SimulatedHeater::on_time(BusTime now) {
  double seconds = elapsed_s(last_, now);
  HeaterStatus& s = status_;
  const double ambient = model_.ambient_celsius;
  // Steps of at most a fifth of the band's own time constant keep the explicit thermostat stable.
  const double step_s = model_.time_constant_s * model_.band_celsius / model_.rise_celsius / 5;
  while (seconds > 0) {
    const double dt = std::min(seconds, step_s);
    const double hold = (s.target_celsius - ambient) / model_.rise_celsius;
    const double power =
        s.target_celsius <= 0
            ? 0
            : std::clamp(hold + (s.target_celsius - s.actual_celsius) / model_.band_celsius, 0.0, 1.0);
    s.power = power;
    const double end = ambient + model_.rise_celsius * power;
    s.actual_celsius = end + (s.actual_celsius - end) * std::exp(-dt / model_.time_constant_s);
    seconds -= dt;
    // A long step at rest temperature needs no small steps.
    if (s.target_celsius <= 0 && seconds > 0) {
      s.actual_celsius = ambient + (s.actual_celsius - ambient) * std::exp(-seconds / model_.time_constant_s);
      seconds = 0;
    }
  }
}

void SimulatedSpindle::on_time(BusTime now) {
  // Steps that are short beside the load's lag.
  constexpr double kStep_s = 1e-3;
  for (double seconds = elapsed_s(last_, now); seconds > 0; seconds -= kStep_s)
    turn(std::min(seconds, kStep_s));
  status_.angle.reset();
  // Where it stands when the program begins nobody knows: the first index pulse is this much away.
  constexpr double kFirstIndex = 0.37;
  if (spindle_.encoder_counts == 0 || turns_ < kFirstIndex) return;
  const double counts = spindle_.encoder_counts;
  status_.angle = SpindleAngle{now, std::floor((turns_ - kFirstIndex) * counts) / counts};
}

void SimulatedSpindle::turn(double seconds) {
  const double most = spindle_.sim_rpm_per_s * seconds;
  drive_rpm_ += std::clamp(status_.target_rpm - drive_rpm_, -most, most);
  if (spindle_.sim_load_s > 0) load_s_ = std::fmod(load_s_ + seconds, spindle_.sim_load_s);
  const bool loaded = load_s_ > spindle_.sim_load_s / 2;
  constexpr double kLag_s = 0.1;
  const double taken = loaded ? spindle_.sim_droop_percent / 100 : 0;
  droop_ = taken + (droop_ - taken) * std::exp(-seconds / kLag_s);
  const double before = status_.actual_rpm;
  status_.actual_rpm = drive_rpm_ * (1 - droop_);
  turns_ += std::abs(before + status_.actual_rpm) / 2 * seconds / 60;
}

void SimulatedInput::on_time(BusTime now) {
  const double seconds = elapsed_s(last_, now);
  if (change_s_ <= 0) return;
  left_s_ -= seconds;
  while (left_s_ <= 0) {
    left_s_ += change_s_;
    on_ = !on_;
    ++(on_ ? changes_.rises : changes_.falls);
  }
}

void SimulatedFilament::follow(double mm) {
  constexpr double kDrawnOut_mm = 10;
  constexpr double kCountsAnew_mm = 200;  // no extruder is as fast: the number has changed, not the filament
  const double way = last_mm_ ? mm - *last_mm_ : 0;
  last_mm_ = mm;
  if (length_mm_ <= 0 || std::abs(way) > kCountsAnew_mm) return;
  fed_mm_ += way;
  if (!out_at_mm_ && fed_mm_ >= length_mm_) out_at_mm_ = fed_mm_;
  if (!out_at_mm_ || fed_mm_ > *out_at_mm_ - kDrawnOut_mm) return;
  out_at_mm_.reset();
  fed_mm_ = 0;
}

std::unique_ptr<Heater> simulate(const HeaterDescription& heater, const MachineDescription& machine) {
  return std::make_unique<SimulatedHeater>(
      HeatModel{.ambient_celsius = machine.thermal.ambient_c,
                .rise_celsius = heater.sim_power_w / heater.sim_loss_w_per_k,
                .time_constant_s = heater.sim_heat_capacity_j_per_k / heater.sim_loss_w_per_k,
                .band_celsius = heater.window_c});
}

std::unique_ptr<Output> simulate(const FanDescription&, const MachineDescription&) {
  return std::make_unique<SimulatedOutput>();
}

std::unique_ptr<Output> simulate(const OutputDescription&, const MachineDescription&) {
  return std::make_unique<SimulatedOutput>();
}

std::unique_ptr<Input> simulate(const InputDescription& input, const MachineDescription&) {
  return std::make_unique<SimulatedInput>(input.sim_on, input.sim_change_s);
}

std::unique_ptr<Sensor> simulate(const SensorDescription& sensor, const MachineDescription&) {
  return std::make_unique<SimulatedSensor>(sensor.sim_c);
}

std::unique_ptr<SpindleDrive> simulate(const SpindleDescription& spindle, const MachineDescription&) {
  return std::make_unique<SimulatedSpindle>(spindle);
}

std::unique_ptr<FilamentSensor> simulate(const FilamentSensorDescription& filament,
                                         const MachineDescription&) {
  return std::make_unique<SimulatedFilament>(filament.sim_length_mm);
}

std::unique_ptr<ContactProbe> simulate(const ProbeDescription&, const MachineDescription&) {
  return std::make_unique<SimulatedProbe>();
}

}  // namespace kinebus
