#pragma once
// All that happens to a plan on its way to the machine: first the tip is shaped and filament follows its way,
// then pressure advance is added along what came out.

#include "gateway/shaping/path_shaper.hpp"

namespace kinebus {

/// Pull style, as PathShaper.
class MotionShaper {
 public:
  using Shapers = PathShaper::Shapers;
  MotionShaper() : MotionShaper(Shapers{}) {}
  /// filament_offset_mm: what corners have left out before (`PathShaper::filament_offset_mm`).
  explicit MotionShaper(const Shapers& shapers, const AdvanceWindow& window = {},
                        double filament_offset_mm = 0)
      : tip_(shapers, {}, window.acts(), filament_offset_mm), advance_({}, window) {
    const double settles_s = window.acts() ? window.reach_s() : 0;
    if (tip_.active() && window.acts())
      tip_.set_pause(tip_.duration_s() + settles_s);
    else
      advance_.set_pause(settles_s);
  }

  /// Of the phases pushed from here on. Where it changes, no filament may be flowing.
  void set_advance(const AdvanceModel& model) { (tip_.active() ? tip_ : advance_).set_advance(model); }
  const AdvanceWindow& advance_window() const { return advance_.advance_window(); }
  double filament_offset_mm() const { return tip_.filament_offset_mm(); }
  bool active() const { return tip_.active() || advance_.active(); }
  double duration_s() const { return tip_.duration_s() + advance_.duration_s(); }

  void push(const Phase& phase) {
    if (tip_.active()) return tip_.push(phase);
    Phase shifted = phase;
    shifted.piece.coefficients[kE][0] += filament_offset_mm();
    advance_.push(shifted);
  }
  bool next(Phase& phase) {
    if (!advance_.active()) return tip_.next(phase);
    while (!advance_.next(phase)) {
      if (!tip_.active() || !tip_.next(phase)) return false;
      advance_.set_advance(tip_.advance());
      advance_.push(phase, &tip_.beads());
    }
    return true;
  }

  bool empty() const { return tip_.empty() && advance_.empty(); }
  double held_s() const { return tip_.held_s() + advance_.held_s(); }
  void reset() {
    tip_.reset();
    advance_.reset();
  }

 private:
  PathShaper tip_, advance_;
};

}  // namespace kinebus
