#pragma once
// The machine at one instant as solid bodies: where each goes and what it is, for the renderer and for tests.

#include <QMatrix4x4>
#include <vector>

#include "gui/scene/machine_model.hpp"

namespace kinebus::gui {

/// Unit bodies: box and cylinder fill -0.5 .. 0.5 (cylinder and cone along z); cone's tip is at z = -0.5.
enum class Body { kBox, kCylinder, kCone, kSphere };
enum class Finish {
  kFrame,
  kRail,
  kCarriage,
  kLeg,
  kJoint,
  kPlatform,
  kTable,
  kTableRim,
  kBrass,
  kHot,
  kMark
};

struct FigurePart {
  Body body;
  Finish finish;
  QMatrix4x4 place;  ///< body to machine frame
};

struct MachineFigure {
  std::vector<FigurePart> parts;
  QMatrix4x4 part_frame;  ///< table coordinates to machine frame
  QMatrix4x4 tool;        ///< tool tip, machine frame
};

/// joints_mm: carriages as the gateway reports them, in the machine's order; fewer than the machine has:
/// worked out of the pose. hot: the nozzle glows.
MachineFigure pose_machine(const MachineModel& model, const PartPose& pose,
                           const std::vector<double>& joints_mm, bool hot);

}  // namespace kinebus::gui
