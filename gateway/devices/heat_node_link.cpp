#include "gateway/devices/heat_node_link.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "protocol/bytes.hpp"
#include "protocol/canopen/alarm_table.hpp"
#include "protocol/canopen/cob_id.hpp"
#include "protocol/canopen/emcy.hpp"
#include "protocol/canopen/heartbeat.hpp"

namespace kinebus {
namespace {

using namespace heat_object;

/// A flow that is as it was is told again so often, and one that has changed after so long: a lost frame
/// counts for little, and the bus has other things to carry.
constexpr BusTime kFlowAgain = std::chrono::milliseconds{250};
constexpr BusTime kFlowNews = std::chrono::milliseconds{90};
constexpr BusTime kNoFlowAgain = std::chrono::seconds{1};
static_assert(std::tuple_size_v<FlowAhead> == kFlowSteps);
static_assert(kFlowAheadStep == std::chrono::milliseconds{kFlowStepMs});

/// Where the extruder is, is told so often while it turns.
constexpr BusTime kExtruderNews = std::chrono::milliseconds{90};

constexpr double kFullOutput = 32'767;  // 6411h

/// A pin that is tried twice with a reset between has said how that ended long before.
constexpr BusTime kPinTimeout = std::chrono::seconds{8};
/// Codes that say of a heater why it has no power.
bool is_of_a_heater(std::uint16_t code) {
  return code == emcy::kHeaterTooHot || (code >= emcy::kSensorOpen && code <= emcy::kFanStalled);
}

}  // namespace

// From the node
// ---------------------------------------------------------------------------------------------------

bool HeatNodeLink::on_frame(BusTime now, const CanFrame& frame) {
  if (frame.extended || frame.remote) return false;
  now_ = std::max(now_, now);
  if (frame.id == cob_id::kSdoReply + id_) {
    if (writing_ == Writing::kNothing) return false;
    sdo_.on_frame(now, frame);
    settle(now);
    return true;
  }
  if (const auto heartbeat = decode_heartbeat(frame); heartbeat && heartbeat->node == id_) {
    heard_ = now;
    // After a restart it has neither settings nor targets.
    if (heartbeat->state == NmtState::kInitialising) on_bring_up(now, false);
    return true;
  }
  if (frame.id == cob_id::kEmcy + id_) {
    on_emergency(frame);
    return true;
  }
  return on_report(now, frame);
}

bool HeatNodeLink::on_report(BusTime now, const CanFrame& frame) {
  const auto data = frame.bytes();
  const auto take = [&](std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      temperatures_[first + i] = static_cast<std::int16_t>(get_u16_le(data.subspan(2 * i)));
  };
  constexpr std::size_t kInOnePdo = 4, kInTheOther = kHeatSensors - kInOnePdo;
  if (frame.id == cob_id::tpdo(1, id_) && frame.length >= kHeaters) {
    on_states(data);
  } else if (frame.id == cob_id::tpdo(2, id_) && frame.length >= 2 * kInOnePdo) {
    take(0, kInOnePdo);
    measured_ = now;
  } else if (frame.id == cob_id::tpdo(4, id_) && frame.length >= 2 * kInTheOther) {
    take(kInOnePdo, kInTheOther);
  } else if (frame.id == cob_id::tpdo(3, id_) && frame.length >= 2 * kHeaters) {
    for (std::size_t n = 0; n < kHeaters; ++n)
      powers_[n] = static_cast<std::int16_t>(get_u16_le(data.subspan(2 * n)));
    powers_told_ = true;
  } else {
    return false;
  }
  heard_ = now;
  return true;
}

void HeatNodeLink::on_states(std::span<const std::uint8_t> states) {
  for (std::size_t n = 0; n < kHeaters; ++n) {
    states_[n] = static_cast<State>(states[n]);
    if (states_[n] != State::kFault) reasons_[n] = 0;
    // It may have been told a moment ago.
    const Value& set = set_points_[n];
    const bool should = serves_ && set.wanted != 0 && !set.due && now_ - set.told > kStateTimeout;
    lost_[n] = should && states_[n] == State::kOff;
  }
  constexpr std::size_t kFilaments = kHeaters + 1;  // the contactor is between them
  for (std::size_t n = 0; n < kFilamentSensors && kFilaments + n < states.size(); ++n)
    filaments_[n] = static_cast<FilamentCondition>(states[kFilaments + n]);
  constexpr std::size_t kPin = kFilaments + kFilamentSensors;
  if (kPin < states.size()) pin_.told = static_cast<PinTold>(states[kPin]);
}

void HeatNodeLink::on_emergency(const CanFrame& frame) {
  const auto emergency = decode_emcy(frame);
  if (!emergency || !is_of_a_heater(emergency->code)) return;
  for (std::size_t n = 0; n < kHeaters; ++n) {
    if ((emergency->vendor[1] >> n & 1) == 0) continue;
    reasons_[n] = emergency->code;
    states_[n] = State::kFault;
  }
}

std::optional<Sentence> HeatNodeLink::heater_fault(std::size_t heater) const {
  const Value& set = set_points_[heater];
  if (states_[heater] == State::kFault)
    return reasons_[heater] != 0 ? say(alarm_row(reasons_[heater]).words)
                                 : say("its node says that it is out of order");
  if (!serves_ || set.wanted == 0) return std::nullopt;
  if (set.refused != AbortCode::kNone)
    return say("its node refuses %1 C: %2", set.wanted / 10, text(set.refused));
  if (lost_[heater]) return say("its node has switched it off, and not by this gateway");
  // A node that says nothing at all is missed by its heartbeat.
  const bool heard = now_ - heard_ <= kTemperatureTimeout;
  if (heard && now_ - measured_ > kTemperatureTimeout) return say("its node tells no temperatures any more");
  return std::nullopt;
}

// To the node
// -----------------------------------------------------------------------------------------------------

void HeatNodeLink::set_target(std::size_t heater, double celsius) {
  if (tuning_.runs() && tuning_.heater() == heater) {
    tuning_.end(say("it was ended before it was done"));
    set_points_[heater].due = true;  // by that the node ends it
  }
  set_points_[heater].set(static_cast<std::int16_t>(std::lround(10 * celsius)));
  lost_[heater] = false;
}

void HeatNodeLink::set_output(std::size_t output, double ratio) {
  outputs_[output].set(static_cast<std::int16_t>(std::lround(kFullOutput * ratio)));
}

double HeatNodeLink::output(std::size_t output) const {
  return outputs_[output].wanted / kFullOutput;
}

HeaterStatus HeatNodeLink::status(std::size_t heater) const {
  HeaterStatus status{.actual_celsius = celsius(heater), .target_celsius = target(heater)};
  if (powers_told_ && serves_) status.power = powers_[heater] / 1000.0;
  if (serves_) status.measured = has_model_[heater];
  return status;
}

void HeatNodeLink::reset_fault(std::size_t heater) {
  if (states_[heater] == State::kFault) reset_due_[heater] = true;
  lost_[heater] = false;
  set_points_[heater].refused = AbortCode::kNone;
}

void HeatNodeLink::tune(std::size_t heater, double celsius, double power_w) {
  tuning_.begin(now_, heater, celsius, power_w);
}

HeaterTuning HeatNodeLink::tuning(std::size_t heater) const {
  return tuning_.heater() == heater ? tuning_.told() : HeaterTuning{};
}

void HeatNodeLink::feed_ahead(std::size_t heater, const FlowAhead& watts) {
  const auto number = static_cast<std::int16_t>(heater + 1);
  if (flow_heater_.wanted != number) flow_heater_.set(number);
  constexpr double kMost_w = 327;
  for (std::size_t i = 0; i < flow_.size(); ++i)
    flow_[i] = static_cast<std::int16_t>(std::lround(100 * std::clamp(watts[i], 0.0, kMost_w)));
}

void HeatNodeLink::follow_extruder(double mm) {
  extruder_um_ = static_cast<std::uint32_t>(std::llround(1000 * mm));
}

void HeatNodeLink::reset_filament(std::size_t sensor) {
  filament_due_[sensor] = filament_due_[sensor] || filaments_[sensor] != FilamentCondition::kInOrder;
}

void HeatNodeLink::move_pin(ContactProbe::PinOrder order) {
  pin_ = {.told = PinTold::kMoves, .order = order, .asked = true, .due = true, .since = now_};
}

ContactProbe::Pin HeatNodeLink::pin() const {
  using Pin = ContactProbe::Pin;
  if (!serves_ || pin_.refused != AbortCode::kNone) return Pin::kFailed;
  const bool settled = !pin_.due && writing_ != Writing::kPin;
  if (settled &&
      (pin_.told == PinTold::kNotOut || pin_.told == PinTold::kNotIn || pin_.told == PinTold::kAlarm))
    return Pin::kFailed;
  using Order = ContactProbe::PinOrder;
  const PinTold ends = pin_.order == Order::kOut    ? PinTold::kOut
                       : pin_.order == Order::kTest ? PinTold::kSelfTest
                                                    : PinTold::kIn;
  if (settled && pin_.told == ends)
    return ends == PinTold::kOut ? Pin::kOut : ends == PinTold::kIn ? Pin::kIn : Pin::kTests;
  return pin_.asked && now_ - pin_.since <= kPinTimeout ? Pin::kMoves : Pin::kFailed;
}

Sentence HeatNodeLink::pin_words() const {
  if (!serves_) return say("node %1, which moves the probe's pin, is not in operation", id_);
  if (pin_.refused != AbortCode::kNone)
    return say("node %1 refuses to move the probe's pin: %2", id_, text(pin_.refused));
  switch (pin_.told) {
    case PinTold::kNotOut:
      return say("the probe's pin has not come out");
    case PinTold::kNotIn:
      return say("the probe's pin has not gone in: look at it before anything moves");
    case PinTold::kAlarm:
      return say("the probe is in alarm, after a reset, too: look at its pin before anything moves");
    default:
      return say("node %1 does not say where the probe's pin is", id_);
  }
}

std::optional<CanFrame> HeatNodeLink::extruder_frame(BusTime now) {
  if (extruder_um_ == extruder_told_um_ || now - extruder_told_at_ < kExtruderNews) return std::nullopt;
  extruder_told_um_ = extruder_um_;
  extruder_told_at_ = now;
  CanFrame frame{.id = cob_id::rpdo(3, id_), .length = 4 * kFilamentSensors};
  for (std::size_t i = 0; i < kFilamentSensors; ++i)
    put_u32_le(std::span(frame.data).subspan(4 * i), extruder_um_);
  return frame;
}

std::optional<CanFrame> HeatNodeLink::flow_frame(BusTime now) {
  // It would be taken for another heater's.
  if (several_melt_ && (flow_heater_.due || flow_heater_.refused != AbortCode::kNone)) return std::nullopt;
  const bool flows = flow_ != Flow{};
  const BusTime since = now - flow_told_at_;
  const bool again = since >= (flows ? kFlowAgain : kNoFlowAgain) && (flows || all_fans_);
  if (!(flow_ != flow_told_ && since >= kFlowNews) && !again) return std::nullopt;
  flow_told_ = flow_;
  flow_told_at_ = now;
  CanFrame frame{.id = cob_id::rpdo(4, id_), .length = 8};
  for (std::size_t i = 0; i < flow_.size(); ++i)
    put_u16_le(std::span(frame.data).subspan(2 * i), static_cast<std::uint16_t>(flow_[i]));
  return frame;
}

std::optional<Sentence> HeatNodeLink::absent() const {
  if (serves_) return std::nullopt;
  return say("node %1, which heats it, is not in operation: bring the machine up first", id_);
}

void HeatNodeLink::on_bring_up(BusTime now, bool done) {
  if (writing_ != Writing::kNothing && sdo_.status() == SdoClient::Status::kBusy) sdo_.cancel();
  writing_ = Writing::kNothing;
  serves_ = done;
  reset_due_.fill(false);
  model_due_.fill(done);
  has_model_.fill(Measured::kNotTold);
  filaments_.fill(FilamentCondition::kInOrder);
  filament_due_.fill(false);
  lost_.fill(false);
  pin_ = {};
  tuning_.end(say("its node was not in operation any more: measure it again"));
  vibration_.fail(say("its node was not in operation any more: measure it again"));
  if (!done) return;
  heard_ = measured_ = now_ = std::max(now_, now);
  for (Value& set : set_points_) set.due = true;
  for (Value& output : outputs_) output.due = true;
  flow_heater_.due = true;
  for (std::size_t n = 0; n < kHeaters; ++n) reset_fault(n);
}

void HeatNodeLink::on_time(BusTime now) {
  now_ = std::max(now_, now);
  if (writing_ == Writing::kNothing) return;
  sdo_.on_time(now);
  settle(now);
}

std::optional<CanFrame> HeatNodeLink::next_frame(BusTime now) {
  if (!serves_) return std::nullopt;
  if (const auto frame = flow_frame(now)) return frame;
  if (const auto frame = extruder_frame(now)) return frame;
  if (writing_ == Writing::kNothing) begin_next(now);
  return sdo_.next_frame();
}

}  // namespace kinebus
