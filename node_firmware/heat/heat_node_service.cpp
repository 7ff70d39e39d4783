// HeatNode: what is looked after on every input and every tick, one job a function.

#include <algorithm>

#include "node_firmware/heat/heat_node.hpp"

namespace kinebus::heat {
namespace {

using namespace heat_object;

constexpr std::int32_t kMcPerTenth = 100;
/// A set point keeps so far from its limit that noise and the way there do not trip it: 0.1 C.
constexpr std::int32_t kBelowLimit = 100;

std::uint16_t code_of(HeaterFault fault) {
  switch (fault) {
    case HeaterFault::kNone:
      return emcy::kNoError;
    case HeaterFault::kSensorOpen:
      return emcy::kSensorOpen;
    case HeaterFault::kSensorShort:
      return emcy::kSensorShort;
    case HeaterFault::kSensorJump:
      return emcy::kSensorJump;
    case HeaterFault::kSensorSilent:
      return emcy::kSensorSilent;
    case HeaterFault::kTooHot:
      return emcy::kHeaterTooHot;
    case HeaterFault::kHeatMissing:
      return emcy::kHeatMissing;
    case HeaterFault::kHeatUnasked:
      return emcy::kHeatUnasked;
    case HeaterFault::kFan:
      return emcy::kFanStalled;
  }
  return emcy::kSoftware;
}

}  // namespace

bool HeatNode::has_path(std::size_t n) const {
  const auto path = static_cast<SensorPath>(value(heat_slot_of(kSensorPath), n));
  return path != SensorPath::kMax31865 || (options_.max31865 >> n & 1) != 0;
}

SensorSetup HeatNode::sensor_setup(std::size_t n) const {
  const auto number = [&](ObjectSlot slot) { return static_cast<std::uint32_t>(value(slot, n)); };
  const auto mc = [&](ObjectSlot slot) { return static_cast<std::int32_t>(value(slot, n)) * kMcPerTenth; };
  // Stored by a board that has what it needs, on one that has not: nothing is measured.
  const std::uint32_t kind = has_path(n) ? number(heat_slot_of(kSensorType)) : 0;
  return {.kind = static_cast<SensorKind>(kind),
          .path = static_cast<SensorPath>(number(heat_slot_of(kSensorPath))),
          .reference_mohm = number(heat_slot_of(kReference)),
          .wiring = {.three_wires = number(heat_slot_of(kSensorWires)) == 3,
                     .mains_60hz = value(heat_slot_of(kMains)) == 60},
          .nominal_mohm = number(heat_slot_of(kNominalResistance)),
          .beta_k = number(heat_slot_of(kBeta)),
          .points = {{{mc(heat_slot_of(kPointTemperature1)), number(heat_slot_of(kPointResistance1))},
                      {mc(heat_slot_of(kPointTemperature2)), number(heat_slot_of(kPointResistance2))},
                      {mc(heat_slot_of(kPointTemperature3)), number(heat_slot_of(kPointResistance3))}}},
          .low_mc = mc(heat_slot_of(kLowestPlausible)),
          .high_mc = mc(heat_slot_of(kHighestPlausible))};
}

HeaterSettings HeatNode::heater_settings(std::size_t n) const {
  const auto number = [&](ObjectSlot slot) { return static_cast<std::uint32_t>(value(slot, n)); };
  return {.control = static_cast<ControlKind>(number(heat_slot_of(kControlKind))),
          .output = static_cast<OutputKind>(number(heat_slot_of(kOutputKind))),
          .most_power = static_cast<std::uint8_t>(number(heat_slot_of(kMostPower))),
          .nominal_mv = static_cast<std::uint16_t>(number(heat_slot_of(kNominalSupply))),
          .nominal_mw = number(heat_slot_of(kNominalPower)),
          .model = {.rate_mc_per_s = number(heat_slot_of(kModelRate)),
                    .loss_ppm_per_s = number(heat_slot_of(kModelLoss)),
                    .lag_ms = number(heat_slot_of(kModelLag)),
                    .dead_ms = number(heat_slot_of(kModelDead))},
          .pid = {.band_mc = number(heat_slot_of(kProportionalBand)) * 100,
                  .integral_ms = number(heat_slot_of(kIntegralTime)) * 100,
                  .derivative_ms = number(heat_slot_of(kDerivativeTime)) * 100},
          .watch = {.limit_mc = static_cast<std::int32_t>(value(heat_slot_of(kLimit), n)) * kMcPerTenth,
                    .most_missing = static_cast<std::uint8_t>(number(heat_slot_of(kMostMissing))),
                    .most_unasked = static_cast<std::uint8_t>(number(heat_slot_of(kMostUnasked))),
                    .rise_s = static_cast<std::uint16_t>(number(heat_slot_of(kRiseTime)))}};
}

void HeatNode::apply_settings() {
  settings_changed_ = false;
  for (SensorInput& sensor : sensors_) sensor.clear(now_);
  sensors_changed_ = true;
  for (std::size_t i = 0; i < heaters_.size(); ++i) heaters_[i].configure(heater_settings(i));
  for (std::size_t i = 0; i < fans_.size(); ++i)
    fans_[i].configure({.function = static_cast<FanFunction>(value(heat_slot_of(kFanFunction), i)),
                        .heater = static_cast<std::uint8_t>(value(heat_slot_of(kFanHeater), i)),
                        .kick_ms = static_cast<std::uint16_t>(value(heat_slot_of(kFanKick), i)),
                        .least_duty = static_cast<std::uint8_t>(value(heat_slot_of(kFanLeast), i)),
                        .pulses_per_turn = static_cast<std::uint8_t>(value(heat_slot_of(kFanPulses), i))});
  pin_probe_.fit(value(heat_slot_of(kPinProbe)) != 0);
  for (std::size_t i = 0; i < filaments_.size(); ++i)
    filaments_[i].configure(
        {.kind = static_cast<FilamentKind>(value(heat_slot_of(kFilamentKind), i)),
         .inverted = value(heat_slot_of(kFilamentInverted), i) != 0,
         .um_per_edge = static_cast<std::uint32_t>(value(heat_slot_of(kFilamentPerEdge), i)),
         .stands_um = static_cast<std::uint32_t>(value(heat_slot_of(kFilamentStands), i)),
         .slips_um = static_cast<std::uint32_t>(value(heat_slot_of(kFilamentSlips), i)),
         .least_share = static_cast<std::uint8_t>(value(heat_slot_of(kFilamentLeast), i))});
}

// One table a call, and none with a frame: each takes a while on a chip that does more than this.
void HeatNode::configure_sensors() {
  for (std::size_t i = 0; i < sensors_.size(); ++i) {
    const SensorSetup setup = sensor_setup(i);
    if (sensors_[i].is(setup)) continue;
    static_cast<void>(sensors_[i].configure(setup, now_));  // on an error it measures nothing
    return;
  }
  sensors_changed_ = false;
}

int HeatNode::sensor_number(std::size_t heater) const {
  return static_cast<int>(value(heat_slot_of(kHeaterSensor), heater)) - 1;
}

const SensorInput* HeatNode::sensor_of(std::size_t heater) const {
  const int number = sensor_number(heater);
  if (number < 0) return nullptr;
  const SensorInput& sensor = sensors_[static_cast<std::size_t>(number)];
  return sensor.configured() ? &sensor : nullptr;
}

std::int32_t HeatNode::highest_set_point(std::size_t heater) const {
  const auto asked = static_cast<std::int32_t>(value(heat_slot_of(kHighestSetPoint), heater));
  const auto limit = static_cast<std::int32_t>(value(heat_slot_of(kLimit), heater));
  return std::max<std::int32_t>(0, std::min<std::int32_t>(asked, limit - kBelowLimit));
}

bool HeatNode::any_heat() const {
  return std::any_of(heaters_.begin(), heaters_.end(),
                     [](const Heater& heater) { return heater.target() != 0 || heater.tuning(); }) ||
         std::any_of(set_points_.begin(), set_points_.end(), [](std::int16_t set) { return set != 0; });
}

bool HeatNode::contactor() const {
  return std::none_of(heaters_.begin(), heaters_.end(),
                      [](const Heater& heater) { return heater.fault() == HeaterFault::kHeatUnasked; });
}

std::uint32_t HeatNode::heater_output(int heater) const {
  const auto n = static_cast<std::size_t>(heater);
  const SensorInput* sensor = sensor_of(n);
  return !confirmed_ || sensor == nullptr || !contactor() ? 0 : heaters_[n].output(*sensor);
}

void HeatNode::on_time(LocalTime now) {
  now_ = std::max(now_, now);
  for (SensorInput& sensor : sensors_) sensor.on_time(now_);
  // One that comes late is done once: what was missed is no time in which anything was commanded.
  if (now_ >= next_tick_) {
    next_tick_ += kControlTick;
    if (now_ >= next_tick_) next_tick_ = now_ + kControlTick;
    tick();
  }
  if (sensors_changed_) configure_sensors();
  serve();
}

void HeatNode::serve() {
  if (communication_changed_) apply_communication();
  if (settings_changed_) apply_settings();
  while (const auto problem = pdo_.next_problem())
    if (!emcy_.active(problem->emcy_code)) emcy_.raise(problem->emcy_code, {0, problem->rpdo, 0, 0, 0});
  serve_session();
  sdo_.on_time(now_);
  pdo_.on_time(now_);
}

void HeatNode::tick() {
  watch_master();
  apply_targets();
  for (std::size_t i = 0; i < heaters_.size(); ++i) {
    const SensorInput* sensor = sensor_of(i);
    if (sensor == nullptr) continue;
    const bool measured_supply = value(heat_slot_of(kNominalSupply), i) != 0;
    heaters_[i].step(*sensor, measured_supply ? supply_mv_ : 0);
    if (heaters_[i].fault() != HeaterFault::kNone) set_points_[i] = 0;
  }
  step_fans();
  take_tuning_result();
  tell_faults();
}

void HeatNode::step_fans() {
  fans_change_ = false;
  for (Fan& fan : fans_) {
    const std::size_t of = fan.settings().heater - 1u;
    const SensorInput* sensor = of < heaters_.size() ? sensor_of(of) : nullptr;
    const std::uint16_t was = fan.output();
    const bool faulty = sensor != nullptr && heaters_[of].fault() != HeaterFault::kNone;
    fan.step(now_, sensor == nullptr ? 0 : sensor->temperature(), faulty);
    fans_change_ = fans_change_ || fan.output() != was;
    // Without its fan a hot end melts what holds it.
    if (fan.stalled() && fan.settings().function == FanFunction::kHotEnd && sensor != nullptr)
      heaters_[of].trip(HeaterFault::kFan);
  }
}

void HeatNode::watch_master() {
  while (watched_.on_time(now_)) {
    nmt_.on_error(static_cast<std::uint8_t>(value(heat_slot_of(object::kErrorBehaviour))));
    pdo_.set_operational(nmt_.allows_pdo(), now_);
    if (nmt_.state() == NmtState::kStopped) switch_off();
  }
  const LocalTime patience{value(heat_slot_of(kMasterLost)) * 1'000'000};
  const bool lost = now_ - master_seen_ >= patience && (any_heat() || master_lost_);
  if (lost && !master_lost_) {
    lost_at_ = now_;
    for (std::size_t i = 0; i < heaters_.size(); ++i) {
      if (heaters_[i].tuning()) heaters_[i].trip(HeaterFault::kNone);
      feed_forward_[i] = 0;
      // Never warmer than it was asked to be.
      const auto safe = static_cast<std::int16_t>(value(heat_slot_of(kSafeSetPoint), i));
      set_points_[i] = std::min(set_points_[i], safe);
    }
  }
  master_lost_ = lost;
  const auto watched = watched_nodes();
  const bool missing = std::any_of(watched.begin(), watched.end(), [&](std::uint8_t id) {
    return watched_.health(id) == HeartbeatConsumer::Health::kLost;
  });
  if (!lost && !missing)
    emcy_.clear(emcy::kHeartbeat);
  else if (!emcy_.active(emcy::kHeartbeat))
    emcy_.raise(emcy::kHeartbeat);
}

void HeatNode::switch_off() {
  set_points_.fill(0);
  for (Heater& heater : heaters_)
    if (heater.tuning()) heater.trip(HeaterFault::kNone);
  apply_targets();
}

void HeatNode::apply_targets() {
  const std::chrono::milliseconds lead{value(heat_slot_of(kFlowLead))};
  for (std::size_t i = 0; i < heaters_.size(); ++i) {
    const std::chrono::seconds kept{value(heat_slot_of(kSafeTime), i)};
    if (master_lost_ && now_ - lost_at_ >= kept) set_points_[i] = 0;
    const std::int32_t wanted = std::min<std::int32_t>(set_points_[i], highest_set_point(i));
    const bool heats =
        on_[i] && contactor() && heaters_[i].fault() == HeaterFault::kNone && sensor_of(i) != nullptr;
    if (heaters_[i].tuning()) continue;
    heaters_[i].set_target(heats ? wanted * kMcPerTenth : 0);
    const bool fed = static_cast<std::int64_t>(i) + 1 == value(heat_slot_of(kFlowHeater));
    const std::int32_t taken = feed_forward_[i] * 10 + (fed ? flow_.power(now_ + lead) : 0);
    heaters_[i].set_feed_forward(heaters_[i].target() != 0 ? taken : 0,
                                 fed && flow_.told(now_) && !fans_change_);
  }
}

void HeatNode::take_tuning_result() {
  if (tuned_ < 0 || tuning_taken_ || tuning_.running()) return;
  tuning_taken_ = true;
  const auto n = static_cast<std::size_t>(tuned_);
  if (tuning_.state() != HeatTuning::State::kDone) return;
  const ModelParameters& found = tuning_.result();
  const PidParameters pid = pid_for(found);
  const auto tenths_of = [](std::uint32_t milli) { return std::min<std::int64_t>(milli / 100, 30'000); };
  set_value(heat_slot_of(kModelRate), n, found.rate_mc_per_s);
  set_value(heat_slot_of(kModelLoss), n, found.loss_ppm_per_s);
  set_value(heat_slot_of(kModelLag), n, found.lag_ms);
  set_value(heat_slot_of(kModelDead), n, found.dead_ms);
  set_value(heat_slot_of(kProportionalBand), n, std::max<std::int64_t>(tenths_of(pid.band_mc), 10));
  set_value(heat_slot_of(kIntegralTime), n, tenths_of(pid.integral_ms));
  set_value(heat_slot_of(kDerivativeTime), n, tenths_of(pid.derivative_ms));
  heaters_[n].configure(heater_settings(n));
}

// A code is told when a channel comes to it, and is over with its last one.
void HeatNode::tell_faults() {
  std::array<Places, static_cast<std::size_t>(HeaterFault::kLast) + 1> now{};
  const auto bit = [](std::size_t i) { return static_cast<std::uint8_t>(1u << i); };
  for (std::size_t i = 0; i < heaters_.size(); ++i)
    now[static_cast<std::size_t>(heaters_[i].fault())].heaters |= bit(i);
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    now[static_cast<std::size_t>(heater_fault(sensors_[i].fault()))].sensors |= bit(i);
  for (std::size_t i = 0; i < fans_.size(); ++i)
    if (fans_[i].stalled()) now[static_cast<std::size_t>(HeaterFault::kFan)].fans |= bit(i);
  for (std::size_t fault = 1; fault < now.size(); ++fault) {
    const std::uint16_t code = code_of(static_cast<HeaterFault>(fault));
    const Places is = now[fault], was = told_[fault];
    const auto fresh = [](std::uint8_t a, std::uint8_t b) { return static_cast<std::uint8_t>(a & ~b); };
    const Places news{fresh(is.heaters, was.heaters), fresh(is.sensors, was.sensors),
                      fresh(is.fans, was.fans)};
    // Byte 3 is 0: no stop on the path is asked for. Bytes 4 to 6: which channels, bit 0 the first.
    if ((news.heaters | news.sensors | news.fans) != 0)
      emcy_.raise(code, {0, news.heaters, news.sensors, news.fans, 0}, true);
    else if ((is.heaters | is.sensors | is.fans) == 0)
      emcy_.clear(code);
    told_[fault] = is;
  }
}

}  // namespace kinebus::heat
