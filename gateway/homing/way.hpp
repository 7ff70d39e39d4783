#pragma once
// One homing, as the bodies and the mechanism see it: from joint positions that nobody but the caller knows,
// along the plan, to the switches, off them and home.

#include <cstdint>
#include <vector>

#include "gateway/bodies/collision_model.hpp"
#include "gateway/homing/plan.hpp"

namespace kinebus::homing {

struct Way {
  enum class End : std::uint8_t {
    kHome,
    kTouches,    ///< two bodies touch: `nearest`, at `at`
    kNotClosed,  ///< at `at` the mechanism has no pose for the joints that come next
  };
  End end = End::kHome;
  /// Smallest clearance. Of tool and part or table it counts from where they first had room, and at once when
  /// they come nearer than at the start.
  bodies::Clearance nearest{};
  Pose at{};  ///< Frame::kMachine: of `nearest`, or of the end
  /// Greatest difference between the travels of linear joints that go together, mm.
  double spread_mm = 0;
  double worst_condition = 0;
};

class Walker {
 public:
  /// How densely the way is looked at: at most `step` mm of the fastest joint between two poses, and less
  /// where bodies are near.
  struct Density {
    double least_mm = 0.5, most_mm = 8;
    int most_poses = 4000;  ///< in a stage: a longer way is looked at in longer steps
  };
  /// All must outlive this. `model` nullptr: nobody knows what is solid; the mechanism alone is looked at.
  Walker(const Kinematics& kinematics, const Plan& plan, const bodies::CollisionModel* model,
         Density density);

  /// At rest: the least clearance of bodies that keep clear at work, of the tool to table and part, and of
  /// its holder to the part. Out of reach: all < 0.
  struct Room {
    double machine_mm = -1, tool_mm = -1, holder_mm = -1;
  };
  Room room(const Pose& pose) const;

  /// The bodies that keep clear at work do so all the way from one place to another, joints straight on.
  /// `pose`: of `from`.
  bool passes(const JointVector& from, Pose pose, const JointVector& to, double step);

  /// `pose`: Frame::kMachine, that of `joints`.
  Way walk(JointVector joints, Pose pose);

 private:
  bool look(const JointVector& joints, Way& way);
  struct Goal {
    const Joint* joint;
    double left;   ///< of its way
    double per_s;  ///< how fast it goes
  };
  static double travel(const Joint& joint, const JointVector& joints);
  void note_spread(const Stage& stage, const JointVector& joints, Way& way) const;
  bool go_free(const Stage& stage, JointVector& joints, Way& way);
  bool lift(const Stage& stage, JointVector& joints, Way& way);
  bool seek(const Stage& stage, JointVector& joints, Way& way);
  bool go(std::vector<Goal>& goals, JointVector& joints, Way& way);
  bool leave(const Stage& stage, JointVector& joints, Way& way);
  bool judge(Way& way);

  const Kinematics& kinematics_;
  const Plan& plan_;
  const bodies::CollisionModel* model_;
  Density density_;
  bodies::Scene scene_{};
  Pose pose_{};
  double near_mm_ = 0;                       ///< of the pose looked at last
  bodies::CollisionModel::Memory before_{};  ///< of the pose before
  /// Tool to part or table: how near they were at the start, until they have room.
  struct Parting {
    bodies::CollisionModel::Pair pair;
    double start_mm = 0;
    bool apart = false;
  };
  std::vector<Parting> partings_;
};

}  // namespace kinebus::homing
