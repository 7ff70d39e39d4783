#include "gateway/run/heat.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gateway/description/usual_temperature.hpp"
#include "gateway/jobs/machine_setup.hpp"

namespace kinebus {
namespace {

using Done = Result<void, Refusal>;
using What = canonical::Thermal::What;

/// A node measures a rise of at least so much: K.
constexpr double kLeastWay = 40;
/// A hot end without power loses at most so much while a path comes to rest: K.
constexpr double kFallsMeanwhile = 2;

}  // namespace

Done Heat::set_temperature(HeaterId heater, double celsius) {
  if (static_cast<std::size_t>(heater.kind) >= kHeaterKinds)
    return refused(say("this machine has no such heater"));
  const HeaterDescription* known = machine_.heater(heater);
  // What is not there is off.
  if (known == nullptr && celsius == 0) return {};
  if (known == nullptr) return refused(say("this machine has no %1 heater", heater_words(heater)));
  if (!(celsius >= 0 && celsius <= known->max_c))
    return refused(say("the temperature must be 0 to %1 C", std::lround(known->max_c)));
  if (auto absent = celsius > 0 ? devices_.absent(heater) : std::nullopt) return refused(std::move(*absent));
  if (const HeaterDescription* measured = tuned(); celsius > 0 && measured != nullptr)
    return refused(say("heater.%1 is being measured: a target of 0 ends that", measured->name));
  devices_.heat(heater, celsius);
  if (kept_) kept_->heater(heater) = celsius;
  return {};
}

Done Heat::tune(HeaterId heater, double celsius) {
  const HeaterDescription* known =
      static_cast<std::size_t>(heater.kind) < kHeaterKinds ? machine_.heater(heater) : nullptr;
  if (known == nullptr) return refused(say("this machine has no such heater"));
  const auto name = "heater." + known->name;
  if (auto cannot = devices_.cannot_tune(heater)) return refused(say("%1: %2", name, std::move(*cannot)));
  if (auto absent = devices_.absent(heater)) return refused(std::move(*absent));
  if (auto fault = devices_.heater_fault(heater)) return refused(say("%1: %2", name, std::move(*fault)));
  if (const HeaterDescription* measured = tuned(); measured != nullptr)
    return refused(say("heater.%1 is being measured: a target of 0 ends that", measured->name));
  if (heats()) return refused(say("a heater is measured while all are off: switch them off first"));
  if (celsius == 0) celsius = usual_celsius(*known);
  if (!(celsius > 0 && celsius <= known->max_c))
    return refused(say("the temperature must be 0 to %1 C", std::lround(known->max_c)));
  const double actual = devices_.heater(heater).actual_celsius;
  if (celsius - actual < kLeastWay)
    return refused(
        say("%1 is at %2 C: from there to %3 C it is less than the %4 K that a measurement needs; "
            "let it cool, or choose a higher temperature",
            name, std::lround(actual), std::lround(celsius), std::lround(kLeastWay)));
  devices_.tune(heater, celsius);
  return {};
}

const HeaterDescription* Heat::tuned() const {
  const auto found =
      std::find_if(machine_.heaters.begin(), machine_.heaters.end(),
                   [this](const HeaterDescription& h) { return devices_.tuning(h.id()).runs(); });
  return found != machine_.heaters.end() ? &*found : nullptr;
}

Done Heat::set_fan(std::uint8_t index, double ratio) {
  if (!(ratio >= 0 && ratio <= 1)) return refused(say("a fan's ratio is 0 to 1"));
  if (auto missing = missing_fan(machine_, {.what = What::kFan, .value = ratio, .index = index}))
    return refused(std::move(*missing));
  devices_.blow(index, ratio);
  return {};
}

Done Heat::set_output(std::uint8_t index, double ratio) {
  if (!(ratio >= 0 && ratio <= 1)) return refused(say("an output's ratio is 0 to 1"));
  if (auto wrong = wrong_device_command(machine_, {.what = What::kOutput, .value = ratio, .index = index}))
    return refused(std::move(*wrong));
  devices_.put_out(index, ratio);
  return {};
}

Done Heat::move_pin(ContactProbe::PinOrder order) {
  ContactProbe* const probe = devices_.probe();
  if (probe == nullptr || probe->pin() == ContactProbe::Pin::kNone)
    return refused(say("the machine has no probe with a pin"));
  if (auto absent = probe->absent()) return refused(std::move(*absent));
  probe->move_pin(order);
  return {};
}

Done Heat::set_spindle(double rpm) {
  if (auto wrong = wrong_spindle_speed(machine_.spindle, rpm)) return refused(std::move(*wrong));
  devices_.turn_spindle(rpm);
  return {};
}

void Heat::execute(const canonical::Thermal& thermal) {
  const auto index = static_cast<std::uint8_t>(thermal.index);
  if (const auto heater = heater_of(thermal))
    devices_.heat(*heater, thermal.value);
  else if (thermal.what == What::kFan)
    devices_.blow(index, thermal.value);
  else
    devices_.put_out(index, thermal.value);
}

void Heat::heaters_off(Beds beds) {
  if (beds == Beds::kOff) return devices_.heaters_off();
  for (const HeaterDescription& h : machine_.heaters)
    if (h.kind != HeaterKind::kBed || devices_.heater_fault(h.id()) || devices_.tuning(h.id()).runs())
      devices_.heat(h.id(), 0);
}

bool Heat::heats() const {
  return std::any_of(machine_.heaters.begin(), machine_.heaters.end(), [this](const HeaterDescription& h) {
    return devices_.heater(h.id()).target_celsius > 0 || devices_.tuning(h.id()).runs();
  });
}

HotendTargets Heat::hotends(const std::function<std::optional<double>(const HeaterDescription&)>& of) const {
  HotendTargets all{};
  for (const HeaterDescription& h : machine_.heaters)
    if (h.kind == HeaterKind::kHotend && h.index < all.size()) all[h.index] = of(h);
  return all;
}

HotendTargets Heat::hotend_targets() const {
  return hotends([this](const HeaterDescription& h) {
    const double celsius = target(h.id());
    return celsius > 0 ? std::optional(celsius) : std::nullopt;
  });
}

double Heat::hottest_target() const {
  double hottest = 0;
  for (const std::optional<double>& celsius : hotend_targets())
    hottest = std::max(hottest, celsius.value_or(0));
  return hottest;
}

HotendTargets Heat::hotends_found() const {
  return hotends([this](const HeaterDescription& h) {
    const double celsius = target(h.id());
    return celsius > 0 || h.place.on_node() ? std::optional(celsius) : std::nullopt;
  });
}

HotendTargets Heat::kept_hotends() const {
  return hotends([this](const HeaterDescription& h) {
    const double celsius = kept_ ? kept_->heater(h.id()) : 0;
    return celsius > 0 ? std::optional(celsius) : std::nullopt;
  });
}

void Heat::select(int hotend) {
  const auto chosen = static_cast<std::uint8_t>(hotend % kMostOfAKind);
  if (chosen == tool_) return;
  devices_.feed_ahead(tool(), {});
  tool_ = chosen;
}

void Heat::feed_ahead(const FlowAhead& mm_per_s) {
  const HeaterDescription* hotend = machine_.heater(tool());
  if (hotend == nullptr) return;
  const double radius = machine_.gcode.filament_diameter_mm / 2;
  const double j_per_mm = hotend->wiring.filament_j_per_mm3_k * std::numbers::pi * radius * radius *
                          std::max(0.0, target(tool()) - machine_.thermal.ambient_c);
  FlowAhead watts{};
  for (std::size_t i = 0; i < watts.size(); ++i) watts[i] = std::max(0.0, mm_per_s[i]) * j_per_mm;
  devices_.feed_ahead(tool(), watts);
}

void Heat::stand_by(double celsius) {
  // Not what the job wants: that is kept.
  for (const HeaterDescription& heater : machine_.heaters)
    if (heater.kind == HeaterKind::kHotend && devices_.heater(heater.id()).target_celsius > celsius)
      devices_.heat(heater.id(), celsius);
}

std::optional<Sentence> Heat::too_cold() const {
  const double celsius = devices_.heater(tool()).actual_celsius;
  if (machine_.heater(tool()) == nullptr || celsius >= machine_.thermal.min_extrude_c) return std::nullopt;
  return say("the %1 is too cold to feed filament: %2 C", heater_words(tool()), std::lround(celsius));
}

bool Heat::melts() const {
  const HeaterDescription* hotend = machine_.heater(tool());
  if (hotend == nullptr) return true;
  const double least = machine_.thermal.min_extrude_c;
  const HeaterStatus status = devices_.heater(tool());
  // One that is turned down falls on while the path stops; one that is held just there swings.
  const double limit = status.target_celsius < least
                           ? least + kFallsMeanwhile
                           : std::min(least, status.target_celsius - hotend->window_c);
  return status.actual_celsius >= limit;
}

DeviceFault Heat::feeds_cold() const {
  const HeaterDescription* hotend = machine_.heater(tool());
  const HeaterStatus status = devices_.heater(tool());
  const auto least = std::lround(machine_.thermal.min_extrude_c);
  DeviceFault fault;
  fault.device = "heater." + (hotend != nullptr ? hotend->name : std::string());
  fault.cold = true;
  fault.words = status.target_celsius < machine_.thermal.min_extrude_c
                    ? say("it is set to %1 C and filament is to be fed: at least %2 C is needed",
                          std::lround(status.target_celsius), least)
                    : say("it has only %1 C and filament is to be fed: at least %2 C is needed",
                          std::lround(status.actual_celsius), least);
  if (hotend != nullptr && hotend->place.on_node()) fault.node = hotend->place.node_id;
  return fault;
}

std::optional<Heat::Cold> Heat::kept_too_cold() const {
  if (!kept_) return std::nullopt;
  const HeaterId hotend{HeaterKind::kHotend, kept_->tool()};
  const double celsius = kept_->heater(hotend);
  return celsius < machine_.thermal.min_extrude_c ? std::optional(Cold{hotend, celsius}) : std::nullopt;
}

bool Heat::melts_by_node() const {
  const HeaterDescription* hotend = machine_.heater(tool());
  return hotend != nullptr && hotend->place.on_node();
}

void Heat::report(MachineStatus& status) const {
  status.heaters = devices_.heaters();
  status.tool = tool();
  status.fans = devices_.fans();
  status.outputs = devices_.outputs();
  status.inputs = devices_.inputs();
  status.sensors = devices_.sensors();
  status.filaments = devices_.filaments();
  status.spindle = devices_.spindle();
  if (machine_.probe.present) status.probe_touches = devices_.probe_touches();
  if (const ContactProbe* const probe = devices_.probe()) status.probe_pin = probe->pin();
}

// The job under way
// -----------------------------------------------------------------------------------------------

void Heat::begin_job() {
  kept_.reset();
  select(0);
  noted_ = {};
}

void Heat::take_up(const std::optional<journal::Heat>& noted) {
  kept_ = noted;
  if (noted) noted_ = *noted;
}

journal::Heat Heat::told_now() const {
  journal::Heat heat;
  for (const HeaterDescription& h : machine_.heaters)
    heat.heater(h.id()) = devices_.heater(h.id()).target_celsius;
  for (const FanDescription& f : machine_.fans) heat.fan(f.index) = devices_.fan(f.index);
  for (const OutputDescription& o : machine_.outputs) heat.output(o.index) = devices_.output(o.index);
  heat.spindle_rpm = devices_.spindle().target_rpm;
  heat.set_tool(tool_);
  return heat;
}

void Heat::note(journal::Queue& journal) {
  if (kept_) return;
  if (const journal::Heat now = told_now(); !(now == noted_)) journal.push(noted_ = now);
}

void Heat::keep() {
  if (!kept_) kept_ = noted_;
}

bool Heat::kept_heat() const {
  return kept_ &&
         std::any_of(machine_.heaters.begin(), machine_.heaters.end(), [this](const HeaterDescription& h) {
           const double kept = kept_->heater(h.id());
           return kept > 0 && devices_.heater(h.id()).target_celsius != kept;
         });
}

bool Heat::start_kept_spindle() {
  if (!kept_ || kept_->spindle_rpm == 0) return false;
  devices_.turn_spindle(kept_->spindle_rpm);
  return true;
}

/// Beds first: they take longest and hold the part; then chambers, then hot ends, then the spindle.
std::vector<canonical::Line> Heat::lead_back() {
  const journal::Heat wanted = kept_.value_or(noted_);
  select(wanted.tool());
  for (const FanDescription& f : machine_.fans) devices_.blow(f.index, wanted.fan(f.index));
  for (const OutputDescription& o : machine_.outputs) devices_.put_out(o.index, wanted.output(o.index));
  std::vector<canonical::Line> commands;
  for (const What what : {What::kBed, What::kChamber, What::kHotend})
    for (const HeaterDescription& h : machine_.heaters) {
      const canonical::Thermal command{
          .what = what, .value = wanted.heater(h.id()), .wait = true, .index = h.index};
      if (heater_of(command) != h.id() || command.value <= 0) continue;
      const HeaterStatus status = devices_.heater(h.id());
      const bool hot = status.actual_celsius >= command.value - h.window_c;
      if (!hot || status.target_celsius != command.value) commands.push_back({0, command});
    }
  if (wanted.spindle_rpm != 0 && wanted.spindle_rpm != devices_.spindle().actual_rpm)
    commands.push_back({0, canonical::Spindle{wanted.spindle_rpm}});
  return commands;
}

void Heat::finish_return() {
  const auto kept = std::exchange(kept_, std::nullopt);
  if (!kept) return;
  for (const HeaterDescription& h : machine_.heaters)
    if (kept->heater(h.id()) <= 0) devices_.heat(h.id(), 0);
}

// Waits
// -------------------------------------------------------------------------------------------------------

void HeatWait::begin(const canonical::Thermal& thermal, const HeaterDescription& heater, const Heat& heat) {
  wait_ = {heater.id(), thermal.value, heater.window_c, thermal.wait_cooling};
  told_ = heat.target(heater.id());
  settle_ = heater.settle;
  since_.reset();
}

bool HeatWait::over(const Heat& heat, BusTime now) {
  if (const double target = heat.target(wait_.heater); target > 0 && target != told_)
    wait_.celsius = told_ = target;
  if (!heat.reached(wait_)) {
    since_.reset();
    return false;
  }
  if (!since_) since_ = now;
  return now - *since_ >= settle_;
}

}  // namespace kinebus
