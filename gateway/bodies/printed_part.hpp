#pragma once
// What a job has printed so far, as a body: it grows with every extruding move, stands on the table and turns
// with it. Tool and holder must keep out of it; the tip, which lays it down, may touch it.
//
// It is kept in cells of 1 mm, table coordinates: what was printed lies within 0.87 mm of the middle of a
// cell that is taken. So tool and holder that are 0.4 mm deep in it are always found, and what keeps 1.6 mm
// away from it is never refused.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/bodies/bodies_description.hpp"
#include "gateway/bodies/collision_model.hpp"
#include "gateway/bodies/shape.hpp"
#include "gateway/pose.hpp"

namespace kinebus::bodies {

/// The tool's tip in table coordinates.
Vec tip_on_table(Frame frame, const Pose& pose);

class PrintedPart {
 public:
  PrintedPart();

  /// The table is empty.
  void clear();
  bool empty() const { return used_ == 0; }
  /// Filament comes there, table coordinates. In the air, with nothing printed near it, it is no part. What
  /// is beyond 512 mm along X and Y, or 992 above the table, is not kept, nor what is too much. Allocates
  /// nothing.
  void add(const Vec& point);

  /// A middle of a cell comes nearer than `near_mm` to the solid, whose distance from a point is not less
  /// than `distance(point)`; `low`, `high`: a box around the solid.
  template <typename Distance>
  bool any_near(const Vec& low, const Vec& high, double near_mm, const Distance& distance) const;
  /// The highest cell's middle.
  double top_mm() const { return high_.z; }

  /// Around the middles of all cells, and a little more, so that it seldom grows: a box, and how far it
  /// reaches from the table's axis.
  struct Extent {
    Vec low{}, high{};
    double radius_mm = 0;
  };
  /// Not when empty.
  const Extent& extent() const { return extent_; }
  /// Counts how often extent() has changed.
  std::uint64_t extents() const { return extents_; }
  /// A middle of a cell comes nearer than `near_mm` to the solid, which is in table coordinates. Allocates
  /// nothing.
  bool comes_near(const Shape& solid, double near_mm) const;

  /// Half of a cell: so near to a cell's middle is in the part.
  static constexpr double kSkin_mm = 0.5;
  /// From a cell's middle to its corner: what was printed is not farther from the one it is in.
  static constexpr double kCorner_mm = 0.87;

 private:
  // Cells in blocks of 4 x 4 x 4, a bit each; blocks in chunks of 8 x 8 x 8. A cube of 32 mm that has nothing
  // in it takes no memory, and no time.
  static constexpr int kChunk_mm = 32, kChunksAcross = 32, kBlock_mm = 4, kBlocksAcross = 8;
  static constexpr int kMiddle_mm = 512, kBelow_mm = 32;  ///< from the first cell to the table's zero
  static constexpr std::size_t kMostChunks = 1024;
  static constexpr std::uint16_t kNone = 0xFFFF;
  using Chunk = std::array<std::uint64_t, std::size_t{kBlocksAcross} * kBlocksAcross * kBlocksAcross>;

  std::vector<std::uint16_t> chunk_at_;
  std::unique_ptr<Chunk[]> chunks_;  ///< untouched until used
  std::size_t used_ = 0;
  std::uint64_t last_ = ~std::uint64_t{0};  ///< cell taken last
  Vec low_{}, high_{};                      ///< around all middles of cells
  Extent extent_{};
  std::uint64_t extents_ = 0;

  void widen(const Vec& middle);
};

/// Whether tool or holder would be in the printed part, pose after pose.
class PrintWatch {
 public:
  explicit PrintWatch(const BodiesDescription& bodies);

  /// The next pose does not follow from the last, or the part has grown elsewhere than at the tool's tip.
  void jump() { free_.reset(); }
  /// Which of both; nullopt: none. Allocates nothing; next to nothing for an upright tool above all there is.
  std::optional<BodyKind> meets(const PrintedPart& part, Frame frame, const Pose& pose);

 private:
  bool holder_meets(const PrintedPart& part, const Vec& tip, const Vec& axis, double near_mm) const;
  bool tool_meets(const PrintedPart& part, const Vec& tip, const Vec& axis) const;

  double tool_radius_mm_, tool_from_mm_, tool_to_mm_;  ///< the tool's middle line, from the tip
  double holder_radius_mm_, holder_from_mm_, holder_to_mm_;
  double reserve_mm_;  ///< what the holder is looked for farther than it must
  struct Free {
    Vec tip{}, axis{};
  };
  std::optional<Free> free_;  ///< here the holder had its reserve
};

}  // namespace kinebus::bodies
