#include "node_firmware/step/tmc2209.hpp"

#include <bit>

namespace kinebus::tmc2209 {

void Driver::set(const Settings& settings) {
  if (settings == settings_) return;
  settings_ = settings;
  const auto wanted = registers_of(settings);
  for (std::size_t i = 0; i < kRegisters; ++i)
    if (wanted[i].value != wanted_[i].value) pending_ |= 1u << i, written_ &= ~(1u << i);
  wanted_ = wanted;
  if (pending_ == 0 || state_ == State::kSilent || state_ == State::kStandsAlone) return;
  if (phase_ >= kAsk) begin(kCount);
  if (state_ == State::kConfigured) state_ = State::kChanging;
}

void Driver::set_spoken_to(bool spoken_to) {
  if (spoken_to == (state_ != State::kStandsAlone)) return;
  state_ = spoken_to ? State::kUnasked : State::kStandsAlone;
  failures_ = 0;
  status_ = 0;
  charge_pump_low_ = false;
  acknowledge();
  write_all();
}

void Driver::write_all() {
  pending_ = (1u << kRegisters) - 1;
  written_ = 0;
  configured_ = false;
  begin(kIdentify);
}

std::optional<Datagram> Driver::next(LocalTime now) {
  if (state_ == State::kStandsAlone) return std::nullopt;
  if ((state_ == State::kSilent || phase_ == kAsk) && now < due_) return std::nullopt;
  now_ = now;
  asked_ = phase_;
  switch (phase_) {
    case kIdentify:
      return read_of(reg::kIoin);
    case kCount:
    case kVerify:
      return read_of(reg::kIfcnt);
    case kWriteNext:
      place_ = static_cast<std::size_t>(std::countr_zero(pending_ & ~written_));
      said_ = wanted_[place_].value;
      return write_of(wanted_[place_].address, said_);
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

void Driver::on_said() {
  if (asked_ != kWriteNext || phase_ != asked_) return;
  ++writes_;
  // Another value is wanted by now, perhaps.
  if (wanted_[place_].value == said_) written_ |= 1u << place_;
  if ((pending_ & ~written_) == 0) begin(kVerify);
}

void Driver::on_answer(std::uint32_t value) {
  if (phase_ != asked_) return;  // it was told other things in the meantime
  if (phase_ == kIdentify && value >> 24 != kVersion) return on_failure();  // another chip: as if none
  switch (phase_) {
    case kIdentify:
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
        state_ = State::kConfigured;
      }
      break;
    case kAsk:
      charge_pump_low_ = (value & gstat::kChargePumpLow) != 0;
      error_seen_ = (value & gstat::kDriverError) != 0;
      begin(kAskStatus);
      if ((value & gstat::kReset) != 0) {
        lost_settings_ = true;
        state_ = State::kChanging;
        write_all();
      } else if ((value & gstat::kDriverError) != 0) {
        pending_ |= 1u << (kRegisters - 1);  // what it has kept is known now
      }
      break;
    case kAskStatus: {
      status_ = value;
      driver_error_ = driver_error_ || error_seen_;  // now that it is known why
      error_seen_ = false;
      const bool told = slow_motion_ && (value & drv_status::kStandstill) == 0;
      if (!told || (value & drv_status::kOpenLoad) == 0)
        open_looks_ = open_load() ? open_looks_ : std::uint8_t{0};
      else if (!open_load())
        ++open_looks_;
      begin(pending_ != 0 ? kCount : settings_.homing && settings_.stall_threshold != 0 ? kAskLoad : kAsk);
      break;
    }
    case kAskLoad:
      stall_guard_ = static_cast<std::uint16_t>(value & 0x3FF);
      begin(kAsk);
      break;
    default:
      return;
  }
  failures_ = 0;
}

void Driver::on_failure() {
  if (phase_ == kWriteNext || phase_ == kVerify) begin(kCount);
  written_ = 0;
  if (state_ == State::kSilent || ++failures_ >= kTries) {
    state_ = State::kSilent;
    due_ = now_ + kLookAgain;
    // What it has now nobody knows.
    status_ = 0;
    write_all();
  }
}

}  // namespace kinebus::tmc2209
