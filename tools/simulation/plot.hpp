#pragma once
// The picture of a simulated job: the tool's path in space, and carriages, speed, error, bus load
// and heat over time.

#include <array>
#include <string>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

/// Samples thinned while they come, so that memory and picture stay small whatever the job's length.
class PlotData {
 public:
  static constexpr std::size_t kHeaters = 4, kFans = 2;  // drawn at most
  /// Heaters and fans in the order of the machine; power and fans 0..1.
  struct Heat {
    std::array<float, kHeaters> target_c{}, measured_c{}, power{};
    std::array<float, kFans> fan{};
  };
  struct Point {
    float time_s = 0, speed_mm_per_s = 0, error_um = 0, bus_load = 0;
    std::array<float, 3> tool_mm{};
    double e_mm = 0;  // of a long job: a float's steps would be those of a line
    std::array<float, 8> joints{};
    Heat heat{};
  };
  static constexpr std::size_t kCapacity = 40'000;

  /// The tool's path in stretches of about a layer each, corners kept. Of a long job only every
  /// drawn_stretch()-th is kept, but whole.
  struct PathPoint {
    std::array<float, 3> mm{};
    float speed_mm_per_s = 0;
    bool prints = false;  ///< on the way to this point
  };
  using Stretch = std::vector<PathPoint>;
  static constexpr std::size_t kPathCapacity = 40'000;

  void add(const Point& point);
  /// Filament for a line came on the way from one to the other.
  static bool feeds(const Point& before, const Point& now);
  const std::vector<Point>& points() const { return points_; }
  const std::vector<Stretch>& path() const { return path_; }
  std::size_t drawn_stretch() const { return keep_; }
  int joint_count = 0;
  bool prints = false;  ///< filament was fed: what feeds none is travel then
  bool heated = false;  ///< a heater had a target: temperatures are drawn

 private:
  void add_to_path(const PathPoint& point);
  void store(const PathPoint& point);
  void begin_stretch(const PathPoint& point);

  std::vector<Stretch> path_;
  std::size_t path_points_ = 0, keep_ = 1, stretches_ = 0, in_stretch_ = 0;
  bool keeping_ = false;
  PathPoint kept_{}, last_{};
  std::vector<std::array<float, 3>> passed_;  // since kept_
  bool layer_known_ = false;
  float layer_mm_ = 0;  // where the stretch at hand prints
  Point before_{};

  std::vector<Point> points_;
  std::size_t every_ = 1, seen_ = 0;
  float largest_error_ = 0;  // of the points passed over: peaks are not thinned away
};

/// An SVG of about 1200 x 1500, higher by two charts when something was heated. `title`: the job's name.
std::string draw_plot(const PlotData& data, const MachineDescription& machine, const std::string& title,
                      const std::string& summary);

}  // namespace kinebus
