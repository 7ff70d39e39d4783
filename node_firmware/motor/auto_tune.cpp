#include "node_firmware/motor/auto_tune.hpp"

namespace kinebus::motor {
namespace {

constexpr int kSettle = 4000;   // 200 ms: many time constants of any winding
constexpr int kAverage = 1000;  // 50 ms
constexpr int kStage = kSettle + kAverage;
constexpr int kWavePeriods = 1600;  // 80 ms
constexpr int kHalfWave = 4;        // 2.5 kHz
constexpr float kWaveOfSupply = 0.08F;

}  // namespace

void AutoTune::start(float current_a) {
  *this = AutoTune{};
  current_a_ = current_a;
  state_ = State::kRuns;
}

AutoTune::Wish AutoTune::step(float direct_v, float direct_a, float supply_v) {
  if (state_ != State::kRuns) return {};
  const int period = period_++;
  if (period < kStage) {
    if (period >= kSettle) low_v_ += direct_v, low_a_ += direct_a;
    return {.current_a = current_a_ * 0.4F};
  }
  if (period < 2 * kStage) {
    if (period >= kStage + kSettle) high_v_ += direct_v, high_a_ += direct_a;
    wave_v_ = supply_v * kWaveOfSupply;
    return {.current_a = current_a_};
  }
  const int wave = period - 2 * kStage;
  // Begins in the middle of a half-wave: the current then swings about its mean.
  const bool up = ((wave + kHalfWave / 2) / kHalfWave) % 2 == 0;
  // The voltage that was wished for two periods ago acted between the last sample and this one.
  if (wave >= 2 * kHalfWave) rise_a_ += acted_up_[1] ? direct_a - last_a_ : last_a_ - direct_a;
  last_a_ = direct_a;
  acted_up_ = {up, acted_up_[0]};
  if (wave >= kWavePeriods + 2 * kHalfWave) {
    finish();
    return {.current_a = current_a_};
  }
  return {.current_a = current_a_,
          .added_v = high_v_ * (1.0F / kAverage) + (up ? wave_v_ : -wave_v_),
          .open = true};
}

void AutoTune::finish() {
  const float amperes = (high_a_ - low_a_) * (1.0F / kAverage);
  const float volts = (high_v_ - low_v_) * (1.0F / kAverage);
  state_ = State::kFailed;
  if (amperes < 0.2F * current_a_ || amperes < 0.05F) return;
  result_.resistance_ohm = volts / amperes;
  result_.inductance_h = wave_v_ * kControlPeriodS * static_cast<float>(kWavePeriods) / rise_a_;
  const bool sane = result_.resistance_ohm > 0.02F && result_.resistance_ohm < 60 &&
                    result_.inductance_h > 50e-6F && result_.inductance_h < 60e-3F;
  if (sane) state_ = State::kDone;
}

}  // namespace kinebus::motor
