#pragma once
// Speed and acceleration of every joint against its limits: from the records on the bus, exactly, and from
// the true positions of the motors by differences of a millisecond.

#include <array>
#include <cstdint>

#include "gateway/description/machine_description.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/segment.hpp"
#include "tools/simulation/sample.hpp"

namespace kinebus {

class JointChecker {
 public:
  explicit JointChecker(const MachineDescription& machine);

  void on_sample(const Sample& sample);
  void on_frame(const CanFrame& frame);  ///< every frame on the bus

  double max_velocity_ratio() const { return max_velocity_; }
  double max_acceleration_ratio() const { return max_acceleration_; }
  double max_measured_acceleration_ratio() const { return max_measured_; }
  std::uint64_t segments() const { return segments_; }

 private:
  struct AxisLimits {
    int joint = -1;
    double velocity = 0;      // in raw units of AxisState::velocity
    double acceleration = 0;  // in raw units of Segment::acceleration
  };
  struct NodeTrack {
    std::array<AxisLimits, kAxesPerNode> limits{};
    std::array<AxisState, kAxesPerNode> state{};
  };

  const MachineDescription& machine_;
  std::array<NodeTrack, 128> nodes_{};
  std::array<JointVector, 2> history_{};
  BusTime last_{0};
  int in_a_row_ = 0;
  double max_velocity_ = 0, max_acceleration_ = 0, max_measured_ = 0;
  std::uint64_t segments_ = 0;
};

}  // namespace kinebus
