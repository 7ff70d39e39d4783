#pragma once
// The G-code of one piece as a slicer wrote it, read into moves that can be set into a larger job.

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
  std::array<std::optional<double>, 3> to_mm;  ///< X Y Z, absolute in the piece's frame, where stated
  std::string arc;                             ///< the words I, J, K, R of an arc, as they stood
  double e_mm = 0;                             ///< filament fed by this move (negative: drawn back)
  std::optional<double> feed_mm_per_min;
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

/// Units mm, absolute X Y Z; E absolute or relative. Throws std::runtime_error "NAME:line: ..." for text that
/// is not G-code and for commands that cannot be set into a tilted frame (G20, G91 with axes, G53 to G59,
/// G68, tools other than T0, G92 of axes).
SlicedGcode read_sliced(std::string_view text, const std::string& name);

}  // namespace kinebus::compose
