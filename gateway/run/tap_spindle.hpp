#pragma once
// The spindle in a tap: braked so that it stands at the bottom of the hole, and turned the other way.

#include <optional>

#include "gateway/jobs/tap_turn.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class TapSpindle {
 public:
  /// `rpm`: what the spindle is told, > 0 clockwise.
  void begin(const TapTurn& turn, double rpm);
  /// What it is to be told from now on; nothing: what it was. `left`: turns to the bottom, `turns_per_s`: as
  /// it was told first > 0; both measured.
  std::optional<double> look(BusTime now, double left, double turns_per_s);
  bool turns_back() const { return braked_.has_value(); }

 private:
  double stands_s() const { return from_per_s_ / brake_per_s2_ + ease_s_ / 2; }
  double speed_at(double t) const;
  double left_at(double t) const;

  TapTurn turn_{{}, 0};
  double rpm_ = 0;
  double of_told_ = 1;  ///< so fast it is: a load makes it slower than it is told
  double from_per_s_ = 0, brake_per_s2_ = 0, left_ = 0, ease_s_ = 0;  ///< when it began to be braked
  std::optional<BusTime> braked_;
  BusTime told_at_{0};
  bool done_ = false;
};

}  // namespace kinebus
