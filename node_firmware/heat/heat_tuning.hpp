#pragma once
// Measures a heater: full power until part of the way to the target, then none, and from the curve the model
// that makes it. Dead time and lag are searched, one trial a tick; rate and loss follow from each trial by
// least squares.

#include <array>
#include <cstdint>

#include "node_firmware/heat/thermal_model.hpp"

namespace kinebus::heat {

class HeatTuning {
 public:
  enum class State : std::uint8_t { kIdle, kHeating, kCoasting, kFitting, kDone, kFailed };
  enum class Failure : std::uint8_t {
    kNone,
    kTargetTooNear,  ///< the way is too short to measure anything
    kNoRise,         ///< full power does not warm the sensor
    kTooLong,        ///< not there after kLongest
    kTooHot,         ///< it would go on beyond the limit
    kNoModel,        ///< no model of this kind fits the curve
  };
  /// A bed of 300 W takes some minutes.
  static constexpr std::uint32_t kLongest = 20 * 60 * 10;  // ticks
  static constexpr std::uint32_t kNoRiseAfter = 60 * 10;   // ticks
  static constexpr std::int32_t kLeastWay = 40'000;        // mC

  void begin(std::int32_t measured, std::int32_t target, std::int32_t limit);
  void stop() { state_ = State::kIdle; }
  /// Once a tick: `power` was on since the last one (at nominal supply). Returns the power to give now.
  std::uint32_t step(std::int32_t measured, std::uint32_t power);

  State state() const { return state_; }
  bool running() const {
    return state_ == State::kHeating || state_ == State::kCoasting || state_ == State::kFitting;
  }
  Failure failure() const { return failure_; }
  const ModelParameters& result() const { return result_; }
  /// Root of the mean square of what the model leaves unexplained, mC.
  std::uint32_t residual_mc() const { return residual_mc_; }

 private:
  static constexpr std::size_t kSamples = 240;
  struct Trial {
    double dead_s = 0, lag_s = 0;
    double rate = 0, loss = 0;  // K/s of full power; 1/s
    double residual = 1e30;     // K^2
  };
  std::uint32_t fail(Failure failure);
  void record(std::int32_t measured, std::uint32_t power);
  Trial fit(double dead_s, double lag_s) const;
  void begin_search();
  void search();
  void finish();

  State state_ = State::kIdle;
  Failure failure_ = Failure::kNone;
  std::int32_t start_ = 0, switch_off_ = 0, limit_ = 0, peak_ = 0;
  std::uint32_t ticks_ = 0, off_at_ = 0, peak_at_ = 0, rise_at_ = 0;

  std::array<std::int32_t, kSamples> measured_{};
  std::array<std::uint32_t, kSamples> power_{};  // mean over the time up to the sample
  std::size_t count_ = 0;
  std::uint32_t ticks_a_sample_ = 1, in_sample_ = 0;
  std::uint64_t power_sum_ = 0;

  Trial best_{};
  double step_ = 0;  // factor less 1
  int direction_ = 0;
  bool improved_ = false;
  ModelParameters result_{};
  std::uint32_t residual_mc_ = 0;
};

}  // namespace kinebus::heat
