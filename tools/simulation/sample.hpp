#pragma once
// What the checkers see of the machine at one instant: positions of the simulated motors, never what gateway
// or nodes believe.

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/machine/gateway.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr int kMaxNodes = 8;

/// Path time on all nodes at one instant.
struct Probe {
  BusTime time{0};
  int node_count = 0;
  std::array<PathTime, kMaxNodes> tau{};
};

struct Sample {
  BusTime time{0};
  int node_count = 0;
  std::array<PathTime, kMaxNodes> node_tau{};  ///< each node's own path time at this instant
  PathTime tau{0};                             ///< their mean
  JointVector joints{};                        ///< true, mm or rad
  Pose pose{};  ///< Frame::kPart, by forward kinematics of the true joints: Simulation::locate()
  std::optional<PlannedPose> planned;  ///< at tau; none: no motion is planned there
  std::uint32_t line = 0;              ///< the job's line in motion, by the plan
  double rate = 0;                     ///< d tau / dt
  bool in_job = false;
};

}  // namespace kinebus
