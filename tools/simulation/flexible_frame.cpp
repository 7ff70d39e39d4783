#include "tools/simulation/flexible_frame.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace kinebus {
namespace {

constexpr double kUsualFrequency_hz = 45, kUsualDamping = 0.1;
// A second mode that nobody has told the shapers of.
constexpr double kSecondFrequency = 2.7, kSecondDamping = 0.6, kSecondShare = 0.1;

}  // namespace

std::array<FlexibleFrame::Modes, 3> FlexibleFrame::truth(const VibrationDescription& assumed,
                                                         const Error& error, std::uint64_t seed) {
  std::array<Modes, 3> modes;
  std::mt19937_64 random(seed ^ 0x51D7E3A9C4B82F60ULL);
  const auto wrong = [&random](double by) { return 1 + ((random() >> 40 & 1U) != 0 ? by : -by); };
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const AxisVibration& axis = assumed.axis(i);
    const bool known = axis.frequency_hz > 0;
    const double frequency = (known ? axis.frequency_hz : kUsualFrequency_hz) * wrong(error.frequency);
    const double damping = (known ? axis.damping_ratio : kUsualDamping) * wrong(error.damping);
    modes[i] = {{{frequency, damping, 1 - kSecondShare},
                 {kSecondFrequency * frequency, kSecondDamping * damping, kSecondShare}}};
  }
  return modes;
}

std::array<FlexibleFrame::Modes, 3> FlexibleFrame::hidden(std::uint64_t seed) {
  std::array<Modes, 3> modes;
  std::mt19937_64 random(seed ^ 0x3C6EF372FE94F82BULL);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
  };
  for (Modes& m : modes) {
    const double frequency = between(28, 75), damping = between(0.03, 0.15), share = between(0.05, 0.15);
    m = {{{frequency, damping, 1 - share}, {between(2.1, 3.1) * frequency, between(0.03, 0.1), share}}};
  }
  return modes;
}

void FlexibleFrame::move_to(const Vector& rigid_mm, double dt_s) {
  if (!placed_) {
    rigid_ = rigid_mm;
    placed_ = true;
    return;
  }
  if (!(dt_s > 0)) return;
  for (std::size_t i = 0; i < rigid_.size(); ++i) {
    const double speed = (rigid_mm[i] - rigid_[i]) / dt_s;
    // While the frame moves in a straight line the deviation swings freely; where its speed jumps, the tool's
    // own does not.
    const double jump = speed - speed_[i];
    speed_[i] = speed;
    rigid_[i] = rigid_mm[i];
    deflection_[i] = 0;
    for (std::size_t m = 0; m < modes_[i].size(); ++m) {
      const Mode& mode = modes_[i][m];
      State& s = states_[i][m];
      s.v -= jump;
      const double w = 2 * std::numbers::pi * mode.frequency_hz, decay = mode.damping_ratio * w;
      const double damped = w * std::sqrt(1 - mode.damping_ratio * mode.damping_ratio);
      const double e = std::exp(-decay * dt_s), c = std::cos(damped * dt_s), sine = std::sin(damped * dt_s);
      const double b = (s.v + decay * s.x) / damped;
      const double x = e * (s.x * c + b * sine);
      s.v = e * (damped * (b * c - s.x * sine)) - decay * x;
      s.x = x;
      deflection_[i] += mode.share * s.x;
    }
  }
}

FlexibleFrame::Vector FlexibleFrame::acceleration_mm_per_s2() const {
  Vector accel{};
  for (std::size_t i = 0; i < accel.size(); ++i)
    for (std::size_t m = 0; m < modes_[i].size(); ++m) {
      const Mode& mode = modes_[i][m];
      const double w = 2 * std::numbers::pi * mode.frequency_hz;
      accel[i] -= mode.share * (w * w * states_[i][m].x + 2 * mode.damping_ratio * w * states_[i][m].v);
    }
  return accel;
}

FlexibleFrame::Vector FlexibleFrame::static_deflection_mm(const Vector& accel) const {
  Vector deflection{};
  for (std::size_t i = 0; i < deflection.size(); ++i)
    for (const Mode& mode : modes_[i]) {
      const double w = 2 * std::numbers::pi * mode.frequency_hz;
      deflection[i] -= mode.share * accel[i] / (w * w);
    }
  return deflection;
}

}  // namespace kinebus
