#pragma once
// Touch probe 1 of an axis (CiA 402, 60B8h to 60BBh): where the axis was at the edges of a probe, and when.

#include <cstdint>

#include "protocol/canopen/object_addresses.hpp"

namespace kinebus {

class TouchProbe {
 public:
  /// 60B8h: what was stored is forgotten.
  void set_function(std::uint16_t function) {
    function_ = function;
    status_ = function & touch_probe::kOn;
  }
  /// `counts`: of the axis at the edge; `bus_ns`: low 32 bits of the edge's bus time.
  void on_edge(bool positive, std::int32_t counts, std::uint32_t bus_ns) {
    const unsigned wanted = positive ? touch_probe::kPositiveEdge : touch_probe::kNegativeEdge;
    const unsigned stored = positive ? touch_probe::kPositiveStored : touch_probe::kNegativeStored;
    if ((function_ & touch_probe::kOn) == 0 || (function_ & wanted) == 0) return;
    if ((status_ & stored) != 0 && (function_ & touch_probe::kEveryEdge) == 0) return;
    status_ = static_cast<std::uint16_t>(status_ | stored);
    (positive ? positive_ : negative_) = {counts, bus_ns};
  }

  std::uint16_t status() const { return status_; }
  std::int32_t counts(bool positive) const { return (positive ? positive_ : negative_).counts; }
  std::uint32_t bus_ns(bool positive) const { return (positive ? positive_ : negative_).bus_ns; }

 private:
  struct Edge {
    std::int32_t counts = 0;
    std::uint32_t bus_ns = 0;
  };
  std::uint16_t function_ = 0, status_ = 0;
  Edge positive_, negative_;
};

}  // namespace kinebus
