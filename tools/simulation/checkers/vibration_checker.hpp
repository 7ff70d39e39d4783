#pragma once
// How the tool swings on a flexible frame after each change of the plan's acceleration, and how far the plan
// leaves the programmed path.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "tools/simulation/checkers/path_checker.hpp"
#include "tools/simulation/flexible_frame.hpp"

namespace kinebus {

/// What is counted: for three periods, from three quarters of a period after the plan's acceleration has come
/// to a steady value (0 behind a corner), the tool's deviation from where that acceleration holds it. Before
/// that a shaper's pulses are still at work; what an acceleration bends is no vibration. While the rate of
/// path time changes, nothing is steady; what the ramp leaves behind counts.
class VibrationChecker {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  /// `text`: the job's, for how far the plan leaves its path; nullptr: not of interest.
  VibrationChecker(const MachineDescription& machine, const Kinematics& kinematics,
                   const std::array<FlexibleFrame::Modes, 3>& modes, Planned planned, ByteSource* text,
                   const Pose& start);

  /// With its pose, every sample of the job.
  void on_sample(const Sample& sample);

  double rms_um() const;
  double peak_um() const { return peak_um_; }
  std::uint64_t samples() const { return samples_; }
  std::uint32_t peak_line() const { return peak_line_; }
  /// Of the planned pose from the programmed path, blends included; 0 without the job's text.
  double plan_deviation_um() const { return path_ ? path_->max_um() : 0; }
  const FlexibleFrame& frame() const { return frame_; }

 private:
  FlexibleFrame::Vector acceleration(const Sample& sample) const;
  bool rate_changes(double rate);

  FlexibleFrame frame_;
  Planned planned_;
  std::unique_ptr<PathChecker> path_;
  double still_mm_per_s2_;  ///< changes below this are none
  double settle_s_, watch_s_;
  BusTime last_time_{0};
  std::array<double, 8> rates_{};  ///< of the last samples, in turn
  std::size_t next_rate_ = 0;
  FlexibleFrame::Vector held_{};  ///< the acceleration that is steady
  double steady_s_ = 0;
  double squares_um2_ = 0, peak_um_ = 0;
  std::uint64_t samples_ = 0;
  std::uint32_t peak_line_ = 0;
};

}  // namespace kinebus
