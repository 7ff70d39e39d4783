#pragma once
// The pieces that are planned together, as arrays: where each begins, how fast it may be passed, what it
// leaves a ramp of the speed that passes it, and the slowest of any range.
//
// A bend has two speeds: that at which a ramp of the speed may pass it (some of the jerk is left then), and a
// higher one for constant speed only, which takes nearly all of the jerk. The higher one counts for a lone
// bend, a blend between straight pieces that are faster: ramps have room beside it. No other bend has it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gateway/motion/lookahead.hpp"

namespace kinebus {

class JerkWindow {
 public:
  /// Of a piece that is left: rounding of positions.
  static constexpr double kShortest_mm = 1e-9;

  /// What `path` holds; its first piece begins at `start`, mm.
  void load(const Lookahead& path, double start);

  std::size_t size() const { return speeds_.size(); }
  /// Where piece i begins, and piece i - 1 ends; i up to size().
  double start(std::size_t i) const { return starts_[i]; }
  double speed(std::size_t i) const { return speeds_[i]; }
  /// The same where a ramp passes it; lower than speed(i) in a lone bend only.
  double ramp_speed(std::size_t i) const { return ramp_speeds_[i]; }

  std::size_t piece_after(double position) const;   ///< the first that ends behind `position`
  std::size_t piece_before(double position) const;  ///< the last that begins before `position`
  /// The slowest piece of first .. last; the first of those that are alike.
  std::size_t lowest(std::size_t first, std::size_t last) const;

  /// The lower of `even` and of what piece i allows at speeds up to `speed`; false: neither is lower.
  bool lower(std::size_t i, double speed, PlanPiece::Even& even) const;
  /// Whether no ramp to more than `speed` passes piece i.
  bool blocks(std::size_t i, double speed) const;
  /// What the places next to `from` (`to`) allow a ramp that begins (ends) there, in piece first (last):
  /// ramps on both sides of a place would meet there, and each millisecond has one acceleration.
  PlanPiece::Even touching_from(double from, std::size_t first) const;
  PlanPiece::Even touching_to(double to, std::size_t last) const;

 private:
  void find_lone_bends(const Lookahead& path);

  std::vector<double> starts_, speeds_, ramp_speeds_;
  std::vector<std::array<PlanPiece::Even, PlanPiece::kRampSpeeds.size()>> even_;
  std::vector<double> touch_jerk_;
  std::vector<std::uint32_t> lowest_;  ///< tournament over speeds_
  std::size_t leaves_ = 0;
};

}  // namespace kinebus
