#pragma once
// Pressure advance: how far filament is pressed together in front of the nozzle, so that it flows out as
// planned.

#include <array>
#include <cstdint>

#include "gateway/motion/trajectory.hpp"

namespace kinebus {

enum class AdvanceKind : std::uint8_t {
  kLinear,      ///< A(v) = K v
  kTanh,        ///< A(v) = K v + N tanh(v / V): melt that flows the easier, the faster it is pushed
  kReciprocal,  ///< A(v) = K v + N (1 - 1 / (1 + v / V))
};

/// By how much filament runs ahead of its plan, mm, while it is fed with v >= 0 mm/s along a moving tool.
struct AdvanceModel {
  static constexpr double kMost_s = 2, kLeastSmooth_s = 0.002, kMostSmooth_s = 0.2, kMostMelt_s = 0.1;
  AdvanceKind kind = AdvanceKind::kLinear;
  double advance_s = 0;           ///< K
  double nonlinear_mm = 0;        ///< N
  double nonlinear_mm_per_s = 1;  ///< V, > 0
  /// Until the flow has followed the pressure: T of A + T dA/dt, which is what a melt of second order takes.
  double melt_s = 0;
  double smooth_s = 0.015;  ///< the advance is its mean over so much path time
  bool acts() const { return steepest_s() > 0; }
  double at(double flow_mm_per_s) const;       ///< A(v), mm
  double slope_s(double flow_mm_per_s) const;  ///< dA/dv
  double steepest_s() const { return slope_s(0); }
  /// E accelerates at most so many times as the flow: while that accelerates by at most a, the mean of A over
  /// a window w accelerates by at most 2 K a / w, where the tool brakes and speeds up within it, and the
  /// melt's term by 4 K T a / w^2.
  double most_gain() const { return 1 + steepest_s() / smooth_s * (2 + 4 * melt_s / smooth_s); }
  double most_bend_s2_per_mm() const;  ///< the greatest |d2A/dv2|
  friend bool operator==(const AdvanceModel&, const AdvanceModel&) = default;
};

/// How the sum of A along a plan makes the advance, mean and rate of change over a window w:
///   (S(t + w/2) - S(t - w/2)) / w + T (S(t + w) - 2 S(t) + S(t - w)) / w^2
struct AdvanceWindow {
  double smooth_s = 0;  ///< w; 0: there is no advance
  double melt_s = 0;    ///< T
  AdvanceWindow() = default;
  explicit AdvanceWindow(const AdvanceModel& model)
      : smooth_s(model.acts() ? model.smooth_s : 0), melt_s(model.acts() ? model.melt_s : 0) {}
  bool acts() const { return smooth_s > 0; }
  /// It looks so far ahead, and as far back.
  double reach_s() const { return melt_s > 0 ? smooth_s : 0.5 * smooth_s; }
  friend bool operator==(const AdvanceWindow&, const AdvanceWindow&) = default;
};

/// The tool moves somewhere on the phase, and not filament alone.
bool moves_tool(const Phase& phase);

/// The advance that one phase asks for, summed up over its time. Filament counts where it is fed forward
/// while the tool moves: a retraction, its recovery and a wipe do not press on the melt of a bead.
class PhaseAdvance {
 public:
  struct Sum {
    double x = 0, x1 = 0, x2 = 0;  ///< integral of A, mm s; A, mm; dA/dt, mm/s
  };
  PhaseAdvance() = default;
  /// Filament that beads take along a phase, a polynomial of its s.
  using Filament = std::array<double, 4>;
  PhaseAdvance(const Phase& phase, const Filament& filament, const AdvanceModel& model);
  /// At t seconds after the phase's start; both as they were.
  Sum at(const Phase& phase, const Filament& filament, double t) const;
  /// No cubic in time.
  bool curved() const { return way_ == Way::kNumeric; }

 private:
  enum class Way : std::uint8_t { kNothing, kProportional, kNumeric };
  static double flow(const Phase& phase, const Filament& filament, double t);
  /// The integral of A from one place where filament turns about, or the start, to the next.
  double stretch(const Phase& phase, const Filament& filament, double from, double to) const;
  void find_turns(const Phase& phase, const Filament& filament);
  AdvanceModel model_;
  Way way_ = Way::kNothing;
  std::array<double, 2> turns_{};  ///< where filament turns about, s after the start
  int turn_count_ = 0;
};

}  // namespace kinebus
