#pragma once
// Cutter compensation (G41, G42): canonical moves of the programmed path in, moves of the tool's axis out. A
// move is held back until the next one in the plane says where the corner between them is.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gateway/gcode/canonical.hpp"
#include "gateway/gcode/curves/curve.hpp"
#include "gateway/sentence.hpp"

namespace kinebus::gcode {

/// kBeside: off again, but the tool still stands beside the path until the next straight move.
enum class CutterSide : std::uint8_t { kOff, kLeft, kRight, kBeside };

/// The tool's path beside the programmed one. Plain data but for what it holds back.
///
/// First move (lead-in): a straight line from where the tool is to beside the end of the programmed one, or
/// an arc that comes in along the programmed one's direction at its end. Outside corners: an arc about the
/// corner, between traverses lines outside of it. Inside corners: where the paths meet. Post-condition for
/// feed moves at one height, up to kWindow of them in a row: no two of them that do not meet are cut each by
/// the tool beside the other (nearer than the radius, less kTolerance_mm). Lead-in and lead-out are free.
class CutterPath {
 public:
  using Axis3 = std::array<double, 3>;  ///< a unit vector
  static constexpr std::size_t kWindow = 200;
  static constexpr std::size_t kMostHeld = 1000;
  static constexpr double kTolerance_mm = 2e-5;

  /// `u`, `v`, `w`: the plane's axes in the coordinates of the commands; `tool`: where it is. `tip`: where in
  /// the plane the point is that the commands move, from the centre of the round that cuts.
  void begin(CutterSide side, double radius_mm, const Axis3& u, const Axis3& v, const Axis3& w,
             const Pose& tool, Frame frame, const Point2& tip = {});
  /// The held moves end where they are; the tool stays beside the programmed path.
  bool end(std::vector<canonical::Line>& out, Sentence& error);
  /// Takes one command while compensation is on. False: with `error`, and this and `out` are to be put back.
  bool take(canonical::Line line, std::vector<canonical::Line>& out, Sentence& error);

  const Pose& tool() const { return tool_; }

 private:
  struct Piece {
    Curve wall;      ///< as programmed
    Curve tool;      ///< beside it, from `start` on
    Point2 start{};  ///< where the tool really comes from
    std::uint32_t line = 0;
    bool entry = false, traverse = false, level = false;
  };
  struct Wall {
    Curve curve;
    std::uint32_t line = 0, number = 0;
  };
  struct Track {
    Curve curve;
    Wall beside;
    std::optional<Wall> before;  ///< the track goes around the corner of the two
  };

  bool take_move(canonical::Line& line, Pose& target, std::vector<canonical::Line>& out, Sentence& error);
  bool read(const canonical::Line& line, const Pose& target, Piece& next, Sentence& error) const;
  void centre_first(const Piece& next, double speed_per_s, std::vector<canonical::Line>& out);
  bool enter(Piece& next, Sentence& error) const;
  bool turn_corner(Piece& next, double speed_per_s, std::optional<Curve>& round,
                   std::vector<canonical::Line>& out, Sentence& error);
  bool meet_inside(Piece& next, Point2& corner) const;
  bool flush(const Point2& end, std::vector<canonical::Line>& out, Sentence& error);
  void go_round(const Point2& corner, double angle, const Piece& next, double speed_per_s,
                std::vector<canonical::Line>& out);
  void keep_wall(const Piece& next);
  bool keep_track(const Curve& curve, bool corner, Sentence& error);
  static bool meet(const Wall& a, const Wall& b);
  bool cuts(const Track& track, const Wall& wall) const;

  Point2 plane(const Pose& pose) const;
  double height(const Pose& pose) const;
  Pose with_plane(const Pose& pose, const Point2& point) const;
  /// The same with the centre of what cuts at `centre`.
  Pose with_centre(const Pose& pose, const Point2& centre) const { return with_plane(pose, centre + tip_); }

  double left_mm_ = 0;  ///< the tool's distance to the left
  Axis3 u_{}, v_{}, w_{};
  Frame frame_{};
  Point2 tip_{};
  Pose tool_{};        ///< behind what was given out
  Pose programmed_{};  ///< behind what was taken
  bool has_last_ = false;
  bool apart_ = true;  ///< the contour of which gouges are looked for begins anew
  Piece last_;
  std::vector<canonical::Line> held_;  ///< the last move in the plane, and what came behind it
  std::uint32_t number_ = 0;           ///< walls so far
  std::vector<Wall> walls_;
  std::vector<Track> tracks_;
};

}  // namespace kinebus::gcode
