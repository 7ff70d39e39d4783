#pragma once
// The nodes that a machine description names, as virtual nodes with motors and switches behind them.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "gateway/calibration/joint_map.hpp"
#include "gateway/description/machine_description.hpp"
#include "tools/simulation/bus/virtual_machine.hpp"

namespace kinebus {

struct VirtualClocks {
  double drift_ppm = 0;    ///< crystals are spread evenly over +- this
  BusTime latency_max{0};  ///< interrupt latency at the nodes, 0 .. this
  BusTime offset_max{0};   ///< power-up times differ by up to this
};

/// Carriages stand somewhere inside their travel, a few mm apart (from `seed`), with their positions unknown
/// to the nodes; home switches stand where the description says, shifted by the calibration offset.
std::vector<VirtualNodeOptions> virtual_nodes_of(const MachineDescription& machine,
                                                 const VirtualClocks& clocks, std::uint64_t seed);

/// A joint as it really is: its calibration in the machine description is the truth about it. With play: it
/// is moved by the motor only when the gap is closed.
class JointPlant {
 public:
  explicit JointPlant(const JointDescription& joint)
      : drive_(joint.drive), truth_(joint.calibration), map_(joint.calibration) {}
  /// True position, mm or rad, when the motor has come to these true counts. Call in the order of time.
  double at(double counts);

 private:
  DriveTrain drive_;
  JointCalibration truth_;
  JointMap map_;
  double contact_ = 0;
  bool met_ = false;
};

/// The probe of a machine that has one on a node, over the plane that its file states; the tool is where the
/// description's kinematics has it with the joints as JointPlant knows them. nullopt: none is on a node.
std::optional<VirtualProbe> virtual_probe_of(const MachineDescription& machine);

/// All of them together, with that probe.
std::unique_ptr<VirtualMachine> virtual_machine_of(const MachineDescription& machine,
                                                   const VirtualClocks& clocks, std::uint64_t seed);

/// The joint position, mm or rad, that true counts of its axis mean (drive train only, no calibration).
double joint_from_counts(const JointDescription& joint, double counts);

}  // namespace kinebus
