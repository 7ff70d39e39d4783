#include "node_firmware/heat/vibration_meter.hpp"

#include <algorithm>
#include <cstdlib>

namespace kinebus::heat {
namespace {

using namespace heat_object;

/// Butterflies of a call: two transforms are done in 0.5 s, and new ones begin every 0.64 s.
constexpr int kButterflies = 256;
/// And bands, of a transform that is done: 40 ms for all.
constexpr int kBandsAtOnce = 40;
static_assert(kVibrationBands % kBandsAtOnce == 0);
/// Decimated readings keep three bits of what the mean of 64 weights tells more.
constexpr int kKept = 3, kWeights = 6;
constexpr std::uint32_t kFull = std::uint32_t{1} << 31;

}  // namespace

void VibrationMeter::begin(LocalTime now) {
  state_ = VibrationState::kMeasures;
  now_ = began_ = heard_ = counted_ = now;
  readings_ = 0;
  windows_ = clipped_ = 0;
  in_block_ = at_ = filled_ = fresh_ = 0;
  rising_.fill(0);
  falling_.fill(0);
  first_block_ = true;
  work_ = Work::kNothing;
  summed_ = 0;
  for (auto& axis : energy_) axis.fill(0);
  exponent_.fill(0);
}

void VibrationMeter::end() {
  while (summed_ != 0) do_work();  // all bands have the same windows
  if (state_ == VibrationState::kMeasures) state_ = VibrationState::kReady;
  work_ = Work::kNothing;
}

std::uint32_t VibrationMeter::rate_mhz() const {
  const std::int64_t ms = (counted_ - began_).count() / 1'000'000;
  constexpr std::int64_t kLeast_ms = 1000;
  return ms < kLeast_ms ? 0 : static_cast<std::uint32_t>(std::int64_t{readings_} * 1'000'000 / ms);
}

void VibrationMeter::on_readings(LocalTime now, std::span<const Reading> readings) {
  now_ = std::max(now_, now);
  if (!readings.empty()) {
    heard_ = now_;
    last_ = readings.back();
    if (state_ == VibrationState::kSilent) state_ = VibrationState::kReady;
  } else if (now_ - heard_ >= kPatience) {
    state_ = VibrationState::kSilent;
  }
  if (state_ != VibrationState::kMeasures) return;
  for (const Reading& reading : readings) take(reading);
  readings_ += static_cast<std::uint32_t>(readings.size());
  counted_ = now_;
  do_work();
}

void VibrationMeter::take(const Reading& reading) {
  bool clips = false;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    clips = clips || std::abs(reading[axis]) >= range_;
    rising_[axis] += (in_block_ + 1) * reading[axis];
    falling_[axis] += (kDecimation - 1 - in_block_) * reading[axis];
  }
  if (clips && clipped_ < UINT16_MAX) ++clipped_;
  if (++in_block_ == kDecimation) take_decimated();
}

// Weights that rise over one block and fall over the next: 1 to 8 to 1.
void VibrationMeter::take_decimated() {
  in_block_ = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int32_t sum = before_[axis] + falling_[axis];
    constexpr int kDropped = kWeights - kKept;
    const std::int32_t value = (sum + (1 << (kDropped - 1))) >> kDropped;
    ring_[axis][static_cast<std::size_t>(at_)] =
        static_cast<std::int16_t>(std::clamp<std::int32_t>(value, INT16_MIN, INT16_MAX));
    before_[axis] = rising_[axis];
    rising_[axis] = falling_[axis] = 0;
  }
  if (first_block_) {
    first_block_ = false;  // nothing has risen before it
    return;
  }
  at_ = (at_ + 1) & (kPoints - 1);
  filled_ = std::min(filled_ + 1, kPoints);
  ++fresh_;
}

void VibrationMeter::do_work() {
  if (work_ == Work::kNothing) {
    if (filled_ < kPoints || fresh_ < kHop) return;
    fresh_ -= kHop;
    fill(0, 1);
    work_ = Work::kFirstTwo;
    return;
  }
  if (summed_ == 0 && !fft_.step(kButterflies)) return;
  // Two of real numbers are in one of complex ones: the even part is the first's, the odd part the second's.
  for (int end = summed_ + kBandsAtOnce; summed_ < end; ++summed_) {
    const int band = summed_;
    const FixedFft::Complex& a = fft_.output(band);
    const FixedFft::Complex& b = fft_.output((kPoints - band) & (kPoints - 1));
    const auto squares = [](std::int64_t re, std::int64_t im) {
      return static_cast<std::uint64_t>(re * re + im * im) >> 2;
    };
    if (work_ == Work::kThird) {
      add(2, band, squares(2 * std::int64_t{a.re}, 2 * std::int64_t{a.im}));
    } else {
      add(0, band, squares(std::int64_t{a.re} + b.re, std::int64_t{a.im} - b.im));
      add(1, band, squares(std::int64_t{a.im} + b.im, std::int64_t{b.re} - a.re));
    }
  }
  if (summed_ < kVibrationBands) return;
  summed_ = 0;
  if (work_ == Work::kFirstTwo) {
    fill(2, -1);
    work_ = Work::kThird;
    return;
  }
  work_ = Work::kNothing;
  if (windows_ < UINT16_MAX) ++windows_;
}

std::int32_t VibrationMeter::mean(int axis) const {
  std::int32_t sum = 0;
  for (const std::int16_t value : ring_[static_cast<std::size_t>(axis)]) sum += value;
  return sum / kPoints;
}

// Gravity is not what swings: without its mean a window has nothing that could leak into its neighbours.
void VibrationMeter::fill(int re_axis, int im_axis) {
  const std::int32_t re_mean = mean(re_axis), im_mean = im_axis < 0 ? 0 : mean(im_axis);
  for (int i = 0; i < kPoints; ++i) {
    const auto from = static_cast<std::size_t>((at_ + i) & (kPoints - 1));
    const std::int32_t window = (32'767 - FixedFft::cosine(i)) / 4;  // 2^-14
    const auto windowed = [&](int axis, std::int32_t mean) {
      // Of 17 bits by 14; one bit more of it is kept.
      return axis < 0 ? 0 : ((ring_[static_cast<std::size_t>(axis)][from] - mean) * window) >> 13;
    };
    fft_.input(i) = {windowed(re_axis, re_mean), windowed(im_axis, im_mean)};
  }
  fft_.begin();
}

void VibrationMeter::add(int axis, int band, std::uint64_t energy) {
  auto& all = energy_[static_cast<std::size_t>(axis)];
  std::int8_t& exponent = exponent_[static_cast<std::size_t>(axis)];
  const auto sum = [&] { return (energy >> exponent) + all[static_cast<std::size_t>(band)]; };
  while (sum() >= kFull) {
    for (std::uint32_t& value : all) value >>= 1;
    ++exponent;
  }
  all[static_cast<std::size_t>(band)] = static_cast<std::uint32_t>(sum());
}

AbortCode VibrationMeter::read(ObjectAddress address, std::int64_t& value) const {
  const int axis = std::max(0, address.subindex - 1);
  switch (address.index) {
    case kVibrationState.index:
      value = static_cast<std::int64_t>(state_);
      break;
    case kVibrationRate.index:
      value = rate_mhz();
      break;
    case kVibrationWindows.index:
      value = windows_;
      break;
    case kVibrationClipped.index:
      value = clipped_;
      break;
    case kVibrationCount.index:
      value = um_per_s2_;
      break;
    case kVibrationBand.index:
      value = band_;
      break;
    case kVibrationEnergy.index:
      value = energy(axis, band_);
      break;
    case kVibrationExponent.index:
      value = exponent(axis);
      break;
    case kAcceleration.index:
      value = last_[static_cast<std::size_t>(axis)];
      break;
    default:
      return AbortCode::kNoData;
  }
  return AbortCode::kNone;
}

AbortCode VibrationMeter::write(ObjectAddress address, std::int64_t value) {
  if (address.index == kVibrationBand.index) {
    band_ = static_cast<std::uint16_t>(value);
    return AbortCode::kNone;
  }
  if (address.index != kVibrationCommand.index) return AbortCode::kNoData;
  constexpr std::int64_t kBegin = 1;
  if (value != kBegin) {
    end();
    return AbortCode::kNone;
  }
  if (state_ == VibrationState::kSilent) return AbortCode::kHardware;
  begin(now_);
  return AbortCode::kNone;
}

}  // namespace kinebus::heat
