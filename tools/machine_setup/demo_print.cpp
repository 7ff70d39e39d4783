#include "tools/machine_setup/demo_print.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kinebus {
namespace {

constexpr double kLayer_mm = 0.2, kLine_mm = 0.45, kFilament_mm = 1.75;
constexpr int kLayers = 2;
constexpr double kHotend_c = 205, kBed_c = 60, kRetract_mm = 0.8;
/// Half the sides of each layer's squares.
constexpr std::array kHalf_mm{15.0, 14.55, 14.1};

double fed_mm(double way_mm) {
  constexpr double kSection_mm2 = std::numbers::pi * kFilament_mm * kFilament_mm / 4;
  return way_mm * kLayer_mm * kLine_mm / kSection_mm2;
}

const HeaterDescription* heater_of(const MachineDescription& machine, HeaterKind kind) {
  for (const HeaterDescription& heater : machine.heaters)
    if (heater.kind == kind) return &heater;
  return nullptr;
}

std::string square(double half, bool feeds) {
  const std::string fed = feeds ? fmt::format(" E{:.4f}", fed_mm(2 * half)) : "";
  std::string text = fmt::format("G0 X{:.2f} Y{:.2f}\n", -half, -half);
  if (feeds) text += fmt::format("G1 E{} F1200\n", kRetract_mm);
  text += fmt::format(
      "G1 X{0:.2f} Y{1:.2f}{2} F1500\nG1 X{0:.2f} Y{0:.2f}{2}\nG1 X{1:.2f} Y{0:.2f}{2}\n"
      "G1 X{1:.2f} Y{1:.2f}{2}\n",
      half, -half, fed);
  if (feeds) text += fmt::format("G1 E{} F1200\n", -kRetract_mm);
  return text;
}

}  // namespace

std::string demo_print(const MachineDescription& machine) {
  const HeaterDescription* const hotend = heater_of(machine, HeaterKind::kHotend);
  const HeaterDescription* const bed = heater_of(machine, HeaterKind::kBed);
  const double hotend_c = hotend != nullptr ? std::min(kHotend_c, hotend->max_c) : 0;
  const double bed_c = bed != nullptr ? std::min(kBed_c, bed->max_c) : 0;
  std::string text =
      fmt::format("; A first print of {}: a flat square of 30 mm, for PLA\nG21 G90 M83\n", machine.name);
  if (bed != nullptr) text += fmt::format("M140 S{:.0f}\n", bed_c);
  if (hotend != nullptr) text += fmt::format("M104 S{:.0f}\n", hotend_c);
  text += "G0 X0 Y0 F3000\nG0 Z20 F600\n";
  if (bed != nullptr) text += fmt::format("M190 S{:.0f}\n", bed_c);
  if (hotend != nullptr) text += fmt::format("M109 S{:.0f}\n", hotend_c);
  for (int layer = 1; layer <= kLayers; ++layer) {
    text += fmt::format(";LAYER:{}\nG0 X{:.2f} Y{:.2f} F3000\nG1 Z{:.2f} F600\n", layer - 1, -kHalf_mm[0],
                        -kHalf_mm[0], layer * kLayer_mm);
    if (layer == 2 && !machine.fans.empty()) text += "M106 S255\n";
    for (const double half : kHalf_mm) text += square(half, hotend != nullptr);
  }
  if (!machine.fans.empty()) text += "M107\n";
  text += "G0 Z20 F3000\n";
  if (hotend != nullptr) text += "M104 S0\n";
  if (bed != nullptr) text += "M140 S0\n";
  return text;
}

}  // namespace kinebus
