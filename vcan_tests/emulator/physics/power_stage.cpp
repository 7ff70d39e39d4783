#include "vcan_tests/emulator/physics/power_stage.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::emulator {
namespace {
// The rotor's equation is stepped so often: at 15 turns a second the electrical angle turns by 3.4 degrees.
constexpr Cycle kMechanicalStep = kCoreHz / 80'000;

Cycle cycles_of(double seconds) {
  return static_cast<Cycle>(std::llround(seconds * static_cast<double>(kCoreHz)));
}
}  // namespace

PowerStage::PowerStage(Timer& timer, StepperMotor& motor, const PowerStageParameters& parameters)
    : timer_(timer), motor_(motor), p_(parameters) {}

void PowerStage::set_enabled(bool enabled, Cycle now) {
  advance(now);
  enabled_ = enabled;
}

void PowerStage::set_supply(double volts, Cycle now) {
  advance(now);
  supply_v_ = volts;
}

void PowerStage::command(HalfBridge& bridge, Level level, double out_a, Cycle now) {
  if (bridge.commanded == level) return;
  bridge.commanded = level;
  if (bridge.effective == level) {
    bridge.follows_at = kNever;  // a pulse shorter than the dead time
    return;
  }
  // Both MOSFETs are off for the dead time: the current chooses the diode. Flowing out, it keeps the output
  // low.
  const bool waits = level == Level::kHigh ? out_a > 0 : out_a < 0;
  bridge.follows_at = now + (waits ? cycles_of(p_.dead_time_s) : 0);
}

void PowerStage::integrate(Cycle from, Cycle to, bool off) {
  StepperMotor::Drive drive;
  for (std::size_t phase = 0; phase < 2; ++phase) {
    const double i = motor_.current_a(static_cast<int>(phase));
    const auto volts = [&](const HalfBridge& b) { return b.effective == Level::kHigh ? supply_v_ : 0; };
    drive.volts[phase] = volts(bridges_[2 * phase]) - volts(bridges_[2 * phase + 1]) - 2 * p_.switch_ohm * i;
    drive.floating[phase] = off;
  }
  motor_.step_electrical(seconds_of(to - from), drive, supply_v_ + 2 * p_.diode_v);
}

void PowerStage::advance(Cycle to) {
  while (now_ < to) {
    const Timer::Sweep sweep = timer_.sweep();
    const bool counting = timer_.running();
    const bool off = !enabled_ || !sweep.main_output || cut_;
    Cycle next = std::min(to, now_ + kMechanicalStep);
    if (trips_at_ > now_) next = std::min(next, trips_at_);
    for (std::size_t b = 0; b < bridges_.size(); ++b) {
      HalfBridge& bridge = bridges_[b];
      const double out = motor_.current_a(static_cast<int>(b / 2)) * (b % 2 == 0 ? 1 : -1);
      Level level = Level::kLow;
      if (counting && sweep.enabled[b]) {
        // Counting up: high until the compare value; counting down: from it on. (PWM mode 1, centre-aligned.)
        const Cycle length = sweep.end - sweep.begin;
        const Cycle edge = sweep.up ? sweep.begin + std::min<Cycle>(sweep.compare[b], length)
                                    : sweep.end - std::min<Cycle>(sweep.compare[b], length);
        level = (now_ < edge) == sweep.up ? Level::kHigh : Level::kLow;
        if (edge > now_) next = std::min(next, edge);
      }
      command(bridge, level, out, now_);
      if (bridge.follows_at <= now_) {
        bridge.effective = bridge.commanded;
        bridge.follows_at = kNever;
      }
      next = std::min(next, bridge.follows_at);
    }

    const std::array<double, 2> before{motor_.current_a(0), motor_.current_a(1)};
    const StepperMotor saved = motor_;
    integrate(now_, next, off);
    for (std::size_t phase = 0; phase < 2 && !tripped_ && trips_at_ == kNever; ++phase) {
      const double i = std::abs(motor_.current_a(static_cast<int>(phase)));
      if (i <= p_.trip_a) continue;
      const double part = (p_.trip_a - std::abs(before[phase])) / (i - std::abs(before[phase]));
      const Cycle crossing =
          now_ + static_cast<Cycle>(std::clamp(part, 0.0, 1.0) * static_cast<double>(next - now_));
      trips_at_ = std::max(crossing + cycles_of(p_.trip_delay_s), now_ + 1);
      if (trips_at_ < next) {
        motor_ = saved;
        next = trips_at_;
        integrate(now_, next, off);
      }
    }
    now_ = next;
    if (now_ - mechanics_at_ >= kMechanicalStep) {
      motor_.step_mechanical(seconds_of(now_ - mechanics_at_));
      mechanics_at_ = now_;
    }
    if (trips_at_ <= now_) {
      trips_at_ = kNever;
      tripped_ = true;
      cut_ = timer_.break_armed();
      if (on_comparator) on_comparator(false, to);
    } else if (tripped_ && std::abs(motor_.current_a(0)) < p_.trip_a &&
               std::abs(motor_.current_a(1)) < p_.trip_a) {
      tripped_ = false;
      if (on_comparator) on_comparator(true, to);
    }
  }
  // The timer's own outputs are off by now: from here on its main output enable counts.
  if (cut_ && !timer_.sweep().main_output) cut_ = false;
}

}  // namespace kinebus::emulator
