#include "gateway/devices/vibration_reading.hpp"

#include <cmath>
#include <utility>

namespace kinebus {
namespace {

using namespace heat_object;

constexpr BusTime kLookAgain = std::chrono::seconds{1};
constexpr std::uint32_t kBegin = 1, kEnd = 2;        // 2271h
constexpr std::uint32_t kMeasures = 2, kSilent = 3;  // 2270h

constexpr ObjectAddress nth(ObjectAddress first, std::size_t n) {
  return {first.index, static_cast<std::uint8_t>(first.subindex + n)};
}
struct Fact {
  ObjectAddress address;
  std::size_t bytes;
};
constexpr std::array<Fact, 7> kFacts{{{kVibrationRate, 4},
                                      {kVibrationWindows, 2},
                                      {kVibrationClipped, 2},
                                      {kVibrationCount, 4},
                                      {nth(kVibrationExponent, 0), 1},
                                      {nth(kVibrationExponent, 1), 1},
                                      {nth(kVibrationExponent, 2), 1}}};
/// The band is named, then X, Y and Z are read.
constexpr std::size_t kForABand = 4;
constexpr std::size_t kForBands = kForABand * kVibrationBands;

}  // namespace

void VibrationReading::begin(BusTime now) {
  found_ = {};
  found_.stage = Stage::kMeasures;
  begun_ = ended_ = false;
  due_ = heard_ = now;
  read_ = 0;
}

void VibrationReading::end() {
  if (found_.stage == Stage::kMeasures) found_.stage = Stage::kReads;
}

void VibrationReading::fail(Sentence why) {
  if (found_.stage != Stage::kMeasures && found_.stage != Stage::kReads) return;
  found_.stage = Stage::kFailed;
  found_.failure = std::move(why);
}

std::optional<VibrationReading::Question> VibrationReading::next(BusTime now) const {
  if (found_.stage == Stage::kMeasures) {
    if (now < due_) return std::nullopt;
    if (!begun_) return Question{kVibrationCommand, 1, true, kBegin};
    return Question{kVibrationState, 1};
  }
  if (found_.stage != Stage::kReads) return std::nullopt;
  if (!ended_) return Question{kVibrationCommand, 1, true, kEnd};
  if (read_ < kFacts.size()) return Question{kFacts[read_].address, kFacts[read_].bytes};
  const std::size_t at = read_ - kFacts.size();
  if (at % kForABand == 0)
    return Question{kVibrationBand, 2, true, static_cast<std::uint32_t>(at / kForABand)};
  return Question{nth(kVibrationEnergy, at % kForABand - 1), 4};
}

void VibrationReading::on_answer(BusTime now, AbortCode code, std::uint32_t value) {
  if (code == AbortCode::kTimeout || code == AbortCode::kToggleBit || code == AbortCode::kCommandSpecifier) {
    if (now - heard_ > kSilence) fail(say("its node does not answer: %1", text(code)));
    return;
  }
  heard_ = now;
  if (code == AbortCode::kDeviceState) return fail(say("its node has no accelerometer"));
  if (code == AbortCode::kHardware) return fail(say("the accelerometer does not answer its node"));
  if (code != AbortCode::kNone) return fail(say("its node refuses to measure it: %1", text(code)));
  if (found_.stage == Stage::kMeasures) {
    due_ = now + kLookAgain;
    if (!std::exchange(begun_, true)) return;
    if (value == kSilent) return fail(say("the accelerometer does not answer its node"));
    if (value != kMeasures) fail(say("its node has ended it: see its alarms, or measure it again"));
    return;
  }
  if (!std::exchange(ended_, true)) return;
  if (read_ < kFacts.size())
    take_fact(value);
  else
    take_energy(value);
  ++read_;
  if (read_ == kFacts.size() && found_.windows == 0) return fail(say("it was too short: %1 s at least", 4));
  if (read_ == kFacts.size() + kForBands) found_.stage = Stage::kDone;
}

void VibrationReading::take_fact(std::uint32_t value) {
  switch (read_) {
    case 0:
      found_.rate_hz = 1e-3 * value;
      break;
    case 1:
      found_.windows = value;
      break;
    case 2:
      found_.clipped = value;
      break;
    case 3:
      count_mm_per_s2_ = 1e-3 * value;
      break;
    default:
      exponents_[read_ - 4] = static_cast<int>(value);
      break;
  }
}

void VibrationReading::take_energy(std::uint32_t value) {
  const std::size_t at = read_ - kFacts.size();
  if (at % kForABand == 0) {
    found_.energy.emplace_back();
    return;
  }
  const std::size_t chip = at % kForABand - 1;
  // A sine of one count is 2^24.
  const double squares = std::ldexp(static_cast<double>(value), exponents_[chip] - 24);
  for (std::size_t axis = 0; axis < axes_.size(); ++axis)
    if (axes_[axis] == chip) found_.energy.back()[axis] = squares * count_mm_per_s2_ * count_mm_per_s2_;
}

}  // namespace kinebus
