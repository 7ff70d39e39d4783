#include "node_firmware/port/host/heat_plant.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

namespace kinebus::heat {
namespace {

constexpr double kFanLag = 0.5;         // s
constexpr double kFanPulsesPerS = 180;  // at full speed: 5400 turns a minute, 2 pulses each
constexpr double kLeastTurning = 0.08;  // of full: below, it stands

PlantParameters hot_end() {
  return {.power_w = 44, .heater_j_per_k = 2.1, .block_j_per_k = 12.5, .sensor_lag_s = 1.3, .dead_s = 1.6};
}
PlantParameters bed_of_250_w() {
  return {.power_w = 250,
          .heater_j_per_k = 110,
          .heater_w_per_k = 40,
          .block_j_per_k = 950,
          .loss_w_per_k = 1.1,
          .radiation_w_per_k4 = 3e-9,
          .sensor_lag_s = 7,
          .dead_s = 3};
}
/// Air, and what it warms of the walls. Where nothing heats it only its sensor is looked at.
PlantParameters chamber() {
  return {.power_w = 200,
          .heater_j_per_k = 150,
          .heater_w_per_k = 8,
          .block_j_per_k = 1800,
          .loss_w_per_k = 2.2,
          .radiation_w_per_k4 = 0,
          .sensor_lag_s = 5,
          .dead_s = 0,
          .ambient_c = 24};
}

/// From 0 to `most`; none: it is another, or no number.
std::optional<double> number_in(std::string_view text, double most) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = error == std::errc{} && end == text.data() + text.size() && value >= 0 && value <= most;
  return good ? std::optional(value) : std::nullopt;
}

}  // namespace

HeatPlant::HeatPlant(std::uint32_t seed)
    : places_{ThermalPlant(heat::hot_end(), seed), ThermalPlant(bed_of_250_w(), seed + 1),
              ThermalPlant(chamber(), seed + 2)} {}

void HeatPlant::step(HeatNode& node, LocalTime now) {
  constexpr double dt = ThermalPlant::kStep;
  node.set_supply(kSupplyMv);
  for (std::size_t i = 0; i < fans_.size(); ++i) {
    Turning& fan = fans_[i];
    const double wanted = node.fan_output(static_cast<int>(i)) / static_cast<double>(kFullFan);
    const double goal = fan.stalled || wanted < kLeastTurning ? 0 : wanted;
    fan.speed += (goal - fan.speed) * dt / kFanLag;
    if (goal == 0 && fan.speed < kLeastTurning) fan.speed = 0;
    fan.turned += fan.speed * kFanPulsesPerS * dt;
    const auto pulses = static_cast<std::uint32_t>(fan.turned);
    fan.turned -= pulses;
    node.on_tacho(static_cast<int>(i), pulses);
  }
  filament_.step(extruder_mm_.value_or(1e-3 * node.filament_commanded(1)));
  node.on_filament(0, filament_.level(), 0);
  node.on_filament(1, false, filament_.take_edges());
  pin_probe_.step(node.servo_pulse());
  node.on_probe_line(now, pin_probe_.line());
  node.set_vibration(&vibration_);
  // Its queue would not hold what a fast one measures meanwhile.
  for (const LocalTime at : {now - kPeriod / 2, now}) {
    accelerometer_.step(dt / 2);
    vibration_.on_readings(at, accelerometer_.take());
  }
  hot_end().fan = fans_[1].speed;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    ThermalPlant& place = places_[i];
    const int number = static_cast<int>(i);
    place.contactor = node.contactor();
    place.step(node.heater_output(number) / static_cast<double>(kFullPower));
    if (!place.silent) node.on_sample(now, number, place.ratio());
  }
}

void HeatPlant::rest() {
  for (Turning& fan : fans_) fan.speed = 0;
  hot_end().fan = 0;
  for (ThermalPlant& place : places_) {
    place.contactor = false;
    place.step(0);
  }
}

std::string HeatPlant::command(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string what, which, how, rest;
  words >> what >> which >> how >> rest;
  int number = 0;
  std::from_chars(which.data(), which.data() + which.size(), number);
  const bool done =
      rest.empty() &&
      ((what == "sensor" && break_sensor(number, how)) || (what == "heater" && break_heater(number, how)) ||
       (what == "fan" && break_fan(number, how)) || (what == "flow" && how.empty() && set_flow(which)) ||
       (what == "filament" && how.empty() && break_filament(which)) ||
       (what == "probe" && how.empty() && break_probe(which)) || (what == "shake" && shake(which, how)) ||
       (what == "accelerometer" && how.empty() && break_accelerometer(which)));
  if (done) return {};
  std::string parts;
  for (const NamedSensorPart& part : kSensorParts) parts += "|" + std::string(part.name);
  return "\"" + std::string(text) + "\": expected sensor N open|short|loose|silent|frozen|ok" + parts +
         ", heater N loose|open|stuck|ok, fan N "
         "stalled|ok, flow MM3_PER_S, filament out|jammed|slips|ok, probe in|out|falls|alarm|ok, shake HZ "
         "MM_PER_S2, or accelerometer silent|ok";
}

bool HeatPlant::break_sensor(int number, std::string_view how) {
  if (number < 1 || number > kSensors) return false;
  ThermalPlant& place = places_[static_cast<std::size_t>(number - 1)];
  if (const auto part = sensor_part(how)) {
    plug(number - 1, *part);
    return true;
  }
  if (how == "open") return place.sensor_open = true;
  if (how == "short") return place.sensor_short = true;
  if (how == "silent") return place.silent = true;
  if (how == "frozen") return place.frozen = true;
  if (how == "loose") {
    place.sensor_contact = 0;
    return true;
  }
  if (how != "ok") return false;
  place.sensor_open = place.sensor_short = place.silent = place.frozen = false;
  place.sensor_contact = 1;
  return true;
}

bool HeatPlant::break_heater(int number, std::string_view how) {
  if (number < 1 || number > 3) return false;
  ThermalPlant& place = places_[static_cast<std::size_t>(number - 1)];
  if (how == "open") return place.mosfet_open = true;
  if (how == "stuck") return place.mosfet_stuck = true;
  if (how == "loose") {
    place.heater_contact = 0.02;
    return true;
  }
  if (how != "ok") return false;
  place.mosfet_open = place.mosfet_stuck = false;
  place.heater_contact = 1;
  return true;
}

bool HeatPlant::break_fan(int number, std::string_view how) {
  if (number < 1 || number > 2 || (how != "stalled" && how != "ok")) return false;
  fans_[static_cast<std::size_t>(number - 1)].stalled = how == "stalled";
  return true;
}

bool HeatPlant::break_filament(std::string_view how) {
  constexpr double kSlips = 0.35;  // of what the extruder turns
  if (how != "out" && how != "jammed" && how != "slips" && how != "ok") return false;
  filament_.out = how == "out";
  filament_.share = how == "jammed" ? 0 : how == "slips" ? kSlips : 1;
  return true;
}

bool HeatPlant::break_probe(std::string_view how) {
  if (how != "in" && how != "out" && how != "falls" && how != "alarm" && how != "ok") return false;
  pin_probe_.mend();
  pin_probe_.stays_in = how == "in";
  pin_probe_.hangs_out = how == "out";
  pin_probe_.falls_out = how == "falls";
  if (how == "alarm") pin_probe_.alarm(true);
  return true;
}

bool HeatPlant::set_flow(std::string_view text) {
  const auto flow = number_in(text, 100);
  if (flow) hot_end().flow_mm3_per_s = *flow;
  return flow.has_value();
}

bool HeatPlant::break_accelerometer(std::string_view how) {
  if (how != "silent" && how != "ok") return false;
  accelerometer_.silent = how == "silent";
  return true;
}

bool HeatPlant::shake(std::string_view hz, std::string_view mm_per_s2) {
  const auto frequency = number_in(hz, 1000), amplitude = number_in(mm_per_s2, 150'000);
  if (!frequency || !amplitude) return false;
  accelerometer_.feels = [f = *frequency, a = *amplitude](double t) {
    const double now = a * std::sin(2 * std::numbers::pi * f * t);
    return AccelerometerPlant::Vector{now, now, now};
  };
  return true;
}

}  // namespace kinebus::heat
