#include "node_firmware/heat/heater.hpp"

#include <algorithm>

namespace kinebus::heat {
namespace {

/// A supply that has changed by less than 0.4 % is the same.
constexpr std::uint32_t kSupplyStep = 256;
/// A block that was at its target is not so much warmer, by no overshoot.
constexpr std::int32_t kPutBack = 10'000;  // mC
/// A supply so far from nominal is not compensated further: the measurement may be wrong.
constexpr std::uint32_t kLowestSupply = 2, kHighestSupply = 2;  // halves to doubles
/// What a hot end loses to the air, uW a K: 0.04 to 0.08 W/K. A heater that was never measured begins with
/// it; of a bed it is hardly a part.
constexpr std::uint64_t kUsualLoss = 60'000;
constexpr std::uint64_t kMostUsual = 4'000;  // ppm of full power a K
/// Who may take so long for 2 K is a bed or a chamber.
constexpr std::uint16_t kSlowRise = 40;  // s

}  // namespace

HeaterFault heater_fault(SensorFault fault) {
  switch (fault) {
    case SensorFault::kNone:
      return HeaterFault::kNone;
    case SensorFault::kOpen:
      return HeaterFault::kSensorOpen;
    case SensorFault::kShort:
      return HeaterFault::kSensorShort;
    case SensorFault::kJump:
      return HeaterFault::kSensorJump;
    case SensorFault::kSilent:
      return HeaterFault::kSensorSilent;
  }
  return HeaterFault::kSensorSilent;
}

void Heater::configure(const HeaterSettings& settings) {
  settings_ = settings;
  has_model_ = settings.model.usable();
  if (has_model_) {
    model_.configure(settings.model);
    by_model_.configure(settings.model);
  }
  const std::uint64_t usual = kUsualLoss * 1000 / std::max<std::uint32_t>(settings.nominal_mw, 1);
  const bool slow = !has_model_ && settings.watch.rise_s >= kSlowRise && settings.pid == PidParameters{};
  by_pid_.configure(slow ? kSlowPid : settings.pid,
                    has_model_ ? 0 : static_cast<std::uint32_t>(std::min(usual, kMostUsual)));
  watch_.configure(settings.watch, has_model_ ? &model_ : nullptr);
  most_ = kFullPower * std::min<std::uint32_t>(settings.most_power, 100) / 100;
  supply_mv_ = 0;
  started_ = false;
}

void Heater::set_feed_forward(std::int32_t mw, bool quiet) {
  quiet_ = quiet;
  const auto nominal = static_cast<std::int32_t>(std::max<std::uint32_t>(settings_.nominal_mw, 1));
  const std::int32_t limited = std::clamp(mw, -nominal, nominal);
  feed_forward_ = static_cast<std::int32_t>(static_cast<std::int64_t>(limited) * kFullPower / nominal);
}

void Heater::begin_tuning(HeatTuning& tuning, const SensorInput& sensor, std::int32_t target) {
  target_ = 0;
  tuning.begin(sensor.temperature(), target, settings_.watch.limit_mc);
  tuning_ = tuning.running() ? &tuning : nullptr;
}

void Heater::trip(HeaterFault fault) {
  if (fault_ == HeaterFault::kNone) fault_ = fault;
  if (target_ != 0) asked_ = target_;
  target_ = 0;
  feed_forward_ = given_forward_ = 0;
  duty_ = 0;
  if (tuning_ != nullptr) tuning_->stop();
  tuning_ = nullptr;
}

void Heater::clear_fault() {
  fault_ = HeaterFault::kNone;
  started_ = false;
}

void Heater::step(const SensorInput& sensor, std::uint32_t supply_mv) {
  follow_supply(supply_mv);
  // What really went out: nothing while the sensor is not believed.
  given_ = static_cast<std::uint32_t>(static_cast<std::uint64_t>(duty_) * strength_ / kFullPower);
  if (const HeaterFault fault = heater_fault(sensor.fault()); fault != HeaterFault::kNone) trip(fault);
  // Where nothing changes the model has nothing to miss: in holding only this tells.
  if (sensor.frozen() && (target_ != 0 || tuning_ != nullptr)) trip(HeaterFault::kSensorSilent);
  const bool repeats = sensor.frozen() && fault_ == HeaterFault::kSensorSilent;
  if (!sensor.good() || repeats) {
    // Blind for a moment: no power, no word from the watch, and the model goes on by itself.
    if (started_ && has_model_) model_.step_blind(-given_forward_);
    watch_.interrupt();
    duty_ = given_ = 0;
    return;
  }
  const std::int32_t measured = sensor.temperature();
  if (!started_) {
    started_ = true;
    model_.start(measured);
    by_pid_.start(measured);
    watch_.start();
  }
  if (has_model_) model_.step(static_cast<std::int32_t>(given_) - given_forward_, measured);
  given_forward_ = feed_forward_;
  const bool modelled = has_model_ && tuning_ == nullptr;
  // The model's watch goes on after a fault, too: heat that does not end is another one.
  HeaterFault found =
      watch_.step(measured, given_, target_, modelled ? &model_ : nullptr, feed_forward_, quiet_);
  // A loose sensor that is put back warms without power, to what the block was heated to.
  const bool put_back = fault_ == HeaterFault::kHeatMissing && measured < asked_ + kPutBack;
  if (found == HeaterFault::kHeatUnasked && put_back) found = HeaterFault::kNone;
  if (found == HeaterFault::kHeatUnasked && fault_ != HeaterFault::kNone) fault_ = found;
  if (found != HeaterFault::kNone) trip(found);
  set_duty(fault_ == HeaterFault::kNone ? wanted(measured, most_) : 0);
}

std::uint32_t Heater::wanted(std::int32_t measured, std::uint32_t most) {
  if (tuning_ != nullptr) {
    const std::uint32_t power = tuning_->step(measured, given_);
    if (!tuning_->running()) tuning_ = nullptr;
    return std::min(power, most);
  }
  if (target_ == 0) {
    by_pid_.start(measured);
    return 0;
  }
  if (has_model_ && settings_.control == ControlKind::kModel)
    return by_model_.step(target_, model_, feed_forward_, kFullPower);
  return by_pid_.step(target_, measured, most);
}

void Heater::follow_supply(std::uint32_t supply_mv) {
  const std::uint32_t nominal = settings_.nominal_mv;
  if (supply_mv == 0 || nominal == 0) supply_mv = nominal;
  const std::uint32_t change = supply_mv > supply_mv_ ? supply_mv - supply_mv_ : supply_mv_ - supply_mv;
  if (supply_mv == 0 || (supply_mv_ != 0 && change * kSupplyStep < supply_mv_)) return;
  supply_mv_ = supply_mv;
  const std::uint64_t volts = std::clamp(supply_mv, nominal / kLowestSupply, nominal * kHighestSupply);
  const std::uint64_t square = volts * volts, whole = static_cast<std::uint64_t>(nominal) * nominal;
  strength_ = static_cast<std::uint32_t>(square * kFullPower / whole);
  weakness_ = static_cast<std::uint32_t>(whole * kFullPower / square);
}

void Heater::set_duty(std::uint32_t power) {
  std::uint32_t duty =
      std::min(static_cast<std::uint32_t>(static_cast<std::uint64_t>(power) * weakness_ / kFullPower), most_);
  if (settings_.output == OutputKind::kWholeTicks) {
    // What is owed is paid when it is a whole tick.
    owed_ = duty == 0 ? 0 : owed_ + duty;
    const bool on = owed_ >= kFullPower;
    if (on) owed_ -= kFullPower;
    duty = on ? kFullPower : 0;
  }
  duty_ = duty;
}

}  // namespace kinebus::heat
