#pragma once
// How far a pose is from the programmed path: the measure of checkers and tests, independent of the planner's
// own idea of the path. Fed with the same canonical commands; a window moves along with the queries.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "gateway/gcode/canonical.hpp"
#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

class PathDistance {
 public:
  /// Takes Traverse, Feed, Arc and SetPosition; ignores the rest. May run ahead of the queries without bound;
  /// moves that the queries have left behind are dropped.
  void add(const canonical::Line& line);

  /// Distance in X Y Z (mm) from `pose` to the nearest point of the programmed moves around the place of the
  /// last query, looking ahead as far as `line`. Queries go along the path. Cost: < 0.5 us for queries of a
  /// millisecond.
  double distance_mm(const Pose& pose, std::uint32_t line);

  /// Moves behind the one that the last query found nearest.
  std::size_t ahead() const { return moves_.empty() ? 0 : moves_.size() - 1 - nearest_; }

  /// Job line of the move that the last query found nearest.
  std::uint32_t nearest_line() const { return nearest_line_; }

 private:
  struct Move {
    std::array<double, 3> from{}, to{};
    bool arc = false;
    std::array<double, 3> centre{}, normal{};
    double sweep_rad = 0;
    double length_mm = 0;
    std::uint32_t line = 0;
  };
  struct Place {
    double distance2 = 0;  ///< mm^2
    double part = 0;       ///< of the move, 0 to 1
  };
  struct Found {
    Place place;
    std::size_t move;
  };
  static Place nearest_on_line(const Move& move, const std::array<double, 3>& point);
  static Place nearest_on(const Move& move, const std::array<double, 3>& point);
  /// Among the moves around the last place, of which none begins farther along the path than `reach_mm` from
  /// it.
  Found search(const std::array<double, 3>& point, std::uint32_t line, double reach_mm) const;

  std::deque<Move> moves_;
  std::size_t nearest_ = 0;
  double part_ = 0;                            // of it, where the last query was
  std::optional<std::array<double, 3>> last_;  // the last query
  std::uint32_t nearest_line_ = 0;
  Pose end_{};
};

}  // namespace kinebus
