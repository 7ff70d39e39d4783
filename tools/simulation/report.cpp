#include "tools/simulation/report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace kinebus {

std::string to_json_text(const SimulationReport& r) {
  nlohmann::json json{{"finished", r.finished},
                      {"outcome", r.outcome},
                      {"seed", r.seed},
                      {"job_time_s", r.job_time_s},
                      {"machine_time_s", r.machine_time_s},
                      {"cpu_s", r.cpu_s},
                      {"speedup", r.speedup},
                      {"max_tracking_error_um", r.max_tracking_error_um},
                      {"max_path_error_um", r.max_path_error_um},
                      {"rms_tracking_error_um", r.rms_tracking_error_um},
                      {"rms_path_error_um", r.rms_path_error_um},
                      {"max_joint_error_counts", r.max_joint_error_counts},
                      {"max_joint_velocity_ratio", r.max_joint_velocity_ratio},
                      {"max_joint_acceleration_ratio", r.max_joint_acceleration_ratio},
                      {"max_measured_acceleration_ratio", r.max_measured_acceleration_ratio},
                      {"max_joint_jerk_ratio", r.max_joint_jerk_ratio},
                      {"max_ramp_jerk_ratio", r.max_ramp_jerk_ratio},
                      {"max_velocity_step_ratio", r.max_velocity_step_ratio},
                      {"max_node_time_skew_us", r.max_node_time_skew_us},
                      {"bus_load_mean", r.bus_load_mean},
                      {"bus_load_peak_1s", r.bus_load_peak_1s},
                      {"segments", r.segments},
                      {"frames", r.frames},
                      {"lines", r.lines},
                      {"samples", r.samples},
                      {"underruns", r.underruns},
                      {"sequence_errors", r.sequence_errors},
                      {"checkpoint_errors", r.checkpoint_errors},
                      {"bus_slowdowns", r.bus_slowdowns},
                      {"starvation_holds", r.starvation_holds},
                      {"queue_fullest", r.queue_fullest},
                      {"queue_overruns", r.queue_overruns},
                      {"records_out_of_sequence", r.records_out_of_sequence},
                      {"trace_hash", fmt::format("{:016x}", r.trace_hash)},
                      {"worst_joint", r.worst_joint},
                      {"worst_joint_s", r.worst_joint_s},
                      {"worst_tracking_s", r.worst_tracking_s},
                      {"worst_tracking_line", r.worst_tracking_line},
                      {"worst_path_s", r.worst_path_s},
                      {"worst_path_line", r.worst_path_line},
                      {"messages", r.messages}};
  if (r.vibration) {
    json["vibration_ratio_rms"] = r.vibration->ratio_rms();
    json["vibration_ratio_peak"] = r.vibration->ratio_peak();
    json["vibration_rms_um"] = r.vibration->rms_um;
    json["vibration_peak_um"] = r.vibration->peak_um;
    json["unshaped_vibration_rms_um"] = r.vibration->unshaped_rms_um;
    json["unshaped_vibration_peak_um"] = r.vibration->unshaped_peak_um;
    json["unshaped_job_time_s"] = r.vibration->unshaped_job_time_s;
    json["shaping_deviation_um"] = r.vibration->plan_deviation_um;
    json["vibration_samples"] = r.vibration->samples;
  }
  if (r.bead) {
    json["bead_error_rms"] = r.bead->rms;
    json["bead_error_worst"] = r.bead->worst;
    json["bead_error_ratio"] = r.bead->ratio();
    json["bead_error_ratio_worst"] = r.bead->ratio_worst();
    json["bead_worst_line"] = r.bead->worst_line;
    json["beads"] = r.bead->beads;
    json["reference_bead_error_rms"] = r.bead->reference_rms;
    json["reference_bead_error_worst"] = r.bead->reference_worst;
    json["reference_motion_s"] = r.bead->reference_time_s;
    json["plain_bead_error_rms"] = r.bead->plain_rms;
    json["plain_bead_error_worst"] = r.bead->plain_worst;
  }
  if (r.heat) {
    json["hottest_c"] = r.heat->hottest_c;
    json["nearest_to_limit_k"] = r.heat->nearest_k;
    if (r.heat->fed) {
      json["coldest_fed_c"] = r.heat->coldest_fed_c;
      json["fed_off_target_k"] = r.heat->worst_k;
      json["fed_from_s"] = r.heat->fed_from_s;
      json["bed_c"] = r.heat->bed_c;
    }
  }
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string to_table(const SimulationReport& r) {
  std::string text;
  for (const std::string& message : r.messages) text += message + "\n";
  const auto row = [&](const char* name, const std::string& value, const std::string& note) {
    text += fmt::format("{:32} {:>14}   {}\n", name, value, note);
  };
  row("outcome", r.outcome, fmt::format("seed {}", r.seed));
  row("job_time_s", fmt::format("{:.3f}", r.job_time_s), fmt::format("{} lines", r.lines));
  row("cpu_s", fmt::format("{:.2f}", r.cpu_s), fmt::format("{:.0f} x real time", r.speedup));
  row("max_tracking_error_um", fmt::format("{:.3f}", r.max_tracking_error_um),
      fmt::format("tool to planned pose; line {}, {:.3f} s; {:.3f} rms", r.worst_tracking_line,
                  r.worst_tracking_s, r.rms_tracking_error_um));
  row("max_path_error_um", fmt::format("{:.3f}", r.max_path_error_um),
      fmt::format("tool to programmed path; line {}, {:.3f} s; {:.3f} rms", r.worst_path_line, r.worst_path_s,
                  r.rms_path_error_um));
  row("max_joint_error_counts", fmt::format("{:.3f}", r.max_joint_error_counts),
      fmt::format("motor to q(tau), microsteps; {}, {:.3f} s", r.worst_joint, r.worst_joint_s));
  row("max_joint_velocity_ratio", fmt::format("{:.4f}", r.max_joint_velocity_ratio), "of the limit");
  row("max_joint_acceleration_ratio", fmt::format("{:.4f}", r.max_joint_acceleration_ratio),
      fmt::format("of the limit; by 1 ms differences {:.4f}", r.max_measured_acceleration_ratio));
  if (r.max_joint_jerk_ratio > 0)
    row("max_joint_jerk_ratio", fmt::format("{:.4f}", r.max_joint_jerk_ratio),
        fmt::format("of the limit, by 1 ms differences of the plan; {}, {:.3f} s; {:.4f} below full rate",
                    r.worst_jerk_joint, r.worst_jerk_s, r.max_ramp_jerk_ratio));
  row("max_velocity_step_ratio", fmt::format("{:.4f}", r.max_velocity_step_ratio),
      fmt::format("in 1 ms, of the stop limit, from power-up on; {}, {:.3f} s", r.worst_step_joint,
                  r.worst_step_s));
  row("max_node_time_skew_us", fmt::format("{:.3f}", r.max_node_time_skew_us),
      fmt::format("path time, node to node; {:.3f} s", r.worst_skew_s));
  row("bus_load_mean", fmt::format("{:.4f}", r.bus_load_mean), "of 1 Mbit/s");
  row("bus_load_peak_1s", fmt::format("{:.4f}", r.bus_load_peak_1s), "busiest second");
  row("segments", fmt::format("{}", r.segments), "");
  row("frames", fmt::format("{}", r.frames), "all, SYNC and status included");
  row("underruns", fmt::format("{}", r.underruns),
      fmt::format("sequence errors {}, checkpoint errors {}, slowed for the bus {}, for planning {}",
                  r.sequence_errors, r.checkpoint_errors, r.bus_slowdowns, r.starvation_holds));
  row("queue_fullest", fmt::format("{}", r.queue_fullest),
      fmt::format("records; sent without room {}, out of sequence {}", r.queue_overruns,
                  r.records_out_of_sequence));
  if (r.vibration) {
    const VibrationReport& v = *r.vibration;
    row("vibration_ratio_rms", fmt::format("{:.4f}", v.ratio_rms()),
        fmt::format("left after changes of acceleration, {:.3f} um; unshaped {:.3f} um", v.rms_um,
                    v.unshaped_rms_um));
    row("vibration_ratio_peak", fmt::format("{:.4f}", v.ratio_peak()),
        fmt::format("{:.3f} um, line {}; unshaped {:.3f} um", v.peak_um, v.peak_line, v.unshaped_peak_um));
    row("shaping_deviation_um", fmt::format("{:.3f}", v.plan_deviation_um),
        fmt::format("of the plan from the path, blends included; job unshaped {:.3f} s",
                    v.unshaped_job_time_s));
  }
  if (r.bead) {
    const BeadReport& b = *r.bead;
    row("bead_error_rms", fmt::format("{:.4f}", b.rms),
        fmt::format("of its width, {} beads; reference {:.4f}, without advance {:.4f}", b.beads,
                    b.reference_rms, b.plain_rms));
    row("bead_error_worst", fmt::format("{:.4f}", b.worst),
        fmt::format("line {}; reference {:.4f}, without advance {:.4f}", b.worst_line, b.reference_worst,
                    b.plain_worst));
    row("bead_error_ratio", fmt::format("{:.4f}", b.ratio()),
        fmt::format("to the reference, rms; worst {:.4f}; its motion {:.3f} s", b.ratio_worst(),
                    b.reference_time_s));
  }
  if (r.heat) {
    const HeatReport& h = *r.heat;
    row("hottest_c", fmt::format("{:.1f}", h.hottest_c),
        fmt::format("hot end's block; hot end and bed stay {:.1f} K below their limits", h.nearest_k));
    if (h.fed) {
      row("coldest_fed_c", fmt::format("{:.1f}", h.coldest_fed_c),
          fmt::format("hot end's block while filament is fed, from {:.1f} s on; bed then {:.1f} C",
                      h.fed_from_s, h.bed_c));
      row("fed_off_target_k", fmt::format("{:.2f}", h.worst_k), "the same block, worst");
    }
  }
  row("trace_hash", fmt::format("{:016x}", r.trace_hash), "same seed, same hash");
  return text;
}

}  // namespace kinebus
