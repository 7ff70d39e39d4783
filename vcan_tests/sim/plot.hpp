#pragma once
// The picture of a simulated job: the tool's path in space, and carriages, speed, error and bus load over
// time.

#include <array>
#include <string>
#include <vector>

#include "gateway/machine/description/machine_description.hpp"
#include "vcan_tests/sim/sample.hpp"

namespace kinebus {

/// Samples thinned while they come, so that memory and picture stay small whatever the job's length.
class PlotData {
 public:
  struct Point {
    float time_s = 0, speed_mm_per_s = 0, error_um = 0, bus_load = 0;
    std::array<float, 3> tool_mm{};
    float e_mm = 0;
    std::array<float, 8> joints{};
  };
  static constexpr std::size_t kCapacity = 40'000;

  void add(const Point& point);
  const std::vector<Point>& points() const { return points_; }
  int joint_count = 0;

 private:
  std::vector<Point> points_;
  std::size_t every_ = 1, seen_ = 0;
  float largest_error_ = 0;  // of the points passed over: peaks are not thinned away
};

/// An SVG of about 1200 x 1500. `title`: the job's name.
std::string draw_plot(const PlotData& data, const MachineDescription& machine, const std::string& title,
                      const std::string& summary);

}  // namespace kinebus
