// What is written to a heat node, one after the other, and what it answers.

#include <algorithm>
#include <utility>

#include "gateway/devices/heat_node_link.hpp"
#include "protocol/bytes.hpp"

namespace kinebus {
namespace {

using namespace heat_object;

/// Of 2261h, by PinOrder.
constexpr std::array<std::int16_t, 4> kPinCommands{1, 2, 3, 4};

}  // namespace

bool HeatNodeLink::begin(BusTime now, Writing what, std::size_t n, ObjectAddress first, std::int16_t value,
                         int bytes) {
  const ObjectAddress address{first.index, static_cast<std::uint8_t>(first.subindex + n)};
  put_u16_le(bytes_, static_cast<std::uint16_t>(value));
  if (!sdo_.download(now, id_, address, std::span(bytes_).first(static_cast<std::size_t>(bytes))))
    return false;
  writing_ = what;
  channel_ = n;
  written_ = value;
  return true;
}

/// What takes heat away goes first.
void HeatNodeLink::begin_next(BusTime now) {
  for (const bool off : {true, false})
    for (std::size_t n = 0; n < kHeaters; ++n) {
      const Value& set = set_points_[n];
      if (!off && reset_due_[n]) {
        begin(now, Writing::kReset, n, kFaultReset, 1, 1);
        return;
      }
      if (set.due && (set.wanted == 0) == off) {
        begin(now, Writing::kSetPoint, n, kSetPoint, set.wanted, 2);
        return;
      }
    }
  if (several_melt_ && flow_heater_.due) {
    begin(now, Writing::kFlowHeater, 0, kFlowHeater, flow_heater_.wanted, 1);
    return;
  }
  for (std::size_t n = 0; n < kFans; ++n)
    if (outputs_[n].due) {
      begin(now, Writing::kOutput, n, kFanOutput, outputs_[n].wanted, 2);
      return;
    }
  for (std::size_t n = 0; n < kFilamentSensors; ++n)
    if (filament_due_[n]) {
      begin(now, Writing::kFilament, n, kFilamentReset, 1, 1);
      return;
    }
  if (pin_.due &&
      begin(now, Writing::kPin, 0, kPinCommand, kPinCommands[static_cast<std::size_t>(pin_.order)], 1)) {
    pin_.due = false;
    return;
  }
  for (std::size_t n = 0; n < kHeaters; ++n)
    if (model_due_[n]) {
      const ObjectAddress rate{kModelRate.index, static_cast<std::uint8_t>(kModelRate.subindex + n)};
      if (!sdo_.upload(now, id_, rate, std::span(bytes_))) return;
      writing_ = Writing::kModel;
      channel_ = n;
      return;
    }
  if (ask(now, tuning_.next(now)))
    writing_ = Writing::kTuning;
  else if (ask(now, vibration_.next(now)))
    writing_ = Writing::kVibration;
}

bool HeatNodeLink::ask(BusTime now, const std::optional<HeatNodeTuning::Question>& question) {
  if (!question) return false;
  const auto bytes = std::span(bytes_).first(question->bytes);
  if (!question->write) return sdo_.upload(now, id_, question->address, bytes);
  put_u32_le(bytes_, question->value);
  return sdo_.download(now, id_, question->address, bytes);
}

void HeatNodeLink::settle(BusTime now) {
  if (sdo_.status() == SdoClient::Status::kBusy) return;
  const Writing what = std::exchange(writing_, Writing::kNothing);
  const bool failed = sdo_.status() == SdoClient::Status::kFailed;
  if (what == Writing::kTuning || what == Writing::kVibration) {
    const std::uint32_t value =
        failed ? 0 : static_cast<std::uint32_t>(get_le(bytes_, std::min(sdo_.received(), bytes_.size())));
    const AbortCode code = failed ? sdo_.abort_code() : AbortCode::kNone;
    if (what == Writing::kVibration) return vibration_.on_answer(now, code, value);
    tuning_.on_answer(now, code, value);
    if (tuning_.told().stage >= TuningStage::kKeeps && tuning_.told().stage != TuningStage::kFailed)
      has_model_[tuning_.heater()] = Measured::kYes;
    return;
  }
  // No answer, or a disturbed one: again. A node that is gone is missed by its heartbeat.
  const AbortCode code = failed ? sdo_.abort_code() : AbortCode::kNone;
  if (code == AbortCode::kTimeout || code == AbortCode::kToggleBit || code == AbortCode::kCommandSpecifier) {
    if (what == Writing::kPin) pin_.due = true;
    return;
  }
  if (what == Writing::kPin) {
    if (!pin_.due) pin_.refused = code;
    return;
  }
  if (what == Writing::kModel) {
    model_due_[channel_] = false;
    if (failed) return;
    const bool any = get_le(bytes_, std::min(sdo_.received(), bytes_.size())) != 0;
    has_model_[channel_] = any ? Measured::kYes : Measured::kNotYet;
    return;
  }
  if (what == Writing::kReset) {
    reset_due_[channel_] = false;
    return;
  }
  if (what == Writing::kFilament) {
    filament_due_[channel_] = false;
    return;
  }
  Value& value = what == Writing::kSetPoint     ? set_points_[channel_]
                 : what == Writing::kFlowHeater ? flow_heater_
                                                : outputs_[channel_];
  if (value.wanted != written_) return;  // it is to be another by now
  value.due = false;
  value.told = now;
  value.refused = code;
}

}  // namespace kinebus
