#pragma once
// Path time that goes with a spindle's angle. What was planned for one speed is, at each angle, where it was
// planned to be, however fast the spindle turns: the pitch of a thread is that of the plan.

#include <optional>

#include "gateway/devices/device.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class SpindleFollower {
 public:
  /// For a path that is planned for `rpm`; 0: path time goes by itself.
  void follow(double rpm);
  bool follows() const { return planned_per_s_ > 0; }

  /// What the encoder says now; nothing: it has no angle yet. Speed and angle are known a while later.
  /// `back`: it turns the other way than when the following began, and the angle is counted down.
  void look(const std::optional<SpindleAngle>& angle, bool back = false);
  /// When an index pulse comes, at least `lead` and less than kPatience more from `now`; nothing: none does.
  std::optional<BusTime> next_index(BusTime now, BusTime lead) const;
  /// Path time begins there, at `tau`.
  void start(BusTime index, PathTime tau);
  BusTime started() const { return start_; }

  /// Of the spindle's speed then to that of the plan.
  double ratio(BusTime at) const;
  /// Nothing: no angle has come yet, or not for long enough.
  std::optional<double> ratio_if_known(BusTime at) const;
  /// How far path time `tau` is behind the spindle at `at`, turns.
  double behind(BusTime at, PathTime tau) const;
  double planned_turns_per_s() const { return planned_per_s_; }
  /// Since the index pulse with which path time began.
  double turned(BusTime at) const { return turns_at(at) - start_turns_; }
  double turns_per_s(BusTime at) const { return per_s_at(at); }
  PathTime start_tau() const { return start_tau_; }

  /// The loop of the gateway comes round within it.
  static constexpr BusTime kPatience = std::chrono::milliseconds{25};

 private:
  double per_s_at(BusTime at) const { return per_s_ + per_s2_ * to_seconds(at - at_); }
  double turns_at(BusTime at) const { return turns_ + (per_s_ + per_s_at(at)) / 2 * to_seconds(at - at_); }

  double planned_per_s_ = 0;
  std::optional<BusTime> first_;  ///< since when there is an angle
  BusTime at_{0}, start_{0};
  double turns_ = 0, per_s_ = 0, per_s2_ = 0;  ///< as estimated
  double told_ = 0, counted_down_ = 0;         ///< by the encoder; of that the other way
  double start_turns_ = 0;
  PathTime start_tau_{0};
};

}  // namespace kinebus
