#pragma once
// The pieces' G-codes joined into one five-axis job: each piece in its own tilted plane (G68.2), the tool
// turned to it (G53.1) above everything that is printed, tool centre point control (G43.4) all the while.

#include <string>
#include <vector>

#include "tools/compose/piece_frame.hpp"
#include "tools/compose/sliced_gcode.hpp"

namespace kinebus::compose {

struct JoinPiece {
  std::string name;
  PieceFrame frame;
  SlicedGcode gcode;
  Box box;  ///< of the piece in part coordinates, mm; empty when the mesh is not known
};

struct JoinOptions {
  double hotend_celsius = 205, bed_celsius = 60;  ///< where no piece states them
  double clearance_mm = 20;                       ///< of the tool over all that is printed while it turns
  double retract_mm = 0.8;
  double retract_mm_per_min = 2100;
  double travel_mm_per_min = 9000;
};

/// Lines of the job (from 1) that belong to a piece; the way to it included.
struct LineRange {
  int first = 0, last = 0;
};

struct JoinedJob {
  std::string text;
  std::vector<LineRange> pieces;
};

JoinedJob join(const std::vector<JoinPiece>& pieces, const JoinOptions& options);

}  // namespace kinebus::compose
