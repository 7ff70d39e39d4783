#include "node_firmware/heat/heat_control.hpp"

#include <algorithm>

namespace kinebus::heat {
namespace {

std::uint32_t limited(std::int64_t power, std::uint32_t most) {
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(power, 0, most));
}

}  // namespace

void PidControl::configure(const PidParameters& p, std::uint32_t hold_ppm_per_k) {
  hold_ = (static_cast<std::int64_t>(kFullPower) << 16) * hold_ppm_per_k / 1'000'000'000;
  proportional_ = (static_cast<std::int64_t>(kFullPower) << 16) / std::max<std::uint32_t>(p.band_mc, 100);
  integral_gain_ = p.integral_ms == 0 ? 0 : (kTickMs << 32) / p.integral_ms;
  look_ = p.integral_ms / 2 / kTickMs;
  derivative_gain_ = static_cast<std::int64_t>(p.derivative_ms) * 256 / kTickMs;
}

void PidControl::start(std::int32_t measured) {
  sum_ = 0;
  slope_ = 0;
  last_ = measured;
}

std::uint32_t PidControl::step(std::int32_t target, std::int32_t measured, std::uint32_t most) {
  const std::int64_t error = target - measured;
  // Of the measurement, so that a new target gives no kick; smoothed over 8 ticks.
  slope_ += (static_cast<std::int64_t>(measured - last_) * 256 - slope_) / 8;
  last_ = measured;
  const std::int64_t straight = error * proportional_ - ((slope_ * derivative_gain_) >> 16) * proportional_;
  const std::int64_t hold = std::max<std::int32_t>(target - kRoom, 0) * hold_;
  const std::int64_t power = (straight + hold + sum_) >> 16;
  const bool winds_up = (power >= most && error > 0) || (power <= 0 && error < 0);
  // What already comes by itself, within half of the integral's time, is not what the integral has to find.
  const std::int64_t comes = slope_ * look_ / 256;
  const bool comes_by_itself = (error > 0 && comes >= error) || (error < 0 && comes <= error);
  if (!winds_up && !comes_by_itself) sum_ += (error * proportional_ >> 16) * integral_gain_ >> 16;
  sum_ = std::clamp(sum_, -hold, static_cast<std::int64_t>(kFullPower) << 16);
  return limited(power, most);
}

void ModelControl::configure(const ModelParameters& p) {
  // The last part of the way takes a third of the dead time and lag: by so much the model may be wrong.
  const std::int64_t time_ms = (p.dead_ms + p.lag_ms) / 3 + 300;
  gain_ = static_cast<std::int32_t>((kTickMs << 16) / time_ms);
}

std::uint32_t ModelControl::step(std::int32_t target, const ThermalModel& model, std::int32_t feed_forward,
                                 std::uint32_t most) const {
  return limited(model.power_for(target, model.block_ahead(), gain_) + feed_forward, most);
}

PidParameters pid_for(const ModelParameters& m) {
  // Band = rate * 2 * dead time as control sees it; its integral is slow enough not to overshoot an
  // integrator.
  const std::uint64_t dead_ms = m.dead_ms + m.lag_ms / 2 + 100;
  return {.band_mc = static_cast<std::uint32_t>(2 * dead_ms * m.rate_mc_per_s / 1000),
          .integral_ms = static_cast<std::uint32_t>(8 * dead_ms),
          .derivative_ms = m.lag_ms / 2};
}

}  // namespace kinebus::heat
