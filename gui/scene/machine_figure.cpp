#include "gui/scene/machine_figure.hpp"

#include <QQuaternion>
#include <QVector3D>

#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

using bodies::BodyKind;
using bodies::Shape;

QVector3D to_qt(const bodies::Vec& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

std::optional<Finish> finish_of(BodyKind kind, bool hot) {
  switch (kind) {
    case BodyKind::kLeg:
      return Finish::kLeg;
    case BodyKind::kCarriage:
      return Finish::kCarriage;
    case BodyKind::kRail:
      return Finish::kRail;
    case BodyKind::kPlatform:
    case BodyKind::kBeam:
      return Finish::kPlatform;
    case BodyKind::kTable:
      return Finish::kTable;
    case BodyKind::kTool:
      return hot ? Finish::kHot : Finish::kTool;
    case BodyKind::kHolder:
      return Finish::kHolder;
    case BodyKind::kFixed:
      return Finish::kFixed;
    case BodyKind::kPart:
    case BodyKind::kFloor:
      break;
  }
  return std::nullopt;
}

void add_shape(std::vector<FigurePart>& parts, const Shape& s, Finish finish) {
  QMatrix4x4 place;
  if (s.core == Shape::Core::kBox) {
    for (int k = 0; k < 3; ++k)
      place.setColumn(k, QVector4D(to_qt(2 * s.half[static_cast<std::size_t>(k)]), 0));
    place.setColumn(3, QVector4D(to_qt(s.centre), 1));
    parts.push_back({Body::kBox, finish, place});
    return;
  }
  const bool capsule = s.core == Shape::Core::kSegment;
  const double length = 2 * bodies::norm(s.half[0]);
  const auto width = static_cast<float>(2 * (capsule ? s.skin_mm : s.radius_mm));
  if (length > 0) {
    place.translate(to_qt(s.centre));
    place.rotate(QQuaternion::rotationTo({0, 0, 1}, to_qt((1 / length) * s.half[0])));
    place.scale(width, width, static_cast<float>(length));
    parts.push_back({Body::kCylinder, finish, place});
  }
  if (!capsule) return;
  for (const double side : {-1.0, 1.0}) {
    QMatrix4x4 end;
    end.translate(to_qt(s.centre + side * s.half[0]));
    end.scale(width);
    parts.push_back({Body::kSphere, finish, end});
  }
}

/// A round table's coordinates, from its top; a mark on its rim shows how far C has turned.
void add_table(MachineFigure& figure, const Shape& table, double c_rad, bool turns) {
  if (table.core != Shape::Core::kCylinder) return;
  constexpr float kDegPerRad = static_cast<float>(180.0 / std::numbers::pi);
  figure.part_frame.translate(to_qt(table.centre + table.half[0]));
  figure.part_frame.rotate(static_cast<float>(std::atan2(-table.axis.y, table.axis.z)) * kDegPerRad, 1, 0, 0);
  if (!turns) return;
  figure.part_frame.rotate(static_cast<float>(c_rad) * kDegPerRad, 0, 0, 1);
  QMatrix4x4 mark = figure.part_frame;
  mark.translate(static_cast<float>(table.radius_mm), 0, static_cast<float>(-bodies::norm(table.half[0])));
  mark.scale(8, 8, static_cast<float>(bodies::norm(table.half[0])));
  figure.parts.push_back({Body::kBox, Finish::kMark, mark});
}

}  // namespace

MachineFigure pose_machine(const MachineModel& model, const PartPose& pose, bool hot,
                           const PrintedBody* printed) {
  MachineFigure figure;
  if (model.solid == nullptr) return figure;
  const bodies::CollisionModel& solid = *model.solid;
  bodies::Scene scene = solid.at_rest();
  const Vec3& q = pose.q_mm;
  const bool placed = solid.place(Frame::kPart, {q[0], q[1], q[2], pose.a_rad, pose.c_rad, 0}, scene);
  if (placed && model.watched) {
    const bodies::Clearance least = solid.clearance(scene);
    if (least.mm < solid.wanted_mm() + kClose_mm) figure.close = least;
  }
  for (const bodies::CollisionModel::Body& body : solid.bodies())
    if (body.id.kind == BodyKind::kTable && (placed || !body.moves()))
      add_table(figure, scene.shapes[body.first_shape], pose.c_rad, model.turns);
  if (placed && model.watched && printed != nullptr)
    figure.close_to_print = printed->comes_close(solid, scene, figure.part_frame, kClose_mm);
  for (const bodies::CollisionModel::Body& body : solid.bodies()) {
    if (!placed && body.moves()) continue;
    auto finish = finish_of(body.id.kind, hot);
    if (!finish) continue;
    if (figure.close && (figure.close->first == body.id || figure.close->second == body.id))
      finish = Finish::kNear;
    if (figure.close_to_print && figure.close_to_print->body == body.id) finish = Finish::kNear;
    for (std::size_t k = 0; k < body.shapes; ++k)
      add_shape(figure.parts, scene.shapes[body.first_shape + k], *finish);
  }
  return figure;
}

}  // namespace kinebus::gui
