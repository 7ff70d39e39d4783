#pragma once
// Melt in front of a nozzle: filament that is pressed together drives it out. The truth that beads are judged
// by, never what pressure advance assumes.

#include <cstdint>

#include "gateway/shaping/advance_model.hpp"

namespace kinebus {

class Nozzle {
 public:
  /// At a steady flow q (mm of filament a second) the melt is pressed together by press_s q (q /
  /// kUsual)^(power - 1); flow follows that with a time constant of its own.
  struct Truth {
    static constexpr double kUsual_mm_per_s = 2;
    double press_s = 0.04;
    double power = 0.9;           ///< melt flows the easier, the faster it is pushed
    double melt_s = 0.006;        ///< until flow has followed the pressure
    double ooze_mm_per_s = 0.02;  ///< runs out by itself while there is anything to run out
    double void_mm = 0.1;         ///< so much retracted nothing oozes any more
  };
  /// Whoever measured `assumed` was off by `error`, and three times that of the melt, each up or down by the
  /// seed; melt that flows the easier the faster it is pushed, and that oozes, nobody has told of.
  static Truth truth(const AdvanceModel& assumed, double error, std::uint64_t seed);

  /// Melt that nobody has measured: pressed together by 0.025 to 0.085 s.
  static Truth hidden(std::uint64_t seed);
  /// The advance that would take a step from one flow to another at once, mm over mm/s.
  static double secant_s(const Truth& truth, double from_mm_per_s, double to_mm_per_s);

  explicit Nozzle(const Truth& truth) : truth_(truth) {}
  /// Filament goes on by `fed_mm` evenly over dt_s. Returns what came out, mm of filament.
  double feed(double fed_mm, double dt_s);
  double pressed_mm() const { return pressed_; }

 private:
  Truth truth_;
  double pressed_ = 0, flow_ = 0;
};

}  // namespace kinebus
