#include "gateway/run/heat.hpp"

#include <cmath>
#include <utility>

#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using Done = Result<void, Refusal>;
using What = canonical::Thermal::What;

SimulatedThermal::Model heat_model(const HeaterDescription& heater) {
  return {.rise_celsius = heater.sim_power_w / heater.sim_loss_w_per_k,
          .time_constant_s = heater.sim_heat_capacity_j_per_k / heater.sim_loss_w_per_k,
          .band_celsius = heater.window_c};
}

SimulatedThermal::Options device_options(const MachineDescription& machine) {
  return {.ambient_celsius = machine.thermal.ambient_c,
          .hotend = heat_model(machine.thermal.hotend),
          .bed = heat_model(machine.thermal.bed),
          .spindle_rpm_per_s = machine.spindle.sim_rpm_per_s};
}

}  // namespace

Heat::Heat(const MachineDescription& machine) : machine_(machine), device_(device_options(machine)) {}

Done Heat::set_temperature(bool bed, double celsius) {
  const HeaterDescription& heater = bed ? machine_.thermal.bed : machine_.thermal.hotend;
  // What is not there is off.
  if (!heater.present && celsius != 0)
    return refused(say("this machine has no %1 heater", bed ? say("bed") : say("hotend")));
  if (!(celsius >= 0 && celsius <= heater.max_c))
    return refused(say("the temperature must be 0 to %1 C", std::lround(heater.max_c)));
  device_.set_target(bed ? Heater::kBed : Heater::kHotend, celsius);
  if (kept_) (bed ? kept_->bed_celsius : kept_->hotend_celsius) = celsius;
  return {};
}

Done Heat::set_fan(double ratio) {
  if (!(ratio >= 0 && ratio <= 1)) return refused(say("a fan's ratio is 0 to 1"));
  device_.set_fan(ratio);
  return {};
}

Done Heat::set_spindle(double rpm) {
  if (auto wrong = wrong_spindle_speed(machine_.spindle, rpm)) return refused(std::move(*wrong));
  device_.set_spindle(rpm);
  return {};
}

void Heat::execute(const canonical::Thermal& thermal) {
  if (thermal.what == What::kFan)
    device_.set_fan(thermal.value);
  else
    device_.set_target(thermal.what == What::kHotend ? Heater::kHotend : Heater::kBed, thermal.value);
}

void Heat::heaters_off() {
  device_.set_target(Heater::kHotend, 0);
  device_.set_target(Heater::kBed, 0);
}

std::optional<double> Heat::hotend_target() const {
  const double celsius = device_.heater(Heater::kHotend).target_celsius;
  return celsius > 0 ? std::optional(celsius) : std::nullopt;
}

std::optional<Sentence> Heat::too_cold() const {
  const double celsius = device_.heater(Heater::kHotend).actual_celsius;
  if (!machine_.thermal.hotend.present || celsius >= machine_.thermal.min_extrude_c) return std::nullopt;
  return say("the hotend is too cold to feed filament: %1 C", std::lround(celsius));
}

void Heat::report(MachineStatus& status) const {
  status.hotend = device_.heater(Heater::kHotend);
  status.bed = device_.heater(Heater::kBed);
  status.fan = device_.fan();
  status.spindle = device_.spindle();
}

// The job under way
// -----------------------------------------------------------------------------------------------

void Heat::begin_job() {
  kept_.reset();
  noted_ = {};
}

void Heat::take_up(const std::optional<journal::Thermal>& noted) {
  kept_ = noted;
  if (noted) noted_ = *noted;
}

void Heat::note(journal::Queue& journal) {
  if (kept_) return;
  const journal::Thermal now{device_.heater(Heater::kHotend).target_celsius,
                             device_.heater(Heater::kBed).target_celsius, device_.fan(),
                             device_.spindle().target_rpm};
  if (!(now == noted_)) journal.push(noted_ = now);
}

void Heat::keep() {
  if (!kept_) kept_ = noted_;
}

std::optional<double> Heat::kept_hotend() const {
  return kept_ && kept_->hotend_celsius > 0 ? std::optional(kept_->hotend_celsius) : std::nullopt;
}

bool Heat::start_kept_spindle() {
  if (!kept_ || kept_->spindle_rpm == 0) return false;
  device_.set_spindle(kept_->spindle_rpm);
  return true;
}

std::vector<canonical::Line> Heat::lead_back() {
  const journal::Thermal wanted = kept_.value_or(noted_);
  device_.set_fan(wanted.fan);
  std::vector<canonical::Line> commands;
  const auto add = [&](What what, Heater heater, const HeaterDescription& description, double celsius) {
    const HeaterStatus status = device_.heater(heater);
    if (!description.present || celsius <= 0) return;
    const bool hot = status.actual_celsius >= celsius - description.window_c;
    if (!hot || status.target_celsius != celsius)
      commands.push_back({0, canonical::Thermal{.what = what, .value = celsius, .wait = true}});
  };
  add(What::kBed, Heater::kBed, machine_.thermal.bed, wanted.bed_celsius);
  add(What::kHotend, Heater::kHotend, machine_.thermal.hotend, wanted.hotend_celsius);
  if (wanted.spindle_rpm != 0 && wanted.spindle_rpm != device_.spindle().actual_rpm)
    commands.push_back({0, canonical::Spindle{wanted.spindle_rpm}});
  return commands;
}

void Heat::finish_return() {
  const auto kept = std::exchange(kept_, std::nullopt);
  if (!kept) return;
  if (kept->hotend_celsius <= 0) device_.set_target(Heater::kHotend, 0);
  if (kept->bed_celsius <= 0) device_.set_target(Heater::kBed, 0);
}

// Waits
// -------------------------------------------------------------------------------------------------------

void HeatWait::begin(const canonical::Thermal& thermal, const HeaterDescription& heater) {
  wait_ = {thermal.what == What::kHotend ? Heater::kHotend : Heater::kBed, thermal.value, heater.window_c,
           thermal.wait_cooling};
  settle_ = heater.settle;
  since_.reset();
}

bool HeatWait::over(const Heat& heat, BusTime now) {
  if (!heat.reached(wait_)) {
    since_.reset();
    return false;
  }
  if (!since_) since_ = now;
  return now - *since_ >= settle_;
}

}  // namespace kinebus
