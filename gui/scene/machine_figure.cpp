#include "gui/scene/machine_figure.hpp"

#include <QQuaternion>
#include <QVector3D>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kinebus::gui {
namespace {

constexpr float kDegPerRad = static_cast<float>(180.0 / std::numbers::pi);

QVector3D to_qt(const Vec3& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

QMatrix4x4 at(const Vec3& centre_mm, const Vec3& size_mm) {
  QMatrix4x4 place;
  place.translate(to_qt(centre_mm));
  place.scale(to_qt(size_mm));
  return place;
}

class Builder {
 public:
  explicit Builder(MachineFigure& figure) : figure_(figure) {}

  void add(Body body, Finish finish, const QMatrix4x4& place) {
    figure_.parts.push_back({body, finish, place});
  }
  void box(Finish finish, const Vec3& centre_mm, const Vec3& size_mm) {
    add(Body::kBox, finish, at(centre_mm, size_mm));
  }
  void disc(Finish finish, const QMatrix4x4& frame, float radius_mm, float z_mm, float height_mm) {
    QMatrix4x4 place = frame;
    place.translate(0, 0, z_mm);
    place.scale(2 * radius_mm, 2 * radius_mm, height_mm);
    add(Body::kCylinder, finish, place);
  }
  /// A round or square bar between two points.
  void bar(Body body, Finish finish, const Vec3& from_mm, const Vec3& to_mm, double width_mm) {
    const Vec3 along = to_mm - from_mm;
    QMatrix4x4 place;
    place.translate(to_qt(0.5 * (from_mm + to_mm)));
    place.rotate(QQuaternion::rotationTo({0, 0, 1}, to_qt(unit(along))));
    const auto width = static_cast<float>(width_mm);
    place.scale(width, width, static_cast<float>(length(along)));
    add(body, finish, place);
  }
  void ball(Finish finish, const Vec3& centre_mm, double width_mm) {
    add(Body::kSphere, finish, at(centre_mm, {width_mm, width_mm, width_mm}));
  }
  /// Nozzle with its heater and heat sink; the tip is at `tip_mm`.
  void hotend(const Vec3& tip_mm, bool hot) {
    add(Body::kCone, hot ? Finish::kHot : Finish::kBrass, at(tip_mm + Vec3{0, 0, 4}, {9, 9, 8}));
    add(Body::kCylinder, Finish::kBrass, at(tip_mm + Vec3{0, 0, 9.5}, {12, 12, 3}));
    box(hot ? Finish::kHot : Finish::kJoint, tip_mm + Vec3{3, 0, 17}, {24, 17, 12});
    add(Body::kCylinder, Finish::kRail, at(tip_mm + Vec3{0, 0, 27}, {6, 6, 8}));
    for (int fin = 0; fin < 6; ++fin)
      add(Body::kCylinder, Finish::kRail, at(tip_mm + Vec3{0, 0, 33 + 5.0 * fin}, {26, 26, 2.4}));
    add(Body::kCylinder, Finish::kRail, at(tip_mm + Vec3{0, 0, 46}, {10, 10, 32}));
  }

 private:
  MachineFigure& figure_;
};

/// A leg of two parallel rods (a parallelogram), with balls at its ends.
void parallelogram(Builder& build, const Vec3& upper_mm, const Vec3& lower_mm, const Vec3& across) {
  constexpr double kHalfWidth_mm = 17, kRod_mm = 9;
  for (const double side : {-kHalfWidth_mm, kHalfWidth_mm}) {
    const Vec3 offset = side * across;
    build.bar(Body::kCylinder, Finish::kLeg, upper_mm + offset, lower_mm + offset, kRod_mm);
    build.ball(Finish::kJoint, upper_mm + offset, 15);
    build.ball(Finish::kJoint, lower_mm + offset, 15);
  }
}

void rail_and_carriage(Builder& build, const MachineModel::Leg& leg, double travel_mm, const Vec3& inwards) {
  const double top = leg.travel_mm.max + 70;
  const Vec3 behind = leg.foot_mm - 26 * inwards;
  build.bar(Body::kBox, Finish::kFrame, behind, behind + top * leg.rail, 40);
  const Vec3 guide = leg.foot_mm - 4 * inwards;
  build.bar(Body::kBox, Finish::kRail, guide + (leg.travel_mm.min - 60) * leg.rail,
            guide + (top - 10) * leg.rail, 13);
  const Vec3 carriage = leg.foot_mm + travel_mm * leg.rail;
  build.bar(Body::kBox, Finish::kCarriage, carriage - 30 * leg.rail, carriage + 30 * leg.rail, 44);
  // The optical switch, at the end that carriages home to: away from the platform's tool.
  const double end = leg.carriage_above ? leg.travel_mm.max + 38 : leg.travel_mm.min - 38;
  build.box(Finish::kMark, leg.foot_mm + end * leg.rail - 4 * inwards, {20, 20, 8});
}

double travel_of(const MachineModel& model, const PartPose& pose, const std::vector<double>& joints_mm,
                 std::size_t i) {
  if (i < joints_mm.size()) return joints_mm[i];
  if (const auto travel = model.carriages_mm(pose)) return (*travel)[i];
  return model.legs[i].travel_mm.max;
}

void pose_m1(const MachineModel& m, const PartPose& pose, const std::vector<double>& joints_mm, bool hot,
             MachineFigure& figure) {
  Builder build(figure);
  const Vec3 p = m.platform_mm(pose);
  QMatrix4x4 platform;
  platform.translate(to_qt(p));
  platform.rotate(static_cast<float>(pose.a_rad) * kDegPerRad, 1, 0, 0);
  figure.part_frame = platform;
  figure.part_frame.rotate(static_cast<float>(pose.c_rad) * kDegPerRad, 0, 0, 1);
  figure.tool.translate(to_qt(m.nozzle_mm));

  double reach_x = 0, reach_y = 0;
  for (std::size_t i = 0; i < m.legs.size(); ++i) {
    const auto& leg = m.legs[i];
    const double travel = travel_of(m, pose, joints_mm, i);
    const Vec3 inwards = unit({-leg.foot_mm[0], 0, 0});
    rail_and_carriage(build, leg, travel, inwards);
    const Vec3 attachment = p + turn_x(pose.a_rad, leg.attachment_mm);
    const Vec3 joint = attachment - leg.connector_mm * leg.rail;
    parallelogram(build, leg.foot_mm + travel * leg.rail, joint, {1, 0, 0});
    // The connector stays parallel to the rail.
    if (std::abs(leg.connector_mm) > 1) build.bar(Body::kCylinder, Finish::kJoint, joint, attachment, 12);
    reach_x = std::max(reach_x, std::abs(leg.foot_mm[0]));
    reach_y = std::max(reach_y, std::abs(leg.foot_mm[1]));
  }
  // Frame: the rails' feet on the ground, and a portal that the table passes under, from which the nozzle
  // hangs.
  const double x = reach_x + 26, top = m.nozzle_mm[2] + 160;
  const double column = std::max(x, 2 * m.radius_mm + 50);
  for (const double side : {-1.0, 1.0}) {
    build.box(Finish::kFrame, {0, side * reach_y, 20}, {2 * x + 40, 40, 40});
    build.box(Finish::kFrame, {side * x, 0, 20}, {40, 2 * reach_y - 40, 40});
    build.bar(Body::kBox, Finish::kFrame, {side * column, 0, 0}, {side * column, 0, top}, 40);
  }
  build.box(Finish::kFrame, {0, 0, 20}, {2 * column, 40, 40});
  build.box(Finish::kFrame, {0, 0, top}, {2 * column + 40, 40, 40});
  build.bar(Body::kBox, Finish::kFrame, m.nozzle_mm + Vec3{0, 0, 62},
            {m.nozzle_mm[0], m.nozzle_mm[1], top - 20}, 22);
  build.hotend(m.nozzle_mm, hot);

  // Platform: a cross of beams to the attachments, under the table.
  for (const auto& leg : m.legs) {
    QMatrix4x4 arm = platform;
    const Vec3& b = leg.attachment_mm;
    arm.translate(0, static_cast<float>(b[1]), static_cast<float>(b[2]) - 17);
    arm.scale(static_cast<float>(2 * std::abs(b[0]) + 46), 20, 14);
    build.add(Body::kBox, Finish::kPlatform, arm);
    QMatrix4x4 post = platform;
    post.translate(static_cast<float>(b[0]), static_cast<float>(b[1]), static_cast<float>(b[2]) - 6);
    post.scale(46, 14, 12);
    build.add(Body::kBox, Finish::kPlatform, post);
  }
  QMatrix4x4 plate = platform;
  plate.translate(0, 0, -14);
  plate.scale(150, 210, 12);
  build.add(Body::kBox, Finish::kPlatform, plate);
  build.disc(Finish::kJoint, platform, 46, -26, 14);
  // The table's top is the part's zero.
  build.disc(Finish::kTableRim, figure.part_frame, static_cast<float>(m.radius_mm) + 6, -5.5F, 7);
  build.disc(Finish::kTable, figure.part_frame, static_cast<float>(m.radius_mm) + 2, -1.6F, 3);
  // A mark on the rim shows how far C has turned.
  QMatrix4x4 mark = figure.part_frame;
  mark.translate(static_cast<float>(m.radius_mm) + 2, 0, -3);
  mark.scale(14, 8, 7);
  build.add(Body::kBox, Finish::kMark, mark);
}

void pose_delta(const MachineModel& m, const PartPose& pose, const std::vector<double>& joints_mm, bool hot,
                MachineFigure& figure) {
  Builder build(figure);
  constexpr double kJointAboveTip_mm = 60;
  figure.tool.translate(to_qt(pose.q_mm));
  double top = 0;
  for (std::size_t i = 0; i < m.legs.size(); ++i) {
    const auto& leg = m.legs[i];
    const double travel = travel_of(m, pose, joints_mm, i);
    const Vec3 lift{0, 0, kJointAboveTip_mm};
    const Vec3 inwards = unit(Vec3{} - leg.foot_mm);
    auto lifted = leg;
    lifted.travel_mm.max += kJointAboveTip_mm;
    rail_and_carriage(build, lifted, travel + kJointAboveTip_mm, inwards);
    parallelogram(build, leg.foot_mm + travel * leg.rail + lift, pose.q_mm + leg.attachment_mm + lift,
                  {-inwards[1], inwards[0], 0});
    top = std::max(top, lifted.travel_mm.max + 70);
  }
  for (std::size_t i = 0; i < m.legs.size(); ++i) {
    const Vec3 &a = m.legs[i].foot_mm, &b = m.legs[(i + 1) % m.legs.size()].foot_mm;
    for (const double z : {-30.0, top})
      build.bar(Body::kBox, Finish::kFrame, a + Vec3{0, 0, z}, b + Vec3{0, 0, z}, 36);
  }
  QMatrix4x4 effector;
  effector.translate(to_qt(pose.q_mm + Vec3{0, 0, kJointAboveTip_mm}));
  build.disc(Finish::kPlatform, effector, 38, 0, 8);
  build.hotend(pose.q_mm, hot);
  build.disc(Finish::kTableRim, {}, static_cast<float>(m.radius_mm) + 8, -6, 8);
  build.disc(Finish::kTable, {}, static_cast<float>(m.radius_mm) + 2, -1.6F, 3);
}

void pose_gantry(const MachineModel& m, const PartPose& pose, bool hot, MachineFigure& figure) {
  Builder build(figure);
  figure.part_frame.rotate(static_cast<float>(pose.a_rad) * kDegPerRad, 1, 0, 0);
  figure.part_frame.rotate(static_cast<float>(pose.c_rad) * kDegPerRad, 0, 0, 1);
  const Vec3 tip = turn_x(pose.a_rad, turn_z(pose.c_rad, pose.q_mm));
  figure.tool.translate(to_qt(tip));
  const double left = m.x_mm.min - 70, right = m.x_mm.max + 70, front = m.y_mm.min - 60,
               back = m.y_mm.max + 60;
  const double top = m.z_mm.max + 120;
  for (const double x : {left, right}) {
    for (const double y : {front, back}) build.bar(Body::kBox, Finish::kFrame, {x, y, -40}, {x, y, top}, 30);
    build.box(Finish::kFrame, {x, (front + back) / 2, top}, {30, back - front, 30});
    build.box(Finish::kFrame, {x, (front + back) / 2, -40}, {30, back - front, 30});
  }
  for (const double y : {front, back}) {
    build.box(Finish::kFrame, {(left + right) / 2, y, top}, {right - left, 30, 30});
    build.box(Finish::kFrame, {(left + right) / 2, y, -40}, {right - left, 30, 30});
  }
  const double beam = tip[2] + 66;
  build.box(Finish::kRail, {(left + right) / 2, tip[1] + 26, beam}, {right - left - 30, 16, 16});
  for (const double x : {left + 24, right - 24})
    build.box(Finish::kCarriage, {x, tip[1] + 26, beam}, {36, 50, 44});
  build.box(Finish::kCarriage, {tip[0], tip[1] + 12, beam}, {48, 26, 50});
  build.hotend(tip, hot);
  QMatrix4x4 bed = figure.part_frame;
  const Vec3 centre{(m.x_mm.min + m.x_mm.max) / 2, (m.y_mm.min + m.y_mm.max) / 2, -3};
  bed.translate(to_qt(centre));
  bed.scale(static_cast<float>(m.x_mm.max - m.x_mm.min + 16),
            static_cast<float>(m.y_mm.max - m.y_mm.min + 16), 6);
  build.add(Body::kBox, Finish::kTable, bed);
}

}  // namespace

MachineFigure pose_machine(const MachineModel& model, const PartPose& pose,
                           const std::vector<double>& joints_mm, bool hot) {
  MachineFigure figure;
  switch (model.kind) {
    case MachineModel::Kind::kM1:
      pose_m1(model, pose, joints_mm, hot, figure);
      break;
    case MachineModel::Kind::kLinearDelta:
      pose_delta(model, pose, joints_mm, hot, figure);
      break;
    case MachineModel::Kind::kCartesian:
    case MachineModel::Kind::kCoreXy:
      pose_gantry(model, pose, hot, figure);
      break;
  }
  return figure;
}

}  // namespace kinebus::gui
