#pragma once
// A machine whose bed is not even: the tool goes over it as it would over an even one. What a pose calls its
// height above the table is measured from the bed's surface there, and fades into the table's own. The mesh
// belongs to the table: it turns with it and tilts with it, in both frames, and a pose is moved along the
// table's normal, whichever way the tool points. Without a mesh every answer is the machine's own, bit by
// bit.

#include <memory>

#include "gateway/kinematics/bed_mesh.hpp"
#include "gateway/kinematics/kinematics.hpp"

namespace kinebus {

class LevelledKinematics final : public Kinematics {
 public:
  explicit LevelledKinematics(std::unique_ptr<Kinematics> even) : even_(std::move(even)) {}

  /// nullptr: none. Only while nothing moves; whoever holds a pose holds one of another meaning from here on.
  void set_mesh(std::shared_ptr<const BedMesh> mesh) { mesh_ = std::move(mesh); }
  const std::shared_ptr<const BedMesh>& mesh() const { return mesh_; }

  std::string name() const override { return even_->name(); }
  int joint_count() const override { return even_->joint_count(); }
  JointInfo joint_info(int joint) const override { return even_->joint_info(joint); }
  Result<void, PoseError> inverse(Frame frame, const Pose& pose, JointVector& joints) const override;
  Result<void, PoseError> inverse_along(Frame frame, const PosePoint& pose,
                                        JointPoint& joints) const override;
  Result<void, PoseError> jacobian(Frame frame, const Pose& pose, JointVector& joints,
                                   std::span<double> matrix) const override;
  Result<void, PoseError> forward(Frame frame, const JointVector& joints, Pose& pose) const override;
  Result<void, PoseError> check(Frame frame, const Pose& pose) const override;
  double condition(Frame frame, const Pose& pose) const override;
  Pose bed_reference() const override { return even_->bed_reference(); }

  /// Where the tool truly is, as a machine with an even bed names it.
  Pose over_even_bed(Frame frame, const Pose& pose) const;

 private:
  PosePoint lifted(Frame frame, const PosePoint& pose) const;

  std::unique_ptr<Kinematics> even_;
  std::shared_ptr<const BedMesh> mesh_;
};

}  // namespace kinebus
