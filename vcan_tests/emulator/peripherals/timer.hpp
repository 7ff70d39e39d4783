#pragma once
// TIM1 and TIM8 as centre-aligned PWM with preload, repetition counter, main output enable and break input;
// TIM2 as a free-running time base. The count is a formula of time; only updates are events, and compares of
// a counter upwards that ask a DMA controller for a word. Channel 1's output in its forced modes.

#include <algorithm>
#include <array>
#include <functional>

#include "vcan_tests/emulator/peripherals/peripheral.hpp"

namespace kinebus::emulator {

struct TimerSetup {
  int update_irq = -1, break_irq = -1;
  Cycle cycles_per_tick = 1;  ///< 168 MHz timers: 1; those on APB1: 2
  bool advanced = true;
  Cycle ticks = 1;  ///< in cycles_per_tick; more than 1 only with prescalers that make whole cycles of it
};

class Timer final : public Peripheral {
 public:
  Timer(InterruptLines& lines, const TimerSetup& setup) : lines_(lines), setup_(setup) {}

  std::uint32_t read(std::uint32_t offset, Cycle now) override;
  void write(std::uint32_t offset, std::uint32_t value, Cycle now) override;
  Cycle next_event() const override { return next_event_; }
  void advance(Cycle now) override;
  void reset(Cycle now);

  /// One sweep of a centre-aligned counter: from `begin`, up or down, with the compare values in force.
  struct Sweep {
    Cycle begin = 0, end = 0;
    bool up = true;
    std::array<std::uint32_t, 4> compare{};
    std::array<bool, 4> enabled{};  ///< output on (CCxE) in PWM mode 1
    bool main_output = false;       ///< MOE: without it the pins float
  };
  Sweep sweep() const;
  bool running() const { return (cr1_ & 1) != 0; }
  /// Channel 1's pin, as a forced mode drives it or has left it; a channel that is off: false.
  bool output_high() const;

  /// The level on the break input: at the active one (BDTR.BKP) outputs go off in hardware, at once.
  void set_break_level(bool high, Cycle now);
  bool break_armed() const { return (bdtr_ >> 12 & 1) != 0; }

  std::function<void(Cycle)> on_trigger;  ///< TRGO by update
  std::function<void(Cycle)> on_output;   ///< output_high() is another one
  /// A compare event of that channel, or 0: an update, whose DMA request is on (DIER).
  std::function<void(int channel, Cycle)> on_request;
  std::function<void(Cycle)> before_change;  ///< outputs change at that time: whoever follows them catches up

 private:
  bool centre_aligned() const { return (cr1_ >> 5 & 3) != 0; }
  Cycle tick() const {
    return std::max<Cycle>(1, setup_.cycles_per_tick * (psc_in_force_ + 1ULL) / setup_.ticks);
  }
  Cycle sweep_length() const;
  std::uint32_t count(Cycle now) const;
  void begin_sweep(Cycle at, bool up);
  void find_next_event();
  bool requests() const { return (dier_ >> 9 & 0xF) != 0 && !centre_aligned(); }
  Cycle compare_at(std::size_t channel) const;
  Cycle next_compare() const;
  void serve_compares(Cycle now);
  void update_event(Cycle now, bool sets_flag);
  void update_lines();
  void look_at_output(Cycle now);

  InterruptLines& lines_;
  TimerSetup setup_;
  std::uint32_t cr1_ = 0, cr2_ = 0, smcr_ = 0, dier_ = 0, sr_ = 0, ccer_ = 0, psc_ = 0, arr_ = 0xFFFF,
                rcr_ = 0, bdtr_ = 0;
  std::array<std::uint32_t, 2> ccmr_{};
  std::array<std::uint32_t, 4> ccr_{};
  std::uint32_t psc_in_force_ = 0, arr_in_force_ = 0xFFFF, repetitions_left_ = 0;
  std::array<std::uint32_t, 4> ccr_in_force_{};
  Cycle sweep_begin_ = 0, next_event_ = kNever;
  std::array<bool, 4> compared_{};    // in this sweep
  std::uint32_t count_at_begin_ = 0;  // where this sweep started (CNT written, or 0)
  bool up_ = true;
  bool forced_high_ = false, was_high_ = false;
  std::uint32_t frozen_count_ = 0;
  bool break_active() const;
  void trip(Cycle now);
  bool break_high_ = true;
};

}  // namespace kinebus::emulator
