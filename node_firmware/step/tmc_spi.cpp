#include "node_firmware/step/tmc_spi.hpp"

#include <algorithm>
#include <bit>

namespace kinebus::tmc_spi {

using step::DriverState;

void Driver::set(const step::DriverSettings& settings) {
  if (settings == settings_) return;
  const step::DriverSettings old = settings_;
  settings_ = settings;
  if (chip_ == nullptr) return;
  const Registers before = chip_->registers_of(old), now = wanted();
  for (std::size_t i = 0; i < now.count; ++i)
    if (now.all[i].value != before.all[i].value) pending_ |= 1u << i, written_ &= ~(1u << i);
  if (pending_ == 0 || state_ == DriverState::kSilent) return;
  if (phase_ >= kAsk) phase_ = kWriteNext;
  if (state_ == DriverState::kConfigured) state_ = DriverState::kChanging;
}

void Driver::write_all() {
  pending_ = chip_ != nullptr ? (1u << wanted().count) - 1 : 0;
  written_ = 0;
  configured_ = false;
  phase_ = kFind;
  before_ = kNothing;
}

std::optional<step::Exchange> Driver::next(LocalTime now) {
  if (rests(now) || (phase_ == kAsk && now < due_)) return std::nullopt;
  now_ = now;
  asked_ = phase_;
  if (phase_ == kAsk) due_ = now + kRound;
  const Datagram said = datagram();
  step::Exchange exchange{.bus = step::DriverBus::kSpi, .length = kDatagramBytes, .hears = kDatagramBytes};
  std::ranges::copy(said, exchange.bytes.begin());
  return exchange;
}

Datagram Driver::datagram() {
  switch (phase_) {
    case kClear:
      return chip_->clears_by_write ? write_of(reg::kGstat, gstat::kAll) : read_of(reg::kGstat);
    case kWriteNext: {
      place_ = static_cast<std::uint8_t>(std::countr_zero(pending_ & ~written_));
      const Register next = wanted().all[place_];
      said_ = next.value;
      return write_of(next.address, said_);
    }
    case kAsk:
      return read_of(reg::kGstat);
    case kAskStatus:
    case kAskStatusAgain:
      return read_of(reg::kDrvStatus);
    case kAskChopper:
      return read_of(reg::kChopconf);
    case kNothing:
    case kFind:
    case kFindAgain:
    case kAskVersion:
    case kEnd:
      break;
  }
  return read_of(reg::kIoin);
}

void Driver::on_heard(std::span<const std::uint8_t> bytes) {
  const std::optional<Answer> answer = answer_of(bytes);
  if (!answer || !take(*answer)) return on_failure();
  before_ = asked_;
  place_before_ = place_;
  said_before_ = said_;
  // It was told other things in the meantime.
  if (phase_ == asked_) go_on();
}

// To what the datagram before has asked. False: that is no answer to it.
bool Driver::take(const Answer& answer) {
  if (before_ >= kAsk && (answer.status & spi_status::kReset) != 0) reset_seen_ = true;
  switch (before_) {
    case kNothing:
    case kClear:
      return true;
    case kFind:
    case kFindAgain:
    case kAskVersion:
    case kEnd:
      return take_version(answer.value);
    case kWriteNext:
      if (answer.value != said_before_) return false;
      // Another value is wanted by now, perhaps.
      if (wanted().all[place_before_].value == said_before_) pending_ &= ~(1u << place_before_);
      if (pending_ == 0) configured_now();
      return true;
    case kAsk:
      gstat_ = answer.value;
      return (answer.value & ~gstat::kAll) == 0;
    case kAskStatus:
      seen_ = answer.value;
      return true;
    case kAskStatusAgain:
      return ((answer.value ^ seen_) & kSteady) == 0;
    case kAskChopper: {
      const Registers wanted = this->wanted();
      const bool changes = (pending_ >> (wanted.count - 1u) & 1) != 0;
      chopper_lost_ = answer.value != wanted.chopper().value && !changes;
      // Only a chip that began anew may have lost it.
      return !chopper_lost_ || reset_seen_ || (gstat_ & gstat::kReset) != 0;
    }
  }
  return false;
}

bool Driver::take_version(std::uint32_t ioin) {
  const Chip* chip = chip_of(static_cast<std::uint8_t>(ioin >> 24));
  if (chip == nullptr || (chip_ != nullptr && chip != chip_)) return false;
  if (chip_ == nullptr) {
    chip_ = chip;
    pending_ = (1u << wanted().count) - 1;
  }
  return true;
}

void Driver::configured_now() {
  written_ = 0;
  failures_ = 0;
  configured_ = true;
  state_ = DriverState::kConfigured;
}

void Driver::go_on() {
  switch (asked_) {
    case kFindAgain:
      // What GSTAT has kept of what was before the settings is of no account; after them it is read.
      phase_ = configured_ ? after_clear() : kClear;
      break;
    case kClear:
      phase_ = after_clear();
      break;
    case kWriteNext:
      written_ |= 1u << place_;
      phase_ = after_clear();
      break;
    case kEnd:
      end_look();
      break;
    case kNothing:
    case kFind:
    case kAsk:
    case kAskStatus:
    case kAskStatusAgain:
    case kAskChopper:
    case kAskVersion:
      phase_ = static_cast<Phase>(asked_ + 1);
      break;
  }
  if (phase_ == kAsk && asked_ != kEnd) due_ = now_;  // its answer is that to the last write
}

void Driver::end_look() {
  failures_ = 0;
  charge_pump_low_ = (gstat_ & gstat::kChargePumpLow) != 0;
  driver_error_ = driver_error_ || (gstat_ & gstat::kDriverError) != 0;
  look_at(seen_, step::findings_of(seen_, chip_->status));
  if (settings_.homing && settings_.stall_threshold != 0)
    stall_guard_ = static_cast<std::uint16_t>(seen_ & drv_status::kStallGuard);
  phase_ = gstat_ != 0 ? kClear : after_clear();
  // A bit of a status byte alone is no proof.
  const bool was_reset = (gstat_ & gstat::kReset) != 0 || (reset_seen_ && chopper_lost_);
  reset_seen_ = false;
  if (!was_reset) return;
  lost_settings_ = true;
  state_ = DriverState::kChanging;
  write_all();
}

void Driver::on_failure() {
  phase_ = kFind;
  before_ = kNothing;
  written_ = 0;
  if (state_ != DriverState::kSilent && ++failures_ < kTries) return;
  state_ = DriverState::kSilent;
  due_ = now_ + kLookAgain;
  forget_status();
  write_all();
}

}  // namespace kinebus::tmc_spi
