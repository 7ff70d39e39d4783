#pragma once
// Nothing is ever hotter than its limit and 5 K, whatever breaks; no filament is pushed through a cold hot
// end. Blocks as they are, not as sensors tell.

#include <algorithm>
#include <string>
#include <utility>

#include "gateway/description/machine_description.hpp"

namespace kinebus {

/// Of hot end and bed, C.
struct Blocks {
  double hot_end_c = 0, bed_c = 0;
};

class HeatChecker {
 public:
  explicit HeatChecker(const MachineDescription& machine) : min_extrude_c_(machine.thermal.min_extrude_c) {
    for (const HeaterDescription& h : machine.heaters)
      (h.kind == HeaterKind::kBed ? bed_limit_c_ : hotend_limit_c_) = h.wiring.limit_for(h.max_c);
  }

  /// `extruder_mm`: where its motor has turned to.
  void on_sample(double time_s, const Blocks& blocks, double extruder_mm) {
    hot("the hot end", time_s, blocks.hot_end_c, hotend_limit_c_);
    hot("the bed", time_s, blocks.bed_c, bed_limit_c_);
    hottest_c_ = std::max(hottest_c_, blocks.hot_end_c);
    if (!std::exchange(met_, true)) furthest_mm_ = extruder_mm;
    feeds_ = extruder_mm > furthest_mm_ + kFed;
    if (!feeds_) return;
    furthest_mm_ = extruder_mm;
    coldest_c_ = std::min(coldest_c_, blocks.hot_end_c);
    if (blocks.hot_end_c < min_extrude_c_ - kSensorOff && complaint_.empty())
      complain("filament is fed through the hot end", time_s, blocks.hot_end_c);
  }

  /// The nearest that one came to its limit, K; the coldest hot end that was fed; the hottest one, C.
  double nearest_k() const { return nearest_k_; }
  double coldest_c() const { return coldest_c_; }
  double hottest_c() const { return hottest_c_; }
  /// Filament was fed farther than ever, up to the last sample.
  bool feeds() const { return feeds_; }
  /// It has ever been.
  bool has_fed() const { return coldest_c_ < kNever; }
  const std::string& complaint() const { return complaint_; }

 private:
  static constexpr double kOver = 5, kSensorOff = 3;  // K
  static constexpr double kFed = 0.05;                // mm
  static constexpr double kNever = 1000;

  void complain(const std::string& what, double time_s, double celsius) {
    complaint_ = what + " at " + std::to_string(celsius) + " C, at " + std::to_string(time_s) + " s";
  }
  void hot(const char* what, double time_s, double celsius, double limit) {
    nearest_k_ = std::min(nearest_k_, limit - celsius);
    if (celsius > limit + kOver && complaint_.empty()) complain(what, time_s, celsius);
  }

  double min_extrude_c_, hotend_limit_c_ = 1000, bed_limit_c_ = 1000;
  double nearest_k_ = 1000, coldest_c_ = kNever, hottest_c_ = 0, furthest_mm_ = 0;
  bool met_ = false, feeds_ = false;
  std::string complaint_;
};

}  // namespace kinebus
