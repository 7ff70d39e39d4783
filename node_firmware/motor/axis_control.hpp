#pragma once
// The control of one motor, called 20,000 times a second: from the commanded position and the measured
// currents to the duty of its two H-bridges. Decides by itself what cannot wait (power off at a fault) and
// leaves the rest to the main loop as flags.

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>

#include "node_firmware/motor/auto_tune.hpp"
#include "node_firmware/motor/current_loop.hpp"
#include "node_firmware/motor/encoder.hpp"
#include "node_firmware/motor/rest_trim.hpp"
#include "node_firmware/motor/supervision.hpp"

namespace kinebus::motor {

enum class EncoderMode : std::uint8_t { kNone, kWatch, kClosedLoop };

struct AxisConfig {
  MotorModel motor;
  bool motor_measured = false;  ///< else a cautious guess, and shorted turns are not looked for
  /// Of the supply, that a phase's two half-bridges lose to dead time.
  float dead_time_share = 0;
  float bandwidth_hz = 1500;
  float run_a = 1.5F, hold_a = 1.0F, boost_a = 0;
  bool inverted = false;
  EncoderMode encoder = EncoderMode::kNone;
  bool encoder_reversed = false;
  /// Encoder's absolute counts, modulo an electrical turn, where the motor's angle is 0; < 0: never found.
  std::int32_t encoder_offset = -1;
  std::int32_t following_window = 1024;  ///< counts
  int following_periods = 200;
};

struct AxisInputs {
  Vector current_a;  ///< phases A and B, at the sampling instant
  float supply_v = 24;
  float temperature_c = 25;
  std::int64_t position = 0;  ///< command: counts, 32 fractional bits
  float velocity = 0;         ///< counts/s
  std::uint16_t encoder_frame = 0;
  bool break_seen = false;  ///< the hardware has switched the outputs off
};

struct AxisOutputs {
  Vector duty;         ///< of the supply, -1..1, phases A and B
  bool power = false;  ///< outputs on
};

class AxisControl {
 public:
  /// `turn`: 0 or 1, so that two axes do not make their longer looks in the same period.
  explicit constexpr AxisControl(unsigned turn = 0) : looks_(turn) {}
  // Main loop; all of these are words.
  void set_power(bool on) { wanted_power_.store(on, std::memory_order_relaxed); }
  void set_resting(bool resting) { resting_.store(resting, std::memory_order_relaxed); }
  void request_tune() { wanted_tune_.store(true, std::memory_order_relaxed); }
  /// Taken over by the next control interrupt; false: the last one is not taken yet.
  bool configure(const AxisConfig& config);
  /// The fault that has switched the power off; stays until acknowledge().
  std::uint16_t tripped() const { return tripped_.load(std::memory_order_acquire); }
  void acknowledge() { acknowledged_.store(true, std::memory_order_relaxed); }
  /// Bits of Surroundings.
  std::uint8_t troubles() const { return troubles_.load(std::memory_order_relaxed); }
  /// Counts, command less encoder; 0 without encoder.
  std::int32_t following_error() const { return following_.load(std::memory_order_relaxed); }
  AutoTune::State tune_state() const { return tune_state_.load(std::memory_order_acquire); }
  /// Valid when tune_state() is kDone.
  AutoTune::Result tune_result() const { return tune_.result(); }
  std::int32_t tuned_encoder_offset() const { return tuned_offset_; }
  /// What the windings are to have: it grows and falls with a slope.
  float amplitude_a() const { return amplitude_a_; }
  /// What they are measured to have, smoothed over some 10 ms; 0 without power.
  float measured_a() const { return std::sqrt(measured_a2_.load(std::memory_order_relaxed)); }
  const Encoder& encoder() const { return encoder_; }

  /// Control interrupt.
  AxisOutputs step(const AxisInputs& in);

 private:
  void take_config();
  void trip(std::uint16_t code);
  void begin();
  void serve_encoder(const AxisInputs& in);
  void look_for_rest();
  void slew_current(const AxisInputs& in);
  Angle commanded_angle(const AxisInputs& in);
  std::int32_t rest_angle(std::int32_t error);
  AxisOutputs tune(const AxisInputs& in, Angle angle);
  void note_current(const Vector& measured);
  AxisOutputs apply(const Vector& volts, const Vector& wanted) const;

  AxisConfig config_, next_config_;
  std::atomic<bool> config_waits_{false}, wanted_power_{false}, resting_{true}, wanted_tune_{false},
      acknowledged_{false};
  std::atomic<std::uint16_t> tripped_{0};
  std::atomic<std::uint8_t> troubles_{0};
  std::atomic<std::int32_t> following_{0};
  std::atomic<float> measured_a2_{0};
  std::atomic<AutoTune::State> tune_state_{AutoTune::State::kIdle};

  CurrentLoop loop_;
  Encoder encoder_;
  AutoTune tune_;
  PowerFaults power_faults_;
  Surroundings surroundings_;
  Persistence off_course_{200};

  bool on_ = false;
  float amplitude_a_ = 0, trip_a_ = 0;
  float supply_v_ = 24;  ///< the last that can be one: it is divided by
  int rest_periods_ = 0;
  std::int64_t sign_position_ = 0;  // command, with the sense of the motor
  float sign_velocity_ = 0, last_velocity_ = 0;
  std::int64_t angle_shift_ = 0;    // electrical: where the current began, less the command, counts << 32
  std::int64_t standing_ = 0;       // the encoder's position without power, as a mean: one reading is noisy
  std::int64_t follow_origin_ = 0;  // command less encoder when the rotor had settled on it
  bool referenced_ = false;         // it has
  bool seen_quiet_ = false;         // it has, and did not swing any more
  bool seen_still_ = false;         // and that at rest
  int window_ = 0;                  // control periods left in which it is watched for that
  std::int32_t lowest_ = 0, highest_ = 0;
  std::int64_t window_sum_ = 0;
  bool origin_fine_ = false;  // and to less than a step of the encoder, or it has moved since
  std::int64_t error_ = 0;    // command less encoder less origin; 0 while not known
  std::int32_t trim_ = 0;     // closed loop: angle that keeps the rotor on the command at rest
  RestTrim rest_trim_;
  unsigned looks_;
  bool steady_ = false;  // at rest, and the current has come to what it holds
  std::int32_t tuned_offset_ = -1;
};

}  // namespace kinebus::motor
