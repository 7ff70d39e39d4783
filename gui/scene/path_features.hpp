#pragma once
// What a slicer made each line of a job for, out of its comments: ";TYPE:External perimeter" (PrusaSlicer,
// Slic3r, SuperSlicer), ";TYPE:WALL-OUTER" (Cura), "; FEATURE: Outer wall" (Orca, Bambu), "; feature outer
// perimeter" (Simplify3D).

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinebus::gui {

enum class PathFeature : std::uint8_t {
  kOther,
  kOuterWall,
  kInnerWall,
  kInfill,
  kSolid,  ///< top, bottom and other closed areas
  kBridge,
  kSupport,
  kSkirt,  ///< brim, raft, wipe tower: beside the part
  kGap,    ///< thin walls, gaps, ironing
};
inline constexpr std::size_t kPathFeatures = 9;

/// What the words of such a comment mean.
PathFeature feature_named(std::string_view words);

/// Finds them in a text that comes in parts, cut anywhere.
class FeatureScanner {
 public:
  /// From `line` (1-based) on.
  struct Change {
    std::uint32_t line = 0;
    PathFeature feature{};
  };
  void add(std::string_view text);
  /// Ends the last line.
  std::vector<Change> finish();

 private:
  void end_line();

  static constexpr std::size_t kLongest = 64;  ///< a longer comment names no feature
  std::vector<Change> changes_;
  std::string head_;  ///< of the line at work, if it is a comment
  bool comment_ = false, begun_ = false;
  std::uint32_t line_ = 1;
};

}  // namespace kinebus::gui
