#pragma once
// The rules that a job must keep, applied to what the pipeline gives out: poses along the path, bodies on
// their way, temperatures, commands out of place. Collects every problem with its line.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "gateway/description/machine_description.hpp"
#include "gateway/gcode/canonical.hpp"
#include "gateway/jobs/problem.hpp"
#include "gateway/jobs/way_rules.hpp"
#include "gateway/motion/trajectory.hpp"

namespace kinebus {

class JobCheck {
 public:
  struct Options {
    /// Along the path a pose is checked at least this often. The workspace's borders are smooth: between two
    /// good poses 1 mm apart the path leaves it by less than 2 um (radius of curvature >= 100 mm).
    double pose_distance_mm = 1;
    double pose_distance_rad = 0.01;
    /// Targets of hot ends when the job begins, and which of them is in use.
    HotendTargets hotend_celsius{};
    std::uint8_t tool = 0;
  };

  JobCheck(const MachineDescription& machine, const Kinematics& kinematics);
  JobCheck(const MachineDescription& machine, const Kinematics& kinematics, Options options);

  void phase(const Phase& phase);
  void command(const canonical::Line& line);
  void problem(Problem problem) { problems_.add(std::move(problem)); }

  const ProblemList& problems() const { return problems_; }
  /// It feeds filament before it has told the hot end anything.
  bool feeds_by_found_heat() const { return by_found_heat_; }

 private:
  void check_way(const Phase& phase, const PosePoint& end);
  void check_pose(const Phase& phase, double before, double s);
  bool goes_farther_out(std::uint32_t line) const;
  void check_extrusion(std::uint32_t line, double e_mm);
  void check_thermal(const canonical::Thermal& thermal, std::uint32_t line);
  void add(Problem::Severity severity, std::uint32_t line, Sentence words);

  const MachineDescription& machine_;
  std::unique_ptr<bodies::PrintedPart> printed_;  ///< by the job, so far; nullptr: nobody looks
  WayRules way_;
  Options options_;
  ProblemList problems_;
  bool bad_pose_ = false;  ///< the last pose checked was bad: one report for each way out
  struct Outside {
    std::optional<PoseError> worst;
    std::uint32_t line = 0;
    std::uint64_t said = 0;  ///< problems, with this one
  };
  Outside outside_;                          ///< how far the last way out has led so far
  double since_mm_ = 1e9, since_rad_ = 1e9;  ///< travelled since the last check
  struct Hotend {
    std::optional<double> celsius;
    bool told = false, cold_reported = false;
  };
  std::array<Hotend, kMostOfAKind> hotends_{};
  std::uint8_t tool_;         ///< in use
  double hot_e_mm_ = -1e300;  ///< the farthest that the one in use was fed hot
  bool by_found_heat_ = false;
  bool fan_reported_ = false, tall_reported_ = false, probes_ = false, levels_ = false, awaits_ = false;
};

}  // namespace kinebus
