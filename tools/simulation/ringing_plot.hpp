#pragma once
// What a person sees of vibration: the tool's path about the corner where it swung most without shaping, and
// the same corner with it, deviations enlarged.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kinebus {

/// The tool of one run, each sample.
struct RingingTrace {
  struct Point {
    float x_mm = 0, y_mm = 0, z_mm = 0;     ///< by the motors
    float dx_um = 0, dy_um = 0, dz_um = 0;  ///< how far the tool is from there
    std::uint32_t line = 0;
  };
  double period_s = 1e-3;
  std::vector<Point> points;
};

/// SVG. `unshaped` has moved; `shaped` may be empty: then it is said that nothing shapes.
std::string draw_ringing(const RingingTrace& unshaped, const RingingTrace& shaped, const std::string& title);

}  // namespace kinebus
