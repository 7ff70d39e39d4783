#include "node_firmware/motor/axis_control.hpp"

#include <algorithm>
#include <cmath>

namespace kinebus::motor {
namespace {

constexpr std::int64_t kCount = std::int64_t{1} << 32;
constexpr std::int64_t kElectricalTurn = 1024 * kCount;
constexpr std::int32_t kQuarter = 256 * kAnglePerCount;  // 90 degrees electrical: the most torque
// An error as an angle is clamped here, where the lead is at its limit whatever the trim.
constexpr std::int64_t kFar = 384 * kCount;
// Current comes and goes evenly: from nothing to 1 A in 50 ms, so that the rotor is drawn and not struck.
constexpr float kEnableAmperesPerPeriod = 20.0F * kControlPeriodS;
constexpr float kBoostAmperesPerPeriod = 500.0F * kControlPeriodS;
constexpr int kRestBeforeHold = periods(0.2F);
// Of rest with power, after which the rotor is on its command: the ramp to 2 A, and a few swings.
constexpr int kSettled = periods(0.15F);
// Still is a rotor whose readings keep within this, the encoder's noise included, for 26 ms.
constexpr int kWindowBits = 9;
// Without power the rotor's place is the mean of about so many readings, 2^n: 0.8 ms, in which a hand moves
// it little.
constexpr int kStandingShift = 4;
constexpr std::int32_t kStillCounts = 80;
constexpr std::int64_t kOneStepLost = 640 * kCount;  // steps are lost by electrical turns, 1024 counts
// What counts as accelerating: 2 mm/s in 1 ms on a carriage, 2000 mm/s^2.
constexpr float kBoostChange = 2.56e6F * kControlPeriodS;
// Faster than the timers' range of duty is a position that jumps.
constexpr float kMostCountsPerSecond = 16.8e6F;
// Closed loop: the rest of an error decays within 25 ms; the trim is at most about half a full step.
constexpr int kTrimShift = 9;
constexpr std::int32_t kMostTrim = 120 * kAnglePerCount;
constexpr int kErrorToAngle = 10;
constexpr std::int32_t kHalfEncoderStep =
    static_cast<std::int32_t>(kCountsPerEncoderStep >> (kErrorToAngle + 1));

std::int64_t wrap(std::int64_t counts) {  // to +-half an electrical turn
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(counts) << 22) >> 22;
}
static_assert(kElectricalTurn == std::int64_t{1} << 42);

// A wish of the main loop; this is its only taker, so that no exchange is needed.
bool taken(std::atomic<bool>& wish) {
  if (!wish.load(std::memory_order_relaxed)) return false;
  wish.store(false, std::memory_order_relaxed);
  return true;
}

}  // namespace

bool AxisControl::configure(const AxisConfig& config) {
  if (config_waits_.load(std::memory_order_acquire)) return false;
  next_config_ = config;
  config_waits_.store(true, std::memory_order_release);
  return true;
}

void AxisControl::take_config() {
  // The same configuration comes every few milliseconds: what counts periods goes on counting.
  if (next_config_.following_periods != config_.following_periods)
    off_course_ = Persistence(next_config_.following_periods);
  config_ = next_config_;
  config_waits_.store(false, std::memory_order_release);
  loop_.configure(config_.motor, CurrentGains::of(config_.motor, config_.bandwidth_hz));
  encoder_.set_reversed(config_.encoder_reversed);
  trip_a_ = std::min(1.5F * std::max({config_.run_a, config_.hold_a, config_.boost_a}) + 0.75F, 6.5F);
}

void AxisControl::trip(std::uint16_t code) {
  on_ = false;
  amplitude_a_ = 0;
  measured_a2_.store(0, std::memory_order_relaxed);
  tune_.stop();
  tripped_.store(code, std::memory_order_release);
}

// The first angle is the one where the rotor stands: by the encoder, or else where it was left.
void AxisControl::begin() {
  on_ = true;
  trim_ = 0;
  rest_periods_ = 0;
  loop_.reset();
  power_faults_.reset();
  off_course_.reset();
  if (config_.encoder != EncoderMode::kNone && encoder_.known()) {
    if (config_.encoder_offset >= 0) {
      const std::int64_t mean = encoder_.absolute() + standing_ - encoder_.position();
      const std::int64_t rotor = mean - config_.encoder_offset * kCount;
      angle_shift_ = wrap(rotor - sign_position_);
    }
  }
  referenced_ = origin_fine_ = steady_ = seen_quiet_ = seen_still_ = false;
  window_ = 0;
}

void AxisControl::serve_encoder(const AxisInputs& in) {
  if (++looks_ % kLookEvery == 0) surroundings_.look(in.supply_v, in.temperature_c);
  std::uint8_t troubles = surroundings_.present();
  if (config_.encoder != EncoderMode::kNone) {
    const bool was_known = encoder_.known();
    static_cast<void>(encoder_.on_frame(in.encoder_frame));
    if (encoder_.lost() && encoder_.known()) encoder_.restart();
    if (!on_ && encoder_.known())
      standing_ +=
          was_known ? (encoder_.position() - standing_) >> kStandingShift : encoder_.position() - standing_;
    // Until the current holds the rotor on the command it may lie anywhere near.
    if (rest_periods_ >= kSettled || sign_velocity_ != 0) referenced_ = referenced_ || encoder_.known();
    if (!referenced_ || (!was_known && encoder_.known()))
      follow_origin_ = sign_position_ - encoder_.position();
    if (!seen_still_ && on_ && encoder_.known()) look_for_rest();
    if (encoder_.lost()) troubles |= Surroundings::kEncoder;
    error_ = encoder_.known() && on_ ? sign_position_ - encoder_.position() - follow_origin_ : 0;
    const auto whole = static_cast<std::int32_t>((error_ + kCount / 2) >> 32);
    if (off_course_.look(std::abs(whole) > config_.following_window)) troubles |= Surroundings::kFollowing;
    following_.store(config_.inverted ? -whole : whole, std::memory_order_relaxed);
  }
  troubles_.store(troubles, std::memory_order_relaxed);
}

// A rotor that was drawn to its first angle from far away swings for a while: its place counts once it is
// still, by the mean of a window of several swings. In motion that is done once, so that a rotor that stays
// behind is seen; at rest for good. Steps that are lost are not covered up.
void AxisControl::look_for_rest() {
  const auto apart = static_cast<std::int32_t>((sign_position_ - encoder_.position()) >> 32);
  if (window_ == 0) {
    window_sum_ = 0;
    lowest_ = highest_ = apart;
    window_ = 1 << kWindowBits;
    return;
  }
  lowest_ = std::min(lowest_, apart);
  highest_ = std::max(highest_, apart);
  window_sum_ += apart;
  if (--window_ > 0) return;
  const bool rests = rest_periods_ >= kSettled;
  const std::int64_t origin = window_sum_ << (32 - kWindowBits);
  if (highest_ - lowest_ > kStillCounts || std::llabs(origin - follow_origin_) > kOneStepLost) return;
  if (!rests && (seen_quiet_ || sign_velocity_ == 0)) return;
  follow_origin_ = origin;
  referenced_ = seen_quiet_ = true;
  seen_still_ = rests;
}

// Run, hold or boost, and the way from one to the other.
void AxisControl::slew_current(const AxisInputs& in) {
  const bool resting = resting_.load(std::memory_order_relaxed) && in.velocity == 0;
  rest_periods_ = resting ? std::min(rest_periods_ + 1, kRestBeforeHold) : 0;
  const bool accelerates = std::fabs(sign_velocity_ - last_velocity_) > kBoostChange;
  float wanted = rest_periods_ >= kRestBeforeHold ? config_.hold_a : config_.run_a;
  if (accelerates) wanted = std::max(wanted, config_.boost_a);
  const float rate = wanted > amplitude_a_ && rest_periods_ == 0 && amplitude_a_ >= config_.hold_a
                         ? kBoostAmperesPerPeriod
                         : kEnableAmperesPerPeriod;
  amplitude_a_ += std::clamp(wanted - amplitude_a_, -kEnableAmperesPerPeriod, rate);
  steady_ = rest_periods_ >= kRestBeforeHold && amplitude_a_ == wanted;
}

// What the angle swings by at rest; trims, or sets the origin when the rotor has not moved since power came.
std::int32_t AxisControl::rest_angle(std::int32_t error) {
  const RestTrim::Step step = rest_trim_.step(error);
  if (origin_fine_)
    trim_ = std::clamp(trim_ + step.change, -kMostTrim, kMostTrim);
  else
    follow_origin_ += static_cast<std::int64_t>(step.change) << kErrorToAngle;
  origin_fine_ = origin_fine_ || step.measured;
  return step.swing;
}

Angle AxisControl::commanded_angle(const AxisInputs& in) {
  const Angle angle = angle_of(sign_position_ + angle_shift_);
  if (config_.encoder != EncoderMode::kClosedLoop || !encoder_.known()) {
    // An encoder that is lost leaves what held the rotor on its command; trim is 0 without one.
    return angle + static_cast<Angle>(trim_ + rest_trim_.leave());
  }
  const auto error = static_cast<std::int32_t>(std::clamp(error_, -kFar, kFar) >> kErrorToAngle);
  const bool settles = steady_ && referenced_ && std::abs(error) < kQuarter;
  const std::int32_t swing = settles ? rest_angle(error) : rest_trim_.leave();
  origin_fine_ = origin_fine_ || (referenced_ && in.velocity != 0);
  // At rest or slow motion the average error goes to zero; a big one is none that trimming should chase.
  // Within half a step of the encoder a single reading knows nothing, and before the origin is known none
  // does.
  if (!settles && origin_fine_ && std::fabs(in.velocity) < 20'000 && std::abs(error) < kQuarter &&
      std::abs(error) > kHalfEncoderStep)
    trim_ = std::clamp(trim_ + (error >> kTrimShift), -kMostTrim, kMostTrim);
  // The current never leads the rotor by more than the angle of the most torque: no step is lost.
  const std::int32_t lead = std::clamp(error + trim_, -kQuarter, kQuarter);
  return angle - angle_of(error_) + static_cast<Angle>(lead) + static_cast<Angle>(swing);
}

AxisOutputs AxisControl::apply(const Vector& volts, const Vector& wanted) const {
  const float lost = supply_v_ * config_.dead_time_share;
  const float scale = 1.0F / supply_v_;
  const auto duty = [&](float v, float a) {
    return std::clamp((v + dead_time_volts(a, lost)) * scale, -kLargestDuty, kLargestDuty);
  };
  return {{duty(volts.x, wanted.x), duty(volts.y, wanted.y)}, true};
}

// The square of the amplitude is the same at every angle of the motor.
void AxisControl::note_current(const Vector& measured) {
  constexpr float kShare = kLookEvery * kControlPeriodS / 10e-3F;
  const float before = measured_a2_.load(std::memory_order_relaxed);
  const float now = measured.x * measured.x + measured.y * measured.y;
  measured_a2_.store(before + (now - before) * kShare, std::memory_order_relaxed);
}

AxisOutputs AxisControl::tune(const AxisInputs& in, Angle angle) {
  const SineCosine at = sine_cosine(angle);
  const float direct_a = turn_back(in.current_a, at).x;
  const AutoTune::Wish wish = tune_.step(loop_.direct_v(), direct_a, supply_v_);
  const Vector wanted = turn({wish.current_a, 0}, at);
  Vector volts;
  if (wish.open)
    volts = turn({wish.added_v, 0}, at);
  else
    volts = loop_.step(in.current_a, {wish.current_a, angle, 0}, at, supply_v_);
  amplitude_a_ = wish.current_a;
  if (tune_.state() != AutoTune::State::kRuns) {
    loop_.reset();
    if (encoder_.known()) {
      const std::int64_t offset = encoder_.absolute() - static_cast<std::int64_t>(std::uint64_t{angle} << 10);
      tuned_offset_ = static_cast<std::int32_t>(((offset + kCount / 2) >> 32) & 1023);
    }
    tune_state_.store(tune_.state(), std::memory_order_release);
  }
  // No dead-time compensation in the wave: its sign is that of the mean current, which does not change.
  return apply(volts, wanted);
}

AxisOutputs AxisControl::step(const AxisInputs& in) {
  if (config_waits_.load(std::memory_order_acquire)) take_config();
  const std::int64_t last = sign_position_;
  sign_position_ = config_.inverted ? -in.position : in.position;
  last_velocity_ = sign_velocity_;
  sign_velocity_ = config_.inverted ? -in.velocity : in.velocity;
  serve_encoder(in);
  if (Surroundings::is_supply(in.supply_v)) supply_v_ = in.supply_v;

  const bool wanted = wanted_power_.load(std::memory_order_relaxed);
  if (taken(acknowledged_)) tripped_.store(fault::kNone);
  if (tripped_.load(std::memory_order_relaxed) != fault::kNone) return {};
  if (!wanted) {
    on_ = false;
    amplitude_a_ = 0;
    measured_a2_.store(0, std::memory_order_relaxed);
    return {};
  }
  if (!on_) begin();
  if (in.break_seen) return trip(fault::kShortCircuit), AxisOutputs{};
  if (surroundings_.deadly() != fault::kNone) return trip(surroundings_.deadly()), AxisOutputs{};
  if (std::llabs(sign_position_ - last) >
      static_cast<std::int64_t>(kMostCountsPerSecond * kControlPeriodS) * kCount)
    return trip(fault::kSoftware), AxisOutputs{};

  const Angle angle = commanded_angle(in);
  const float omega = sign_velocity_ * kRadiansPerCount;
  const SineCosine at = sine_cosine(angle);
  const Vector reference = turn({amplitude_a_, 0}, at);
  if (power_faults_.over_current(in.current_a, trip_a_)) return trip(fault::kOverCurrent), AxisOutputs{};
  // Not in the same period as the look at the surroundings.
  if (looks_ % kLookEvery == kLookEvery / 2) {
    note_current(in.current_a);
    const std::uint16_t code =
        power_faults_.look(in.current_a, reference, amplitude_a_, loop_.direct_v(),
                           config_.motor_measured ? config_.motor.resistance_ohm : 0, omega);
    if (code != fault::kNone) return trip(code), AxisOutputs{};
  }

  if (taken(wanted_tune_) && sign_velocity_ == 0) {
    tune_.start(config_.run_a);
    tune_state_.store(AutoTune::State::kRuns, std::memory_order_release);
  }
  if (tune_.state() == AutoTune::State::kRuns) return tune(in, angle);

  slew_current(in);
  const float current_a = loop_.reachable(amplitude_a_, omega, supply_v_);
  const Vector volts = loop_.step(in.current_a, {current_a, angle, omega}, at, supply_v_);
  return apply(volts, reference);
}

}  // namespace kinebus::motor
