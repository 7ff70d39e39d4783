#pragma once
// What a simulation measured.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace kinebus {

/// Of the tool on a flexible frame; see VibrationChecker for what counts.
struct VibrationReport {
  double rms_um = 0, peak_um = 0;
  double unshaped_rms_um = 0, unshaped_peak_um = 0;  ///< of the same job and frame without shaping
  double plan_deviation_um = 0;                      ///< of the shaped plan from the programmed path
  double unshaped_job_time_s = 0;
  std::uint64_t samples = 0;
  std::uint32_t peak_line = 0;
  /// 0 where nothing has swung that could be compared.
  double ratio_rms() const { return unshaped_rms_um > kNothing_um ? rms_um / unshaped_rms_um : 0; }
  double ratio_peak() const { return unshaped_peak_um > kNothing_um ? peak_um / unshaped_peak_um : 0; }
  static constexpr double kNothing_um = 0.05;
};

/// Width of the bead along the path, shares; see BeadMeter and BeadReference.
struct BeadReport {
  double rms = 0, worst = 0;
  std::uint32_t worst_line = 0;
  std::uint64_t beads = 0;
  double reference_rms = 0, reference_worst = 0;  ///< by Klipper's formulas
  double plain_rms = 0, plain_worst = 0;          ///< without pressure advance
  double reference_time_s = 0;
  double ratio() const { return reference_rms > 0 ? rms / reference_rms : 0; }
  double ratio_worst() const { return reference_worst > 0 ? worst / reference_worst : 0; }
};

/// Of the blocks themselves, by the plant behind the heat node.
struct HeatReport {
  double hottest_c = 0;      ///< the hot end
  double nearest_k = 0;      ///< that hot end or bed came to its limit
  bool fed = false;          ///< filament was; what follows is of that time
  double coldest_fed_c = 0;  ///< the hot end
  double worst_k = 0;        ///< of the hot end from its target
  double fed_from_s = 0;     ///< how long the job heated before
  double bed_c = 0;          ///< then
};

struct SimulationReport {
  bool finished = false;  ///< the job ran to its end
  bool trouble = false;   ///< an alarm, or an error in the job
  std::string outcome;    ///< in words
  std::uint64_t seed = 0;
  double job_time_s = 0;      ///< of the machine, from the job's start to its end
  double machine_time_s = 0;  ///< with bring-up, homing and reference
  double cpu_s = 0;
  double speedup = 0;  ///< machine time to CPU time
  double max_tracking_error_um = 0;
  double max_path_error_um = 0;
  double rms_tracking_error_um = 0, rms_path_error_um = 0;
  double max_joint_error_counts = 0;
  double max_joint_velocity_ratio = 0;
  double max_joint_acceleration_ratio = 0;
  double max_measured_acceleration_ratio = 0;
  double max_joint_jerk_ratio = 0;  ///< of the plan; 0: the machine has no limit
  double max_ramp_jerk_ratio = 0;   ///< the same while path time does not run at its full rate
  double max_velocity_step_ratio =
      0;  ///< in a millisecond, to what the stop acceleration allows; from power-up on
  double max_node_time_skew_us = 0;
  double bus_load_mean = 0;
  double bus_load_peak_1s = 0;
  std::uint64_t segments = 0;
  std::uint64_t frames = 0;
  std::uint32_t lines = 0;
  std::uint64_t samples = 0;
  std::uint32_t underruns = 0, sequence_errors = 0, checkpoint_errors = 0, bus_slowdowns = 0,
                starvation_holds = 0;
  int queue_fullest = 0;  ///< records in one node's queue
  std::uint32_t queue_overruns = 0, records_out_of_sequence = 0;
  std::optional<VibrationReport> vibration;  ///< none: the machine was rigid
  std::optional<BeadReport> bead;            ///< none: nothing was printed, or not looked at
  std::optional<HeatReport> heat;            ///< none: no heater is on a virtual node
  std::uint64_t trace_hash = 0;              ///< over all frames and their times: same seed, same hash
  double worst_tracking_s = 0, worst_path_s = 0, worst_joint_s = 0, worst_skew_s = 0, worst_step_s = 0,
         worst_jerk_s = 0;
  std::string worst_joint, worst_step_joint, worst_jerk_joint;
  std::uint32_t worst_tracking_line = 0, worst_path_line = 0;
  std::vector<std::string> messages;  ///< alarms and problems, in words
};

std::string to_json_text(const SimulationReport& report);
std::string to_table(const SimulationReport& report);

}  // namespace kinebus
