#pragma once
// One seed: a machine, a job, the faults that the seed draws, and all checkers. The unit of a campaign.

#include <cstdint>
#include <string>
#include <vector>

#include "gateway/kinematics/kinematics.hpp"
#include "vcan_tests/campaign/campaign_machine.hpp"
#include "vcan_tests/campaign/fault.hpp"

namespace kinebus {

enum class FaultOutcome : std::uint8_t {
  kFinished,    ///< the job ran to its end without a stop
  kContinued,   ///< stopped or held on the path, went on from there, finished
  kHomedAgain,  ///< stopped, positions were declared unknown: homed again, went on from there, finished
  kBegunAgain,  ///< stopped before the first line of the job: begun anew, finished
  kReady,       ///< the job does not go on; the machine is ready
  kRefused,     ///< the machine did not come up and said why
  kCount,
};
inline constexpr int kFaultOutcomes = static_cast<int>(FaultOutcome::kCount);
std::string_view to_string(FaultOutcome outcome);

struct FaultResult {
  std::uint64_t seed = 0;
  FaultPlan plan;
  FaultOutcome outcome = FaultOutcome::kFinished;
  std::vector<std::string> violations;  ///< empty: every checker is content
  /// Worst distance from the planned path, of the tool; of a carriage while another one is dead or unknown.
  double path_um = 0;
  double astray_um = 0;     ///< the same after motors have lost steps, which nobody can know before homing
  double far_ms = 0;        ///< for so long, in all, it was farther off than 5 um
  double skew_us = 0;       ///< worst difference of path time between live nodes
  double rest_ms = 0;       ///< from the cause to all carriages at rest; 0: nothing stopped
  double ramp_ms = 0;       ///< E-stop input to all live nodes ramping
  double step_ratio = 0;    ///< worst change of velocity against the stop limits
  double known_counts = 0;  ///< worst difference between a position said to be known and the true one
  double margin_k = 1000;   ///< how near a block came to its limit, < 0: beyond it
  double machine_s = 0, cpu_s = 0;
  std::uint64_t trace_hash = 0;
  std::vector<std::string> story;  ///< what happened, when asked for
};

/// `tell`: fills FaultResult::story.
FaultResult run_faults(const MachineDescription& machine, const Kinematics& kinematics, const FaultPlan& plan,
                       bool tell = false);

}  // namespace kinebus
