#pragma once
// One piece with its speeds at both ends becomes phases: accelerate, cruise, decelerate, as far as each
// exists.

#include "gateway/motion/lookahead.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

class PhaseEmitter {
 public:
  /// Splits the step. To be called when all phases of the step before have been pulled.
  void start(const Lookahead::Step& step);
  /// Post-condition: s and ds/dt continue from the phase before, |a| within the piece's limits.
  bool next(Phase& phase);
  void clear() { index_ = count_ = 0; }
  bool empty() const { return index_ == count_; }
  /// Time of the phases that next() has still to give, s.
  double left_s() const;

 private:
  struct Part {
    double distance = 0, v0 = 0, v1 = 0;
  };
  void append(double distance, double x0, double x1);

  Part parts_[3];
  int index_ = 0, count_ = 0;
  double s_ = 0;
  std::uint32_t line_ = 0;
  bool last_ = false;
  const PathPiece* geometry_ = nullptr;
};

}  // namespace kinebus
