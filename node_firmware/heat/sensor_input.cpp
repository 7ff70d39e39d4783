#include "node_firmware/heat/sensor_input.hpp"

#include <algorithm>

namespace kinebus::heat {

SetupError SensorInput::configure(const SensorSetup& setup, LocalTime now) {
  setup_ = setup;
  const SetupError error = table_.configure(setup);
  clear(now);
  return error;
}

void SensorInput::clear(LocalTime now) {
  fault_ = SensorFault::kNone;
  same_ = 0;
  start_over(now);
}

void SensorInput::start_over(LocalTime now) {
  filled_ = 0;
  at_ = 0;
  sum_ = 0;
  good_ = false;
  good_at_ = heard_at_ = now;
}

SensorFault SensorInput::judge(std::uint32_t ratio, std::int32_t mc, bool broken) const {
  if (broken) return SensorFault::kSilent;
  if (ratio > table_.high_ratio()) return SensorFault::kOpen;
  if (ratio < table_.low_ratio()) return SensorFault::kShort;
  const bool full = filled_ == window_.size();
  if (full && (mc > mean_ + kJump || mc < mean_ - kJump)) return SensorFault::kJump;
  return SensorFault::kNone;
}

void SensorInput::on_sample(LocalTime now, std::uint32_t ratio, bool broken) {
  if (!configured()) return;
  same_ = ratio == ratio_ ? same_ + 1 : 0;
  ratio_ = ratio;
  heard_at_ = now;
  const std::int32_t mc = table_.milli_celsius(ratio);
  const SensorFault found = judge(ratio, mc, broken);
  good_ = found == SensorFault::kNone;
  if (!good_) {
    if (fault_ == SensorFault::kNone && now - good_at_ >= kPatience) fault_ = found;
    return;
  }
  good_at_ = now;
  if (filled_ == window_.size())
    sum_ -= window_[at_];
  else
    ++filled_;
  window_[at_] = mc;
  sum_ += mc;
  at_ = static_cast<std::uint8_t>((at_ + 1u) & (window_.size() - 1));
  if (filled_ == window_.size())
    mean_ = sum_ >> kMeanBits;
  else
    mean_ = mc;  // the first 80 ms after power-up, without power yet
  good_ = filled_ == window_.size();
}

void SensorInput::on_time(LocalTime now) {
  if (!configured() || now - heard_at_ < 3 * kSamplePeriod) return;
  good_ = false;
  if (fault_ == SensorFault::kNone && now - std::max(heard_at_, good_at_) >= kPatience)
    fault_ = SensorFault::kSilent;
}

}  // namespace kinebus::heat
