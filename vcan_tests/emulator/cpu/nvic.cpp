#include "vcan_tests/emulator/cpu/nvic.hpp"

#include <algorithm>
#include <cassert>

namespace kinebus::emulator {
namespace {

constexpr std::size_t at(int exception) {
  return static_cast<std::size_t>(exception);
}

// Of what a Cortex-M4 has, not in a Cortex-M0+.
constexpr bool missing_in_small(std::uint32_t offset) {
  const bool timer = offset >= 0xE010 && offset < 0xE020;
  const bool interrupts = offset == 0xE100 || offset == 0xE180 || offset == 0xE200 || offset == 0xE280 ||
                          (offset >= 0xE400 && offset < 0xE420);
  const bool control = offset >= 0xED00 && offset < 0xED28 && offset != 0xED18;
  return !timer && !interrupts && !control;
}

}  // namespace

int Nvic::priority(int exception) const {
  if (exception == 1) return -3;
  if (exception == 2) return -2;
  if (exception == kHardFault) return -1;
  return priority_[at(exception)];
}

int Nvic::group_priority(int value) const {
  if (value < 0) return value;
  const std::uint32_t sub_bits = ((aircr_ >> 8) & 7) + 1;
  return static_cast<int>((static_cast<std::uint32_t>(value) >> sub_bits) << sub_bits);
}

int Nvic::running_priority() const {
  int lowest = kNoPriority;
  for (int i = 0; i < depth_; ++i) {
    const int p = group_priority(priority(stack_[at(i)]));
    if (p < lowest) lowest = p;
  }
  return lowest;
}

bool Nvic::enabled(int exception) const {
  return exception < kFirstInterrupt || enabled_[at(exception)];
}

void Nvic::set_pending(int exception, bool pending) {
  const bool counted = pending_[at(exception)] && enabled(exception);
  pending_[at(exception)] = pending;
  const bool counts = pending && enabled(exception);
  pending_count_ += static_cast<int>(counts) - static_cast<int>(counted);
  if (counts != counted) find_best();
}

void Nvic::find_best() {
  best_ = kThread;
  int best_value = kNoPriority;
  for (int e = 1; e < kExceptions && pending_count_ > 0; ++e) {
    if (!pending_[at(e)] || !enabled(e)) continue;
    const int p = priority(e);  // equal: the lower number first
    if (p < best_value) {
      best_ = e;
      best_value = p;
    }
  }
}

void Nvic::reset(std::uint32_t vectors) {
  priority_ = {};
  enabled_ = {};
  pending_ = {};
  active_ = {};
  depth_ = 0;
  pending_count_ = 0;
  best_ = kThread;
  vtor_ = vectors;
  aircr_ = scr_ = shcsr_ = cpacr_ = cfsr_ = hfsr_ = 0;
  systick_control_ = systick_reload_ = 0;
  systick_event_ = kNever;
  reset_requested_ = false;
}

void Nvic::pend(int exception) {
  set_pending(exception, true);
}

void Nvic::set_line(int irq, bool level) {
  const int exception = kFirstInterrupt + irq;
  const bool was = line_[at(exception)];
  line_[at(exception)] = level;
  if (level && !was) set_pending(exception, true);
}

int Nvic::next_exception(const Masks& masks) const {
  if (pending_count_ == 0) return kThread;
  int limit = running_priority();
  if (masks.basepri != 0) limit = std::min(limit, group_priority(static_cast<int>(masks.basepri)));
  if ((masks.primask & 1) != 0) limit = std::min(limit, 0);
  if ((masks.faultmask & 1) != 0) limit = std::min(limit, -1);
  return group_priority(priority(best_)) < limit ? best_ : kThread;
}

void Nvic::enter(int exception) {
  assert(depth_ < kExceptions);
  set_pending(exception, false);
  active_[at(exception)] = true;
  stack_[at(depth_++)] = exception;
}

void Nvic::leave(int exception) {
  assert(depth_ > 0 && stack_[at(depth_ - 1)] == exception);
  --depth_;
  active_[at(exception)] = false;
  if (line_[at(exception)]) set_pending(exception, true);
}

bool Nvic::take_reset_request() {
  const bool asked = reset_requested_;
  reset_requested_ = false;
  return asked;
}

void Nvic::start_systick(Cycle now) {
  systick_zero_ = now;
  systick_event_ = (systick_control_ & 1) != 0 && systick_reload_ != 0 ? now + systick_reload_ + 1 : kNever;
}

std::uint32_t Nvic::systick_value(Cycle now) const {
  if ((systick_control_ & 1) == 0 || systick_reload_ == 0) return 0;
  return systick_reload_ - static_cast<std::uint32_t>((now - systick_zero_) % (systick_reload_ + 1ULL));
}

void Nvic::advance(Cycle now) {
  while (systick_event_ <= now) {
    systick_control_ |= 1u << 16;
    if ((systick_control_ & 2) != 0) set_pending(kSysTick, true);
    systick_event_ += systick_reload_ + 1ULL;
  }
}

std::uint32_t Nvic::read(std::uint32_t offset, Cycle now) {
  const auto bits = [](const auto& flags, std::uint32_t first) {
    std::uint32_t word = 0;
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
      const std::uint32_t e = kFirstInterrupt + first + bit;
      if (e < kExceptions && flags[e]) word |= 1u << bit;
    }
    return word;
  };
  const auto priorities = [&](std::uint32_t first) {
    std::uint32_t word = 0;
    for (std::uint32_t i = 0; i < 4; ++i)
      if (first + i < kExceptions) word |= static_cast<std::uint32_t>(priority_[first + i]) << (8 * i);
    return word;
  };
  if (small_ && missing_in_small(offset)) return 0;
  if (small_ && offset == 0xED00) return 0x410CC601;  // CPUID: Cortex-M0+ r0p1
  if (offset >= 0xE100 && offset < 0xE10C) return bits(enabled_, (offset - 0xE100) * 8);
  if (offset >= 0xE180 && offset < 0xE18C) return bits(enabled_, (offset - 0xE180) * 8);
  if (offset >= 0xE200 && offset < 0xE20C) return bits(pending_, (offset - 0xE200) * 8);
  if (offset >= 0xE280 && offset < 0xE28C) return bits(pending_, (offset - 0xE280) * 8);
  if (offset >= 0xE300 && offset < 0xE30C) return bits(active_, (offset - 0xE300) * 8);
  if (offset >= 0xE400 && offset < 0xE400 + kInterrupts) return priorities(kFirstInterrupt + offset - 0xE400);
  if (offset >= 0xED18 && offset < 0xED24) return priorities(4 + offset - 0xED18);
  switch (offset) {
    case 0x1000:
      return dwt_control_;
    case 0x1004:
      return (dwt_control_ & 1) != 0 ? static_cast<std::uint32_t>(now - dwt_zero_) : dwt_frozen_;
    case 0xE004:
      return 2;  // ICTR
    case 0xE010: {
      const std::uint32_t value = systick_control_;
      systick_control_ &= ~(1u << 16);  // COUNTFLAG is cleared by reading
      return value;
    }
    case 0xE014:
      return systick_reload_;
    case 0xE018:
      return systick_value(now);
    case 0xED00:
      return 0x410FC241;  // CPUID: Cortex-M4 r0p1
    case 0xED04: {
      std::uint32_t icsr = static_cast<std::uint32_t>(active_exception());
      if (pending_[kSysTick]) icsr |= 1u << 26;
      if (pending_[kPendSv]) icsr |= 1u << 28;
      if (pending_count_ > 0) icsr |= 1u << 22;
      return icsr;
    }
    case 0xED08:
      return vtor_;
    case 0xED0C:
      return 0xFA050000u | aircr_;
    case 0xED10:
      return scr_;
    case 0xED14:
      return ccr_;
    case 0xED24:
      return shcsr_;
    case 0xED28:
      return cfsr_;
    case 0xED2C:
      return hfsr_;
    case 0xED38:
      return bfar_;
    case 0xED88:
      return cpacr_;
    case 0xEDFC:
      return demcr_;
    case 0xEF34:
      return fpccr_;
    case 0x42000:
      return device_id_;
    default:
      return 0;
  }
}

void Nvic::write(std::uint32_t offset, std::uint32_t value, Cycle now) {
  if (small_ && missing_in_small(offset)) return;
  const auto each = [&](std::uint32_t base, auto&& action) {
    for (std::uint32_t bit = 0; bit < 32; ++bit) {
      const std::uint32_t irq = (offset - base) * 8 + bit;
      if ((value >> bit & 1) != 0 && irq < kInterrupts) action(kFirstInterrupt + static_cast<int>(irq));
    }
  };
  const auto enable = [this](int e, bool on) {
    const bool counted = pending_[at(e)] && enabled_[at(e)];
    enabled_[at(e)] = on;
    pending_count_ += static_cast<int>(pending_[at(e)] && on) - static_cast<int>(counted);
    find_best();
  };
  if (offset >= 0xE100 && offset < 0xE10C) return each(0xE100, [&](int e) { enable(e, true); });
  if (offset >= 0xE180 && offset < 0xE18C) return each(0xE180, [&](int e) { enable(e, false); });
  if (offset >= 0xE200 && offset < 0xE20C) return each(0xE200, [&](int e) { set_pending(e, true); });
  if (offset >= 0xE280 && offset < 0xE28C)
    return each(0xE280, [&](int e) { set_pending(e, line_[at(e)] && !active_[at(e)]); });
  if ((offset >= 0xE400 && offset < 0xE400 + kInterrupts) || (offset >= 0xED18 && offset < 0xED24)) {
    for (std::uint32_t i = 0; i < 4; ++i) set_priority(offset + i, value >> (8 * i) & 0xFF);
    return find_best();
  }
  switch (offset) {
    case 0x1000:
      if (((value ^ dwt_control_) & 1) != 0) {
        if ((value & 1) != 0)
          dwt_zero_ = now - dwt_frozen_;
        else
          dwt_frozen_ = static_cast<std::uint32_t>(now - dwt_zero_);
      }
      dwt_control_ = 0x40000000u | (value & 1);
      break;
    case 0x1004:
      dwt_zero_ = now - value;
      dwt_frozen_ = value;
      break;
    case 0xE010: {
      const bool was_on = (systick_control_ & 1) != 0;
      systick_control_ = value & 7;
      if ((value & 1) != 0 && !was_on) start_systick(now);
      if ((value & 1) == 0) systick_event_ = kNever;
      break;
    }
    case 0xE014:
      systick_reload_ = value & 0xFFFFFF;
      break;
    case 0xE018:
      start_systick(now);
      break;
    case 0xED04:
      if ((value >> 28 & 1) != 0) set_pending(kPendSv, true);
      if ((value >> 27 & 1) != 0) set_pending(kPendSv, false);
      if ((value >> 26 & 1) != 0) set_pending(kSysTick, true);
      if ((value >> 25 & 1) != 0) set_pending(kSysTick, false);
      break;
    case 0xED08:
      vtor_ = value & 0xFFFFFF80u;
      break;
    case 0xED0C:
      if (value >> 16 != 0x05FA) break;  // without the key nothing happens
      aircr_ = value & 0x700;
      if ((value & 4) != 0) reset_requested_ = true;
      break;
    case 0xED10:
      scr_ = value;
      break;
    case 0xED14:
      ccr_ = value;
      break;
    case 0xED24:
      shcsr_ = value;
      break;
    case 0xED28:
      cfsr_ &= ~value;
      break;
    case 0xED2C:
      hfsr_ &= ~value;
      break;
    case 0xED88:
      cpacr_ = value;
      break;
    case 0xEDFC:
      demcr_ = value;
      break;
    case 0xEF00:
      pend(kFirstInterrupt + static_cast<int>(value & 0x7F));
      break;  // STIR
    case 0xEF34:
      fpccr_ = value;
      break;
    default:
      break;
  }
}

void Nvic::set_priority(std::uint32_t offset, std::uint32_t byte) {
  const std::uint32_t index = offset >= 0xE400 ? kFirstInterrupt + offset - 0xE400 : 4 + offset - 0xED18;
  if (offset >= 0xE400 ? offset >= 0xE400 + kInterrupts : offset >= 0xED24) return;
  if (index < kExceptions) priority_[index] = static_cast<std::uint8_t>(byte & (small_ ? 0xC0 : 0xF0));
}

void Nvic::write_part(std::uint32_t offset, std::uint32_t value, int size, Cycle now) {
  if (small_) return;
  for (int i = 0; i < size; ++i, ++offset, value >>= 8) {
    if ((offset >= 0xE400 && offset < 0xE400 + kInterrupts) || (offset >= 0xED18 && offset < 0xED24))
      set_priority(offset, value);
    else
      return write(offset, value, now);
  }
  find_best();
}

}  // namespace kinebus::emulator
