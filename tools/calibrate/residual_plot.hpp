#pragma once
// Residuals before and after a calibration, as a picture (SVG).

#include <string>
#include <vector>

namespace kinebus {

/// One panel: points over x, before and after.
struct ResidualPanel {
  std::string title, x_name;
  std::vector<double> x, before_mm, after_mm;
};

std::string draw_residuals(const std::string& title, const std::string& subtitle,
                           const std::vector<ResidualPanel>& panels);

}  // namespace kinebus
