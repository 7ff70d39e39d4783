#include "node_firmware/step/tmc2209.hpp"

#include <algorithm>
#include <bit>

namespace kinebus::tmc2209 {

using step::DriverState;

void Driver::set(const step::DriverSettings& settings) {
  if (settings == settings_) return;
  const auto before = registers_of(settings_), wanted = registers_of(settings);
  settings_ = settings;
  for (std::size_t i = 0; i < kRegisters; ++i)
    if (wanted[i].value != before[i].value) pending_ |= 1u << i, written_ &= ~(1u << i);
  if (pending_ == 0 || state_ == DriverState::kSilent) return;
  if (phase_ >= kAsk) begin(kCount);
  if (state_ == DriverState::kConfigured) state_ = DriverState::kChanging;
}

void Driver::write_all() {
  pending_ = (1u << kRegisters) - 1;
  written_ = 0;
  configured_ = false;
  begin(kIdentify);
}

std::optional<Datagram> Driver::datagram(LocalTime now) {
  if (rests(now) || (phase_ == kAsk && now < due_)) return std::nullopt;
  now_ = now;
  asked_ = phase_;
  switch (phase_) {
    case kIdentify:
      return read_of(reg::kIoin);
    case kCount:
    case kVerify:
      return read_of(reg::kIfcnt);
    case kWriteNext: {
      place_ = static_cast<std::size_t>(std::countr_zero(pending_ & ~written_));
      const Register wanted = registers_of(settings_)[place_];
      said_ = wanted.value;
      return write_of(wanted.address, said_);
    }
    case kAsk:
      due_ = now + kRound;
      return read_of(reg::kGstat);
    case kAskStatus:
      return read_of(reg::kDrvStatus);
    case kAskLoad:
      return read_of(reg::kSgResult);
  }
  return std::nullopt;
}

std::optional<step::Exchange> Driver::next(LocalTime now) {
  const std::optional<Datagram> said = datagram(now);
  if (!said) return std::nullopt;
  under_way_ = *said;
  const std::size_t hears = said->length + (said->read ? kValueBytes : 0);
  static_assert(kRequestBytes + kValueBytes <= step::kMostHeard);
  return step::Exchange{
      .bytes = said->bytes, .length = said->length, .hears = static_cast<std::uint8_t>(hears)};
}

void Driver::on_heard(std::span<const std::uint8_t> bytes) {
  const std::span<const std::uint8_t> said = under_way_.said();
  if (bytes.size() < said.size() || !std::ranges::equal(bytes.first(said.size()), said)) return on_failure();
  if (!under_way_.read) return on_said();
  const auto value = answer_of(bytes.subspan(said.size()), under_way_.address());
  value ? on_answer(*value) : on_failure();
}

void Driver::on_said() {
  if (asked_ != kWriteNext || phase_ != asked_) return;
  ++writes_;
  // Another value is wanted by now, perhaps.
  if (registers_of(settings_)[place_].value == said_) written_ |= 1u << place_;
  if ((pending_ & ~written_) == 0) begin(kVerify);
}

void Driver::on_answer(std::uint32_t value) {
  if (phase_ != asked_) return;  // it was told other things in the meantime
  if (phase_ == kIdentify && value >> 24 != kVersion) return on_failure();  // another chip: as if none
  switch (phase_) {
    case kIdentify:
      found_ = true;
      begin(kCount);
      break;
    case kCount:
      count_ = static_cast<std::uint8_t>(value);
      written_ = 0;
      writes_ = 0;
      begin(pending_ != 0 ? kWriteNext : kAsk);
      return;  // not yet a proof that anything arrives
    case kVerify:
      // Anything but so many more, as by a write that was garbled: all of them once more.
      if (static_cast<std::uint8_t>(value - count_) != writes_) return on_failure();
      pending_ &= ~written_;
      written_ = 0;
      begin(pending_ != 0 ? kCount : kAsk);
      if (pending_ == 0) {
        configured_ = true;
        state_ = DriverState::kConfigured;
      }
      break;
    case kAsk:
      on_gstat(value);
      break;
    case kAskStatus:
      look_at(value, step::findings_of(value, kStatusBits));
      driver_error_ = driver_error_ || error_seen_;  // now that it is known why
      error_seen_ = false;
      begin(pending_ != 0 ? kCount : settings_.homing && settings_.stall_threshold != 0 ? kAskLoad : kAsk);
      break;
    case kAskLoad:
      stall_guard_ = static_cast<std::uint16_t>(value & 0x3FF);
      begin(kAsk);
      break;
    default:
      return;
  }
  failures_ = 0;
}

void Driver::on_gstat(std::uint32_t value) {
  charge_pump_low_ = (value & gstat::kChargePumpLow) != 0;
  error_seen_ = (value & gstat::kDriverError) != 0;
  begin(kAskStatus);
  if ((value & gstat::kReset) != 0) {
    lost_settings_ = true;
    state_ = DriverState::kChanging;
    write_all();
  } else if ((value & gstat::kDriverError) != 0) {
    pending_ |= 1u << (kRegisters - 1);  // what it has kept is known now
  }
}

void Driver::on_failure() {
  if (phase_ == kWriteNext || phase_ == kVerify) begin(kCount);
  written_ = 0;
  if (state_ == DriverState::kSilent || ++failures_ >= kTries) {
    state_ = DriverState::kSilent;
    due_ = now_ + kLookAgain;
    forget_status();
    write_all();
  }
}

}  // namespace kinebus::tmc2209
