#pragma once
// The machine at one instant as solid bodies, those of the gateway's collision model: where each goes and
// what it is, for the renderer and for tests.

#include <QMatrix4x4>
#include <optional>
#include <vector>

#include "gateway/bodies/collision_model.hpp"
#include "gui/scene/machine_model.hpp"
#include "gui/scene/printed_body.hpp"

namespace kinebus::gui {

/// Unit bodies: box and cylinder fill -0.5 .. 0.5 (cylinder and cone along z); cone's tip is at z = -0.5.
enum class Body { kBox, kCylinder, kCone, kSphere };
enum class Finish {
  kFixed,
  kRail,
  kCarriage,
  kLeg,
  kHolder,
  kPlatform,
  kTable,
  kTool,
  kHot,
  kMark,
  kNear  ///< comes close to another
};

struct FigurePart {
  Body body;
  Finish finish;
  QMatrix4x4 place;  ///< body to machine frame
};

struct MachineFigure {
  std::vector<FigurePart> parts;
  QMatrix4x4 part_frame;                            ///< table coordinates to machine frame
  std::optional<bodies::Clearance> close;           ///< of the two that are nearest, when they come close
  std::optional<PrintedBody::Near> close_to_print;  ///< what comes close to what is printed so far
};

/// Two bodies are close when less than this is left to the clearance that they must keep.
inline constexpr double kClose_mm = 3;

/// Without the floor, and without the room that is kept for a part. hot: the tool glows. What moves is left
/// out where the pose is out of reach. `printed`: what stands on the table; nullptr: nothing.
MachineFigure pose_machine(const MachineModel& model, const PartPose& pose, bool hot,
                           const PrintedBody* printed = nullptr);

}  // namespace kinebus::gui
