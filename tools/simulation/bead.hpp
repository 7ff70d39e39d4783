#pragma once
// How wide the bead comes out along the path, to what the job asks for.

#include <array>
#include <cstdint>
#include <unordered_map>

#include "gateway/pose.hpp"
#include "tools/simulation/nozzle.hpp"

namespace kinebus {

/// Filament for a millimetre of path, by the job's lines that print.
class BeadLines {
 public:
  /// A stretch of line's path. The longest of its stretches counts: the others lead into corners. A line with
  /// a stretch of filament alone (a recovery) lays no bead, though a corner leads into it, too.
  void add(std::uint32_t line, double length_mm, double filament_mm);
  double filament_per_mm(std::uint32_t line) const;

 private:
  struct Line {
    double length_mm = 0, per_mm = 0;
    bool alone = false;
  };
  std::unordered_map<std::uint32_t, Line> lines_;
};

/// Filament through a nozzle, laid along the tip's path. At one height a bead is as wide as what lies there:
/// its error is that of the filament on each kBead_mm of path, about a nozzle's bore.
class BeadMeter {
 public:
  static constexpr double kBead_mm = 0.4;
  /// `lines` must outlive this.
  BeadMeter(const Nozzle::Truth& truth, const BeadLines& lines) : nozzle_(truth), lines_(&lines) {}

  /// The tip (mm) and the filament (mm) dt_s after the call before; `line`: the job's, in motion.
  void move_to(const std::array<double, 3>& tip_mm, double filament_mm, std::uint32_t line, double dt_s);

  double rms() const;  ///< of width, share
  double worst() const { return worst_; }
  std::uint32_t worst_line() const { return worst_line_; }
  std::uint64_t beads() const { return beads_; }
  double pressed_mm() const { return nozzle_.pressed_mm(); }

 private:
  Nozzle nozzle_;
  const BeadLines* lines_;
  bool placed_ = false;
  std::array<double, 3> tip_{};
  double filament_ = 0;
  double length_ = 0, asked_ = 0, laid_ = 0;  ///< of the bead at work
  double squares_ = 0, worst_ = 0;
  std::uint32_t worst_line_ = 0;
  std::uint64_t beads_ = 0;
};

}  // namespace kinebus
