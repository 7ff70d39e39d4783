#pragma once
// Filament on its way from the spool to the extruder, through a switch and past a wheel with play, whose
// slots are not quite alike and further apart than its data sheet says.

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kinebus::heat {

class FilamentPlant {
 public:
  static constexpr double kEdge = 2.93;   // mm, in the mean
  static constexpr double kPlay = 0.35;   // mm that the wheel does not follow after a turn
  static constexpr double kUneven = 0.4;  // mm by which every second edge is late

  // What can break, at any time.
  bool out = false;  ///< its end has passed the switch
  double share = 1;  ///< of what the extruder turns forward; 0: jammed, the gears grind

  /// One sample's time, 10 ms. `extruder_mm`: where its gears have turned to.
  void step(double extruder_mm) {
    const double turned = met_ ? extruder_mm - extruder_ : 0;
    met_ = true;
    extruder_ = extruder_mm;
    moved_ += turned > 0 ? turned * share : turned;
    // Behind its end the gears draw on what is left between them and the wheel: that stands.
    if (!out)
      wheel_ = std::clamp(wheel_, moved_ - kPlay / 2, moved_ + kPlay / 2);
    else
      moved_ = wheel_;
    const std::int64_t at = slot();
    edges_ += static_cast<std::uint32_t>(std::abs(at - slot_));
    slot_ = at;
    bounces_ = out != was_out_ ? kBounces : std::max(bounces_ - 1, 0);
    was_out_ = out;
  }
  /// Of the switch; high: filament.
  bool level() const { return out == (bounces_ % 2 != 0); }
  std::uint32_t take_edges() {
    const std::uint32_t edges = edges_;
    edges_ = 0;
    return edges;
  }
  /// mm that have gone past the wheel.
  double moved() const { return moved_; }

 private:
  static constexpr int kBounces = 3;  // samples
  std::int64_t slot() const {
    const auto pair = static_cast<std::int64_t>(std::floor(wheel_ / (2 * kEdge)));
    return 2 * pair + (wheel_ - static_cast<double>(pair) * 2 * kEdge >= kEdge + kUneven ? 1 : 0);
  }

  bool met_ = false, was_out_ = false;
  double extruder_ = 0, moved_ = 0, wheel_ = 0;
  std::int64_t slot_ = 0;
  std::uint32_t edges_ = 0;
  int bounces_ = 0;
};

}  // namespace kinebus::heat
