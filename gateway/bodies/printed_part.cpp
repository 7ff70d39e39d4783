#include "gateway/bodies/printed_part.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus::bodies {
namespace {

/// The tool counts from here on up: its tip touches what it prints, and lies deeper than what is printed
/// beside it on layers that are not flat. Layers that rise against the tool by up to 30 deg go free of a tool
/// of 4 mm.
constexpr double kTip_mm = 2.5;
/// The holder is looked for so much farther than it must, so as not to be looked for again at the next pose.
constexpr double kReserve_mm = 8;

/// By so much at a time the extent grows.
constexpr double kGrows_mm = 4;

/// Filament up to this height lies on the table. Elsewhere it is part of what is printed if there is some of
/// that, this far along each axis or a block farther: what hangs in the air hangs from something, or falls.
constexpr std::uint32_t kHolds_mm = 2;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

Vec back_to_table(const Pose& pose, const Vec& v) {
  const Vector3 t = turn_back_z(Turn(pose[kC]), turn_back_x(Turn(pose[kA]), {v.x, v.y, v.z}));
  return {t[0], t[1], t[2]};
}

Vec least(const Vec& a, const Vec& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
Vec most(const Vec& a, const Vec& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

}  // namespace

Vec tip_on_table(Frame frame, const Pose& pose) {
  const Vec v{pose[kX], pose[kY], pose[kZ]};
  if (frame == Frame::kPart || (pose[kA] == 0 && pose[kC] == 0)) return v;
  return back_to_table(pose, v);
}

PrintedPart::PrintedPart()
    : chunk_at_(std::size_t{kChunksAcross} * kChunksAcross * kChunksAcross),
      chunks_(std::make_unique_for_overwrite<Chunk[]>(kMostChunks)) {
  clear();
}

void PrintedPart::clear() {
  std::fill(chunk_at_.begin(), chunk_at_.end(), kNone);
  used_ = 0;
  last_ = ~std::uint64_t{0};
  low_ = {kInfinite, kInfinite, kInfinite};
  high_ = -low_;
  extent_ = {low_, high_, 0};
  ++extents_;
}

void PrintedPart::widen(const Vec& middle) {
  const auto down = [](double x) { return kGrows_mm * std::floor(x / kGrows_mm); };
  const auto up = [](double x) { return kGrows_mm * std::ceil(x / kGrows_mm); };
  extent_.low = least(extent_.low, {down(middle.x), down(middle.y), down(middle.z)});
  extent_.high = most(extent_.high, {up(middle.x), up(middle.y), up(middle.z)});
  extent_.radius_mm = std::max(extent_.radius_mm, up(std::hypot(middle.x, middle.y)));
  ++extents_;
}

void PrintedPart::add(const Vec& point) {
  const double x = point.x + kMiddle_mm, y = point.y + kMiddle_mm, z = point.z + kBelow_mm;
  constexpr double kAcross = kChunk_mm * kChunksAcross;
  if (!(x >= 0 && y >= 0 && z >= 0 && x < kAcross && y < kAcross && z < kAcross)) return;
  const auto ix = static_cast<std::uint32_t>(x), iy = static_cast<std::uint32_t>(y),
             iz = static_cast<std::uint32_t>(z);
  const std::uint64_t cell = (std::uint64_t{iz} << 20u) | (iy << 10u) | ix;
  if (cell == last_) return;
  const auto near = [](std::uint32_t a, std::uint32_t b) { return a <= b + kHolds_mm && b <= a + kHolds_mm; };
  const auto coordinate = [this](unsigned shift) {
    return static_cast<std::uint32_t>(last_ >> shift) & 1023u;
  };
  const bool follows = last_ != ~std::uint64_t{0} && near(ix, coordinate(0)) && near(iy, coordinate(10)) &&
                       near(iz, coordinate(20));
  const auto held = [&] {
    struct Range {
      std::uint32_t first, last;
    };
    const auto blocks = [](std::uint32_t i) {
      constexpr std::uint32_t kLast = kChunk_mm * kChunksAcross - 1;
      return Range{(i - std::min(i, kHolds_mm)) / kBlock_mm, std::min(i + kHolds_mm, kLast) / kBlock_mm};
    };
    const Range bx = blocks(ix), by = blocks(iy), bz = blocks(iz);
    for (std::uint32_t k = bz.first; k <= bz.last; ++k)
      for (std::uint32_t j = by.first; j <= by.last; ++j)
        for (std::uint32_t i = bx.first; i <= bx.last; ++i) {
          const std::uint16_t chunk = chunk_at_[((k >> 3u) << 10u) | ((j >> 3u) << 5u) | (i >> 3u)];
          if (chunk != kNone && chunks_[chunk][((k & 7u) << 6u) | ((j & 7u) << 3u) | (i & 7u)] != 0)
            return true;
        }
    return false;
  };
  if (!follows && iz >= kBelow_mm + kHolds_mm && !held()) return;
  last_ = cell;
  std::uint16_t& at = chunk_at_[((iz >> 5u) << 10u) | ((iy >> 5u) << 5u) | (ix >> 5u)];
  if (at == kNone) {
    if (used_ == kMostChunks) return;
    at = static_cast<std::uint16_t>(used_++);
    chunks_[at].fill(0);
  }
  const std::uint32_t block = (((iz >> 2u) & 7u) << 6u) | (((iy >> 2u) & 7u) << 3u) | ((ix >> 2u) & 7u);
  chunks_[at][block] |= std::uint64_t{1} << (((iz & 3u) << 4u) | ((iy & 3u) << 2u) | (ix & 3u));
  const Vec middle{ix + 0.5 - kMiddle_mm, iy + 0.5 - kMiddle_mm, iz + 0.5 - kBelow_mm};
  low_ = least(low_, middle);
  high_ = most(high_, middle);
  const Extent& e = extent_;
  if (!(middle.x >= e.low.x && middle.y >= e.low.y && middle.z >= e.low.z && middle.x <= e.high.x &&
        middle.y <= e.high.y && middle.z <= e.high.z &&
        middle.x * middle.x + middle.y * middle.y <= e.radius_mm * e.radius_mm))
    widen(middle);
}

template <typename Distance>
bool PrintedPart::any_near(const Vec& low, const Vec& high, double near_mm, const Distance& distance) const {
  // From a middle to the middles of the farthest cells of its chunk or block.
  constexpr double kOfChunk_mm = 15.5 * 1.7320509, kOfBlock_mm = 1.5 * 1.7320509;
  const Vec margin{near_mm, near_mm, near_mm};
  const Vec from = most(low - margin, low_), to = least(high + margin, high_);
  if (!(from.x <= to.x && from.y <= to.y && from.z <= to.z)) return false;
  // Within the cells there are, all of these are in the grid.
  struct Range {
    int first, last;
  };
  const auto range = [](double a, double b, int zero) {
    return Range{static_cast<int>(std::floor(a)) + zero, static_cast<int>(std::floor(b)) + zero};
  };
  const Range x = range(from.x, to.x, kMiddle_mm), y = range(from.y, to.y, kMiddle_mm),
              z = range(from.z, to.z, kBelow_mm);
  const auto at = [](int ix, int iy, int iz, double half) {
    return Vec{ix + half - kMiddle_mm, iy + half - kMiddle_mm, iz + half - kBelow_mm};
  };
  const auto place = [](int i, int j, int k, std::size_t across) {
    return (static_cast<std::size_t>(k) * across + static_cast<std::size_t>(j)) * across +
           static_cast<std::size_t>(i);
  };
  const auto in_block = [&](std::uint64_t cells, int bx, int by, int bz) {
    for (; cells != 0; cells &= cells - 1) {
      const int bit = std::countr_zero(cells);
      if (distance(at(bx + (bit & 3), by + (bit >> 2 & 3), bz + (bit >> 4), 0.5)) < near_mm) return true;
    }
    return false;
  };
  const auto in_chunk = [&](const Chunk& chunk, int cx, int cy, int cz) {
    const auto blocks = [](const Range& r, int c) {
      return Range{std::max(r.first - c, 0) / kBlock_mm, std::min(r.last - c, kChunk_mm - 1) / kBlock_mm};
    };
    const Range i = blocks(x, cx), j = blocks(y, cy), k = blocks(z, cz);
    for (int bz = k.first; bz <= k.last; ++bz)
      for (int by = j.first; by <= j.last; ++by)
        for (int bx = i.first; bx <= i.last; ++bx) {
          const std::uint64_t cells = chunk[place(bx, by, bz, kBlocksAcross)];
          if (cells == 0) continue;
          const int fx = cx + bx * kBlock_mm, fy = cy + by * kBlock_mm, fz = cz + bz * kBlock_mm;
          if (distance(at(fx, fy, fz, 0.5 * kBlock_mm)) < near_mm + kOfBlock_mm &&
              in_block(cells, fx, fy, fz))
            return true;
        }
    return false;
  };
  const auto chunk_of = [](int i) { return i / kChunk_mm; };
  for (int cz = chunk_of(z.first); cz <= chunk_of(z.last); ++cz)
    for (int cy = chunk_of(y.first); cy <= chunk_of(y.last); ++cy)
      for (int cx = chunk_of(x.first); cx <= chunk_of(x.last); ++cx) {
        const std::uint16_t chunk = chunk_at_[place(cx, cy, cz, kChunksAcross)];
        if (chunk == kNone) continue;
        const int fx = cx * kChunk_mm, fy = cy * kChunk_mm, fz = cz * kChunk_mm;
        if (distance(at(fx, fy, fz, 0.5 * kChunk_mm)) < near_mm + kOfChunk_mm &&
            in_chunk(chunks_[chunk], fx, fy, fz))
          return true;
      }
  return false;
}

bool PrintedPart::comes_near(const Shape& solid, double near_mm) const {
  const auto reach = [&](const Vec& axis) { return reach_along(solid, axis); };
  const Vec low{-reach({-1, 0, 0}), -reach({0, -1, 0}), -reach({0, 0, -1})},
      high{reach({1, 0, 0}), reach({0, 1, 0}), reach({0, 0, 1})};
  return any_near(low, high, near_mm, [&](const Vec& point) { return distance_mm(solid, point); });
}

PrintWatch::PrintWatch(const BodiesDescription& b)
    : tool_radius_mm_(b.tool_radius_mm),
      tool_from_mm_(std::min(kTip_mm + b.tool_radius_mm, b.tool_length_mm)),
      tool_to_mm_(b.tool_length_mm),
      holder_radius_mm_(b.holder_radius_mm),
      holder_from_mm_(b.tool_length_mm),
      holder_to_mm_(b.tool_length_mm + b.holder_length_mm),
      // What is printed on the way through the reserve is at the tip: it must be farther from the holder.
      reserve_mm_(std::min(kReserve_mm, b.tool_length_mm / 3)) {}

std::optional<BodyKind> PrintWatch::meets(const PrintedPart& part, Frame frame, const Pose& pose) {
  if (part.empty()) return std::nullopt;
  const Vec tip = tip_on_table(frame, pose);
  // Upright, nothing of the tool is lower than where it begins to count.
  if (pose[kA] == 0 && tip.z + kTip_mm >= part.top_mm() + PrintedPart::kSkin_mm) return std::nullopt;
  const Vec axis = back_to_table(pose, {0, 0, 1});
  if (tool_meets(part, tip, axis)) return BodyKind::kTool;
  // The holder has moved by no more than its tip, and its end against that.
  if (free_ &&
      norm(tip - free_->tip) + norm(axis - free_->axis) * (holder_to_mm_ + holder_radius_mm_) < reserve_mm_)
    return std::nullopt;
  free_.reset();
  if (!holder_meets(part, tip, axis, PrintedPart::kSkin_mm + reserve_mm_))
    free_ = Free{tip, axis};
  else if (holder_meets(part, tip, axis, PrintedPart::kSkin_mm))
    return BodyKind::kHolder;
  return std::nullopt;
}

bool PrintWatch::tool_meets(const PrintedPart& part, const Vec& tip, const Vec& axis) const {
  const Vec from = tip + tool_from_mm_ * axis, to = tip + tool_to_mm_ * axis;
  const double length = tool_to_mm_ - tool_from_mm_;
  const Vec around{tool_radius_mm_, tool_radius_mm_, tool_radius_mm_};
  return part.any_near(least(from, to) - around, most(from, to) + around, PrintedPart::kSkin_mm,
                       [&](const Vec& point) {
                         const double along = std::clamp(dot(point - from, axis), 0.0, length);
                         return norm(point - from - along * axis) - tool_radius_mm_;
                       });
}

bool PrintWatch::holder_meets(const PrintedPart& part, const Vec& tip, const Vec& axis,
                              double near_mm) const {
  const Vec from = tip + holder_from_mm_ * axis, to = tip + holder_to_mm_ * axis;
  const double half = 0.5 * (holder_to_mm_ - holder_from_mm_);
  const auto aside = [&](double along) {
    return holder_radius_mm_ * std::sqrt(std::max(0.0, 1 - along * along));
  };
  const Vec around{aside(axis.x), aside(axis.y), aside(axis.z)};
  const Vec middle = 0.5 * (from + to);
  return part.any_near(least(from, to) - around, most(from, to) + around, near_mm, [&](const Vec& point) {
    const Vec off = point - middle;
    const double along = dot(off, axis), across = std::sqrt(std::max(0.0, dot(off, off) - along * along));
    return std::max(std::abs(along) - half, across - holder_radius_mm_);
  });
}

}  // namespace kinebus::bodies
