#pragma once

#include "protocol/time.hpp"

namespace kinebus {

/// How path time is kept beside a spindle's angle.
struct ThreadControl {
  static constexpr BusTime kPeriod = std::chrono::milliseconds{10};
  /// Where path time will be when a command of now is in force.
  static constexpr BusTime kAhead = std::chrono::milliseconds{6};
  /// What is missing is caught up within it.
  static constexpr double kCatchUp_s = 0.04;
  /// So far from its angle the thread is spoilt.
  static constexpr double kLost_turns = 0.1;
};

}  // namespace kinebus
