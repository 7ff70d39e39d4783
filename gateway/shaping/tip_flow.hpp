#pragma once
// Filament along the tip's way, as a vector: where several directions are averaged, what is left of the way
// is what filament is laid on.

#include <array>

#include "gateway/motion/trajectory.hpp"

namespace kinebus {

/// The tip moves, and filament is fed forward somewhere on the phase.
bool feeds_along_tip(const Phase& phase);

/// Filament fed (mm/s) in the direction of the tip's motion, and its change.
struct TipFlow {
  std::array<double, 3> v{}, v1{};
  /// What is fed while the tip halts in a sharp turn, or drawn back, lies nowhere along its way.
  double apart = 0, apart1 = 0;
  /// The planned flow t seconds after the phase's start, by the axes' weights. The tip moves on the phase.
  void add(const std::array<double, 3>& weight, const Phase& phase, double t);
  double rate() const;    ///< of beads, mm/s
  double change() const;  ///< of that, mm/s^2; 0 where nothing flows
};

}  // namespace kinebus
