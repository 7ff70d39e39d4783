#include "tools/compose/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <stdexcept>

#include "gateway/description/machine_file.hpp"
#include "gateway/description/shipped_machines.hpp"

namespace kinebus::compose {
namespace {

constexpr double kRad = std::numbers::pi / 180;

std::vector<double> numbers(const std::string& text, std::size_t count, const char* option) {
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, ',');) {
    std::size_t used = 0;
    double value = 0;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || used != word.size() || !std::isfinite(value))
      throw std::runtime_error(fmt::format("{}: '{}' is not a number in '{}'", option, word, text));
    out.push_back(value);
  }
  if (out.size() != count)
    throw std::runtime_error(
        fmt::format("{}: expected {} numbers with commas, found '{}'", option, count, text));
  return out;
}

Plane plane_of(const std::string& text) {
  const std::vector<double> n = numbers(text, 4, "--plane");
  const Vector normal(n[0], n[1], n[2]);
  if (normal.norm() < 1e-9) throw std::runtime_error("--plane: the normal is 0, 0, 0");
  return {normal.normalized(), n[3] / normal.norm()};
}

/// "height:radius,height:radius,..." from the tip up.
Nozzle nozzle_of(const std::string& text) {
  Nozzle out;
  if (text.empty()) return out;
  out.profile.clear();
  std::istringstream in(text);
  for (std::string corner; std::getline(in, corner, ',');) {
    const std::size_t colon = corner.find(':');
    if (colon == std::string::npos)
      throw std::runtime_error("--nozzle: expected height:radius, found '" + corner + "'");
    const double height = numbers(corner.substr(0, colon), 1, "--nozzle")[0];
    const double radius = numbers(corner.substr(colon + 1), 1, "--nozzle")[0];
    if (radius < 0 || (!out.profile.empty() &&
                       (height <= out.profile.back().height_mm || radius < out.profile.back().radius_mm)))
      throw std::runtime_error("--nozzle: heights have to rise and radii not to fall, from the tip up");
    out.profile.push_back({height, radius});
  }
  if (out.profile.empty() || out.profile.front().height_mm != 0)
    throw std::runtime_error("--nozzle: the first corner is the tip, at height 0");
  return out;
}

/// How far the machine tilts to either side, deg; 0: not at all.
double tilt_deg_of(const MachineDescription& machine) {
  const PoseLimits* limits = pose_limits(machine.kinematics);
  if (limits == nullptr) return 0;
  return std::max(0.0, std::min(-limits->a_rad.min, limits->a_rad.max)) / kRad;
}

}  // namespace

MachineDescription machine_of(const Arguments& arguments) {
  if (arguments.machine.empty()) return default_m1();
  auto machine = kinebus::machine_of(arguments.machine);
  if (!machine) throw std::runtime_error(machine.error());
  return *machine;
}

void require_tilt(const ComposeOptions& options) {
  if (options.planes.empty() && options.decompose.max_tilt_rad < 1 * kRad)
    throw std::runtime_error(
        "the machine does not tilt: expected workspace.a_deg on both sides of 0 in its file");
}

ComposeOptions options_of(const Arguments& arguments, const MachineDescription& machine) {
  ComposeOptions out;
  out.decompose.max_overhang_rad = arguments.max_overhang_deg * kRad;
  out.decompose.max_tilt_rad = arguments.max_tilt_deg.value_or(std::min(89.0, tilt_deg_of(machine))) * kRad;
  out.slicer.program = arguments.program;
  out.slicer.config = arguments.config;
  out.slicer.layer_mm = arguments.layer_mm;
  out.slicer.support_threshold_deg = arguments.max_overhang_deg;
  out.join.clearance_mm = arguments.clearance_mm;
  out.sweep.table_radius_mm = arguments.table_radius_mm;
  out.sweep.nozzle = nozzle_of(arguments.nozzle);
  out.decompose.nozzle = out.sweep.nozzle;
  out.decompose.table_radius_mm = out.sweep.table_radius_mm;
  out.keep_position = arguments.keep_position;
  out.compare_support = !arguments.no_support_comparison;
  for (const std::string& text : arguments.planes) out.planes.push_back(plane_of(text));
  return out;
}

}  // namespace kinebus::compose
