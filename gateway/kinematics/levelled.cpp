#include "gateway/kinematics/levelled.hpp"

#include <array>

#include "gateway/kinematics/table_rotation.hpp"

namespace kinebus {
namespace {

Vector3 in_table(Frame frame, const Pose& pose) {
  const Vector3 at{pose[kX], pose[kY], pose[kZ]};
  if (frame == Frame::kPart) return at;
  return turn_back_z(Turn(pose[kC]), turn_back_x(Turn(pose[kA]), at));
}

/// Along the table's normal.
void raise(Frame frame, double by_mm, Pose& pose) {
  if (frame == Frame::kPart) {
    pose[kZ] += by_mm;
    return;
  }
  const Turn a(pose[kA]);
  pose[kY] -= a.s * by_mm;
  pose[kZ] += a.c * by_mm;
}

}  // namespace

Pose LevelledKinematics::over_even_bed(Frame frame, const Pose& pose) const {
  if (!mesh_) return pose;
  const Vector3 at = in_table(frame, pose);
  Pose lifted = pose;
  raise(frame, mesh_->lift(at[0], at[1], at[2]).v, lifted);
  return lifted;
}

PosePoint LevelledKinematics::lifted(Frame frame, const PosePoint& pose) const {
  PointPath q;
  for (std::size_t i = 0; i < 3; ++i) {
    q.x[i] = pose.x[i];
    q.x1[i] = pose.x1[i];
    q.x2[i] = pose.x2[i];
  }
  const Turn a(pose.x[kA]);
  if (frame == Frame::kMachine) {
    turn_path_x(Turn(-pose.x[kA]), -pose.x1[kA], -pose.x2[kA], q);
    turn_path_z(Turn(-pose.x[kC]), -pose.x1[kC], -pose.x2[kC], q);
  }
  const BedMesh::Lift l = mesh_->lift(q.x[0], q.x[1], q.x[2]);
  const double x1 = q.x1[0], y1 = q.x1[1], z1 = q.x1[2];
  // The lift along the path, and turned into the frame: nothing but the normal's part of it.
  PointPath up;
  up.x[2] = l.v;
  up.x1[2] = l.x * x1 + l.y * y1 + l.z * z1;
  up.x2[2] = l.xx * x1 * x1 + l.yy * y1 * y1 + l.zz * z1 * z1 +
             2 * (l.xy * x1 * y1 + l.xz * x1 * z1 + l.yz * y1 * z1) + l.x * q.x2[0] + l.y * q.x2[1] +
             l.z * q.x2[2];
  if (frame == Frame::kMachine) turn_path_x(a, pose.x1[kA], pose.x2[kA], up);
  PosePoint raised = pose;
  for (std::size_t i = 0; i < 3; ++i) {
    raised.x[i] += up.x[i];
    raised.x1[i] += up.x1[i];
    raised.x2[i] += up.x2[i];
  }
  return raised;
}

Result<void, PoseError> LevelledKinematics::inverse(Frame frame, const Pose& pose,
                                                    JointVector& joints) const {
  return mesh_ ? even_->inverse(frame, over_even_bed(frame, pose), joints)
               : even_->inverse(frame, pose, joints);
}

Result<void, PoseError> LevelledKinematics::inverse_along(Frame frame, const PosePoint& pose,
                                                          JointPoint& joints) const {
  return mesh_ ? even_->inverse_along(frame, lifted(frame, pose), joints)
               : even_->inverse_along(frame, pose, joints);
}

Result<void, PoseError> LevelledKinematics::jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                                     std::span<double> matrix) const {
  if (!mesh_) return even_->jacobian(frame, pose, joints, matrix);
  if (auto ok = even_->jacobian(frame, over_even_bed(frame, pose), joints, matrix); !ok) return ok;
  std::array<Pose, kPoseAxes> columns;
  for (std::size_t i = 0; i < kPoseAxes; ++i) {
    PosePoint along{.x = pose};
    along.x1[i] = 1;
    columns[i] = lifted(frame, along).x1;
  }
  for (std::size_t j = 0; j < static_cast<std::size_t>(joint_count()); ++j) {
    const std::span<double> row = matrix.subspan(j * kPoseAxes, kPoseAxes);
    Pose of_even;
    std::copy(row.begin(), row.end(), of_even.begin());
    for (std::size_t i = 0; i < kPoseAxes; ++i) {
      row[i] = 0;
      for (std::size_t k = 0; k < kPoseAxes; ++k) row[i] += of_even[k] * columns[i][k];
    }
  }
  return {};
}

Result<void, PoseError> LevelledKinematics::forward(Frame frame, const JointVector& joints,
                                                    Pose& pose) const {
  if (!mesh_) return even_->forward(frame, joints, pose);
  Pose even = over_even_bed(frame, pose);
  if (auto ok = even_->forward(frame, joints, even); !ok) return ok;
  const Vector3 at = in_table(frame, even);
  raise(frame, mesh_->height_below(at[0], at[1], at[2]) - at[2], even);
  pose = even;
  return {};
}

Result<void, PoseError> LevelledKinematics::check(Frame frame, const Pose& pose) const {
  return mesh_ ? even_->check(frame, over_even_bed(frame, pose)) : even_->check(frame, pose);
}

double LevelledKinematics::condition(Frame frame, const Pose& pose) const {
  return mesh_ ? even_->condition(frame, over_even_bed(frame, pose)) : even_->condition(frame, pose);
}

}  // namespace kinebus
