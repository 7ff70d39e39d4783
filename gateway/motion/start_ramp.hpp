#pragma once
// Motion that begins in the midst of a planned path, at rest: the same path with the same speeds, but for a
// ramp at its start. What feed hold and resume do to path time, done to the phases themselves, for when the
// stream has to begin anew.

#include <vector>

#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// Turns phases (in their order) into phases on the very same pieces of path, whose speeds are the planned
/// ones times a rate that rises from 0 to 1 within full_ramp_s. Acceleration is that of a resume with this
/// ramp: planned acceleration * rate^2 + planned speed / full_ramp_s. After the ramp phases pass unchanged.
/// The same input gives the same output to the last bit.
class StartRamp {
 public:
  void start(double full_ramp_s);
  bool active() const { return rate_ < 1; }

  /// Appends what `phase` becomes from `from_s` (time into it, 0..duration) on. Of the appended phases the
  /// last one carries phase.last. Nothing is appended when nothing is left.
  void apply(const Phase& phase, double from_s, std::vector<Phase>& out);

 private:
  double full_ramp_s_ = 0;
  double rate_ = 1;
};

}  // namespace kinebus
