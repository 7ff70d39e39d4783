#pragma once
// Where the axes stand, and whether that is a position of the machine.

#include <array>
#include <deque>
#include <vector>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/bus_nodes/standstill.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/result.hpp"
#include "gateway/run/runner.hpp"
#include "gateway/status/refusal.hpp"
#include "gateway/status/status.hpp"
#include "gateway/stream/stream_group.hpp"

namespace kinebus {

class Position {
 public:
  Position(const MachineDescription& machine, const Kinematics& kinematics, const std::vector<NodeAxes>& axes,
           const StreamGroup& group)
      : machine_(machine), kinematics_(kinematics), axes_(axes), group_(group), rest_(axes.size()) {}

  /// Positions of all joints are known.
  bool homed() const { return homed_; }
  void forget() { homed_ = false; }
  /// What the nodes hold is not what was sent: they stand where they say, and the run cannot go on.
  bool stream_lost() const { return stream_lost_; }
  void lose_stream() { stream_lost_ = true; }
  void stream_is_new() { stream_lost_ = false; }

  /// A run is over: the axes rest where its records end.
  void take_run_end();
  /// As it was read from the nodes.
  void take(const Standstill& found);
  /// Filament was moved, or its motor's place lost, beside a job: the job's E stands by so much behind the
  /// motor's.
  void show_filament_less(double by_mm) { filament_beside_mm_ = by_mm; }

  /// By the records of the run under way, else where the nodes rest.
  JointVector joints(const Runner& runner, PathTime tau) const;
  /// Frame::kMachine.
  Result<Pose, Refusal> pose(const JointVector& joints) const;

  /// From where the axes stand to the joints' values, counts: the filament's, and the greatest other.
  struct Distance {
    double filament = 0, others = 0;
  };
  Distance distance_to(const JointVector& wanted, const PlannedPose& place) const;

  /// Pose, joints, and how far encoders are off. E goes on as the job under way, or the last, counts it.
  void report(MachineStatus& status, const JointVector& joints, const std::deque<NodeLink>& links) const;

 private:
  const MachineDescription& machine_;
  const Kinematics& kinematics_;
  const std::vector<NodeAxes>& axes_;
  const StreamGroup& group_;
  std::vector<std::array<AxisState, kAxesPerNode>> rest_;  ///< where the nodes rest, by node
  bool homed_ = false, stream_lost_ = false;
  double filament_beside_mm_ = 0;
};

}  // namespace kinebus
