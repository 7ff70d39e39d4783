#include "node_firmware/heat/fan.hpp"

#include <algorithm>
#include <utility>

namespace kinebus::heat {

void Fan::set_command(std::int32_t command) {
  command_ = std::clamp<std::int32_t>(command, 0, kFullFan);
}

void Fan::step(LocalTime now, std::int32_t hot_end_mc, bool fault) {
  std::int32_t wanted = command_;
  if (settings_.function == FanFunction::kHotEnd) {
    hot_ = fault || hot_end_mc >= (hot_ ? kHotEndFanTo : kHotEndFanFrom);
    if (hot_) wanted = kFullFan;
  }
  if (wanted > 0) wanted = std::max<std::int32_t>(wanted, kFullFan * settings_.least_duty / 100);
  if (wanted > 0 && output_ == 0) {
    kick_until_ = now + LocalTime{settings_.kick_ms * 1'000'000LL};
    turned_at_ = now;
  }
  output_ = static_cast<std::uint16_t>(now < kick_until_ && wanted > 0 ? kFullFan : wanted);

  const std::uint32_t pulses = std::exchange(pulses_, 0);
  if (settings_.pulses_per_turn == 0) return;
  counted_ += pulses;
  if (++ticks_ == kRpmTicks) {
    rpm_ = static_cast<std::uint16_t>(
        std::min<std::uint32_t>(counted_ * 60 / settings_.pulses_per_turn, 65'535));
    counted_ = ticks_ = 0;
  }
  if (pulses != 0 || output_ == 0) turned_at_ = now;
  if (now - turned_at_ >= kStallTime) stalled_ = true;
  if (pulses != 0) stalled_ = false;
}

}  // namespace kinebus::heat
