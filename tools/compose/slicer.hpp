#pragma once
// PrusaSlicer as the program that turns a piece into layers.

#include <optional>
#include <string>

#include "tools/compose/mesh.hpp"

namespace kinebus::compose {

struct SlicerOptions {
  std::string program = "prusa-slicer";
  std::string config;     ///< a PrusaSlicer .ini of the user's; empty: the composer's own settings
  double layer_mm = 0.2;  ///< of the composer's own settings
  double filament_diameter_mm = 1.75;
  double hotend_celsius = 205;
  double bed_celsius = 60;
  bool support = false;  ///< let the slicer add support (to measure what was saved)
  double support_threshold_deg = 45;
};

class Slicer {
 public:
  /// Works in `folder`, which exists.
  Slicer(SlicerOptions options, std::string folder);

  /// The text of the G-code of a piece that stands on z = 0 in its own coordinates. Throws std::runtime_error
  /// with the slicer's own words when it fails.
  std::string slice(const TriangleMesh& piece, const std::string& name, bool support = false) const;

  /// A 3MF (or any other file the slicer reads) as an STL in the work folder.
  std::string to_stl(const std::string& path) const;

 private:
  void run(const std::string& arguments, const std::string& what) const;
  SlicerOptions options_;
  std::string folder_;
};

/// "; filament used [mm] = ..." as PrusaSlicer states it at the end.
std::optional<double> stated_filament_mm(const std::string& gcode);

}  // namespace kinebus::compose
