#pragma once
// The G-code of one piece as a slicer wrote it, as moves that can be set into a larger job. Read by the
// gateway's interpreter: units, offsets, distance modes, arcs and expressions are worked out there.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kinebus::compose {

struct SlicedMove {
  int code = 1;                                ///< G0 .. G3
  std::array<std::optional<double>, 3> to_mm;  ///< X Y Z, absolute in the piece's frame, where they change
  int plane = 17;                              ///< of an arc: G17, G18, G19
  std::string arc;                             ///< words I, J, K, P of an arc, from its start, mm
  double e_mm = 0;                             ///< filament fed by this move (negative: drawn back)
  std::optional<double> feed_mm_per_min;       ///< where it changes
};

/// A move, or a line that goes into the job as it is (fan, dwell, comment).
using SlicedItem = std::variant<SlicedMove, std::string>;

struct SlicedGcode {
  std::vector<SlicedItem> items;
  std::optional<double> hotend_celsius, bed_celsius;  ///< the first that the slicer set
  std::map<std::string, int>
      left_out;            ///< commands that belong to a job of its own (G28, M84 ...), with their number
  double filament_mm = 0;  ///< net length fed
  int layers = 0;          ///< different heights at which filament was fed
};

/// Throws std::runtime_error "NAME:line: ..." for text that is not G-code and for what cannot be set into a
/// tilted frame: G43.4, G68.2, turns of A and C, tools other than T0, filament fed before X, Y and Z are
/// stated.
SlicedGcode read_sliced(std::string_view text, const std::string& name);

}  // namespace kinebus::compose
