#include "node_firmware/heat/thermal_model.hpp"

#include <algorithm>

namespace kinebus::heat {
namespace {

constexpr std::int64_t kRoomState = static_cast<std::int64_t>(kRoom) << 16;

// value * factor with 32 fractional bits; |value| < 2^40.
std::int64_t times_q32(std::int64_t value, std::int64_t factor) {
  // In two parts, for 64 bits.
  return (value >> 16) * factor / 65536 + (((value & 0xFFFF) * factor) >> 32);
}

}  // namespace

void ThermalModel::configure(const ModelParameters& p) {
  parameters_ = p;
  heat_ = static_cast<std::int64_t>(p.rate_mc_per_s) * kTickMs * 65536 / 1000;
  reciprocal_ = (std::int64_t{1} << 48) / heat_;
  loss_ = (static_cast<std::int64_t>(p.loss_ppm_per_s) << 32) / 1'000'000 * kTickMs / 1000;
  // A tick's share of the way for a lag of some ticks: tick / (lag + tick / 2).
  lag_ = ((kTickMs << 32) / (p.lag_ms + static_cast<std::uint32_t>(kTickMs) / 2));
  dead_ = p.dead_ms / static_cast<std::uint32_t>(kTickMs);
  dead_part_ = static_cast<std::int32_t>(p.dead_ms % static_cast<std::uint32_t>(kTickMs) * 256 /
                                         static_cast<std::uint32_t>(kTickMs));
  // The observer's three poles lie at 1 / (half of the dead time and lag, and 1 s): what is faster is noise,
  // or a model that is a little wrong.
  const std::int64_t time_ms = (p.dead_ms + p.lag_ms) / 2 + 1000;
  const std::int64_t pole = (kTickMs << 16) / time_ms;  // a tick, 16 fractional bits
  const std::int64_t lag = lag_ >> 16;
  gain_sensor_ = 3 * pole - lag;
  gain_block_ = 3 * pole * pole / lag;
  gain_disturbance_ = pole * pole / 65536 * pole / lag;
}

void ThermalModel::start(std::int32_t measured) {
  block_ = sensor_ = static_cast<std::int64_t>(measured) << 16;
  disturbance_ = known_ = 0;
  history_.fill(0);
}

std::int32_t ThermalModel::delayed() const {
  const std::int32_t late = power_before(dead_ + 1), early = power_before(dead_);
  return (late * dead_part_ + early * (256 - dead_part_)) >> 8;
}

std::int64_t ThermalModel::lost_at(std::int64_t block) const {
  return times_q32(block - kRoomState, loss_);
}

void ThermalModel::step_blind(std::int32_t power) {
  at_ = (at_ + 1) & (kHistory - 1);
  history_[at_] = power;
  known_ = heat_of(delayed()) - lost_at(block_);
  const std::int64_t block = block_ + known_ + disturbance_;
  sensor_ += times_q32((block_ + block) / 2 - sensor_, lag_);
  block_ = block;
}

void ThermalModel::step(std::int32_t power, std::int32_t measured) {
  step_blind(power);
  const std::int64_t error = (static_cast<std::int64_t>(measured) << 16) - sensor_;
  sensor_ += (error >> 8) * gain_sensor_ / 256;
  block_ += (error >> 8) * gain_block_ / 256;
  disturbance_ = std::clamp(disturbance_ + (error >> 8) * gain_disturbance_ / 256, -4 * heat_, 4 * heat_);
}

std::int32_t ThermalModel::block_ahead() const {
  std::int64_t block = block_;
  // Oldest first. What is partly through counts with the rest of it.
  std::int64_t heat = heat_of(power_before(dead_) * dead_part_ >> 8);
  for (std::size_t i = dead_; i-- > 0;) {
    block += heat - lost_at(block) + disturbance_;
    heat = heat_of(power_before(i));
  }
  return static_cast<std::int32_t>((block + heat) >> 16);
}

std::int64_t ThermalModel::share_of(std::int64_t heat) const {
  const std::int64_t most = 8 * heat_;
  return (std::clamp(heat, -most, most) * reciprocal_) >> 32;
}

std::int32_t ThermalModel::disturbance() const {
  return static_cast<std::int32_t>(share_of(disturbance_));
}

std::int32_t ThermalModel::power_for(std::int32_t mc, std::int32_t ahead, std::int32_t gain) const {
  const std::int64_t hold = lost_at(static_cast<std::int64_t>(mc) << 16) - disturbance_;
  return static_cast<std::int32_t>(share_of(hold + static_cast<std::int64_t>(mc - ahead) * gain));
}

std::int32_t ThermalModel::holding_power(std::int32_t mc) const {
  return static_cast<std::int32_t>(share_of(lost_at(static_cast<std::int64_t>(mc) << 16)));
}

std::uint32_t ThermalModel::response_ticks() const {
  return (parameters_.dead_ms + 2 * parameters_.lag_ms) / static_cast<std::uint32_t>(kTickMs) + 10;
}

}  // namespace kinebus::heat
