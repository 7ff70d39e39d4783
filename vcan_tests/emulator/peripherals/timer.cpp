#include "vcan_tests/emulator/peripherals/timer.hpp"

#include <algorithm>

namespace kinebus::emulator {
namespace {
constexpr std::uint32_t kEnable = 1, kUpdateDisable = 2, kUpdateRequestSource = 4, kOnePulse = 8,
                        kPreload = 0x80;
constexpr std::uint32_t kUpdateFlag = 1, kBreakFlag = 0x80;
constexpr std::uint32_t kBreakEnable = 1u << 12, kBreakHigh = 1u << 13, kAutomatic = 1u << 14,
                        kMainOutput = 1u << 15;
}  // namespace

void Timer::reset(Cycle now) {
  if (before_change) before_change(now);
  cr1_ = cr2_ = smcr_ = dier_ = sr_ = ccer_ = psc_ = rcr_ = bdtr_ = 0;
  arr_ = arr_in_force_ = setup_.advanced ? 0xFFFF : 0xFFFFFFFF;
  ccmr_ = {};
  ccr_ = ccr_in_force_ = {};
  psc_in_force_ = repetitions_left_ = frozen_count_ = 0;
  forced_high_ = false;
  find_next_event();
  update_lines();
  look_at_output(now);
}

Cycle Timer::sweep_length() const {
  const Cycle ticks = centre_aligned()
                          ? Cycle{arr_in_force_} - (up_ ? count_at_begin_ : arr_in_force_ - count_at_begin_)
                          : Cycle{arr_in_force_} + 1 - count_at_begin_;
  return ticks * tick();
}

void Timer::begin_sweep(Cycle at, bool up) {
  sweep_begin_ = at;
  up_ = up;
  count_at_begin_ = up ? 0 : arr_in_force_;
  compared_ = {};
}

// When the count upwards comes to the compare value in this sweep, and asks for a word then.
Cycle Timer::compare_at(std::size_t channel) const {
  const std::uint32_t value = ccr_in_force_[channel];
  if (compared_[channel] || (dier_ >> (9 + channel) & 1) == 0 || value < count_at_begin_ ||
      value > arr_in_force_)
    return kNever;
  return sweep_begin_ + (value - count_at_begin_) * tick();
}

Cycle Timer::next_compare() const {
  Cycle next = kNever;
  for (std::size_t i = 0; i < 4; ++i) next = std::min(next, compare_at(i));
  return next;
}

void Timer::serve_compares(Cycle now) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Cycle at = compare_at(i);
    if (at > now) continue;
    compared_[i] = true;
    if (on_request) on_request(static_cast<int>(i) + 1, at);
  }
}

std::uint32_t Timer::count(Cycle now) const {
  if (!running()) return frozen_count_;
  const auto ticks = static_cast<std::uint32_t>((now - sweep_begin_) / tick());
  return up_ ? count_at_begin_ + ticks : count_at_begin_ - ticks;
}

void Timer::find_next_event() {
  next_event_ = kNever;
  if (!running() || arr_in_force_ == 0) return;
  next_event_ = sweep_begin_ + sweep_length();
  if (requests()) next_event_ = std::min(next_event_, next_compare());
}

void Timer::advance(Cycle now) {
  if (now < next_event_) return;
  while (running() && arr_in_force_ != 0 && sweep_begin_ + sweep_length() <= now) {
    const Cycle end = sweep_begin_ + sweep_length();
    if (requests()) serve_compares(end);
    if (before_change) before_change(end);
    const bool next_up = !centre_aligned() || !up_;
    if (repetitions_left_ == 0)
      update_event(end, true);
    else
      --repetitions_left_;
    begin_sweep(end, next_up);
    if ((cr1_ & kOnePulse) != 0) {
      cr1_ &= ~kEnable;
      frozen_count_ = 0;
    }
  }
  if (running() && requests()) serve_compares(now);
  find_next_event();
}

void Timer::update_event(Cycle now, bool sets_flag) {
  if ((cr1_ & kUpdateDisable) != 0) return;
  psc_in_force_ = psc_;
  arr_in_force_ = arr_;
  ccr_in_force_ = ccr_;
  repetitions_left_ = rcr_ & 0xFF;
  if ((bdtr_ & kAutomatic) != 0 && !break_active()) bdtr_ |= kMainOutput;
  look_at_output(now);
  if (sets_flag) {
    sr_ |= kUpdateFlag;
    update_lines();
    if ((dier_ >> 8 & 1) != 0 && on_request) on_request(0, now);
  }
  if ((cr2_ >> 4 & 7) == 2 && on_trigger) on_trigger(now);
}

void Timer::update_lines() {
  if (setup_.update_irq >= 0) lines_.set_line(setup_.update_irq, (sr_ & dier_ & kUpdateFlag) != 0);
  if (setup_.break_irq >= 0) lines_.set_line(setup_.break_irq, (sr_ & dier_ & kBreakFlag) != 0);
}

bool Timer::output_high() const {
  const bool on = (ccer_ & 1) != 0 && (!setup_.advanced || (bdtr_ & kMainOutput) != 0);
  return on && forced_high_ != ((ccer_ & 2) != 0);
}

void Timer::look_at_output(Cycle now) {
  if (output_high() == was_high_) return;
  was_high_ = !was_high_;
  if (on_output) on_output(now);
}

bool Timer::break_active() const {
  return (bdtr_ & kBreakEnable) != 0 && break_high_ == ((bdtr_ & kBreakHigh) != 0);
}

void Timer::trip(Cycle now) {
  if (before_change) before_change(now);
  bdtr_ &= ~kMainOutput;
  sr_ |= kBreakFlag;
  update_lines();
  look_at_output(now);
}

void Timer::set_break_level(bool high, Cycle now) {
  break_high_ = high;
  if (break_active() && ((bdtr_ & kMainOutput) != 0 || (sr_ & kBreakFlag) == 0)) trip(now);
}

Timer::Sweep Timer::sweep() const {
  Sweep s;
  s.begin = sweep_begin_;
  s.end = running() ? sweep_begin_ + sweep_length() : kNever;
  s.up = up_;
  s.compare = ccr_in_force_;
  s.main_output = (bdtr_ & kMainOutput) != 0;
  for (unsigned i = 0; i < 4; ++i)
    s.enabled[i] = (ccer_ >> (4 * i) & 1) != 0 && (ccmr_[i / 2] >> (8 * (i % 2) + 4) & 7) == 6;
  return s;
}

std::uint32_t Timer::read(std::uint32_t offset, Cycle now) {
  switch (offset) {
    case 0x00:
      return cr1_ | (up_ ? 0 : 0x10);
    case 0x04:
      return cr2_;
    case 0x08:
      return smcr_;
    case 0x0C:
      return dier_;
    case 0x10:
      return sr_;
    case 0x18:
      return ccmr_[0];
    case 0x1C:
      return ccmr_[1];
    case 0x20:
      return ccer_;
    case 0x24:
      advance(now);
      return count(now);
    case 0x28:
      return psc_;
    case 0x2C:
      return arr_;
    case 0x30:
      return rcr_;
    case 0x34:
    case 0x38:
    case 0x3C:
    case 0x40:
      return ccr_[(offset - 0x34) / 4];
    case 0x44:
      return bdtr_;
    default:
      return 0;
  }
}

void Timer::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  advance(now);
  switch (offset) {
    case 0x00: {
      if (before_change) before_change(now);
      const bool was = running();
      const std::uint32_t at = count(now);
      cr1_ = value & 0x3FF;
      if (running() && !was) {
        begin_sweep(now, (value & 0x10) == 0 || centre_aligned());
        count_at_begin_ = frozen_count_;
      } else if (!running() && was) {
        frozen_count_ = at;
      }
      break;
    }
    case 0x04:
      cr2_ = value;
      break;
    case 0x08:
      smcr_ = value;
      break;
    case 0x0C:
      dier_ = value;
      break;
    case 0x10:
      sr_ &= value;
      break;  // cleared by writing zeros
    case 0x14:
      if ((value & 1) != 0) {
        if (before_change) before_change(now);
        update_event(now, (cr1_ & kUpdateRequestSource) == 0);
        frozen_count_ = 0;
        begin_sweep(now, true);
      }
      if ((value & 0x80) != 0) trip(now);
      break;
    case 0x18: {
      ccmr_[0] = value;
      // An output, and its mode is not kept back for a commutation, which does not come here.
      const std::uint32_t mode = value >> 4 & 0x1007;
      const bool at_once = (value & 3) == 0 && (cr2_ & 1) == 0;
      if (at_once && (mode == 4 || mode == 5)) forced_high_ = mode == 5;
      break;
    }
    case 0x1C:
      ccmr_[1] = value;
      break;
    case 0x20:
      if (before_change) before_change(now);
      ccer_ = value;
      break;
    case 0x24:
      if (before_change) before_change(now);
      if (running()) {
        begin_sweep(now, up_);
        count_at_begin_ = value;
      } else {
        frozen_count_ = value;
      }
      break;
    case 0x28:
      psc_ = value & 0xFFFF;
      break;
    case 0x2C:
      arr_ = value;
      if ((cr1_ & kPreload) == 0) arr_in_force_ = value;
      break;
    case 0x30:
      rcr_ = value;
      break;
    case 0x34:
    case 0x38:
    case 0x3C:
    case 0x40: {
      const std::uint32_t i = (offset - 0x34) / 4;
      ccr_[i] = value;
      if ((ccmr_[i / 2] >> (8 * (i % 2) + 3) & 1) == 0) {
        if (before_change) before_change(now);
        ccr_in_force_[i] = value;
      }
      break;
    }
    case 0x44:
      if (before_change) before_change(now);
      bdtr_ = value & 0xFFFF;
      if (break_active()) trip(now);  // no way to switch on while it lasts
      break;
    default:
      return;
  }
  find_next_event();
  update_lines();
  look_at_output(now);
}

}  // namespace kinebus::emulator
