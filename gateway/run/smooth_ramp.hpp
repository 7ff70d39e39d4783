#pragma once
// How long path time may take for a change of its rate, so that acceleration and jerk of joints and tool stay
// within their limits.

#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <vector>

#include "gateway/description/machine_description.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/run/planned_pose.hpp"
#include "protocol/motion/path_clock.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class SmoothRamp {
 public:
  using Planned = std::function<std::optional<PlannedPose>(PathTime)>;
  /// What the clock would be with a smooth ramp (RateCommand::Kind::kSmooth) of this `full_ramp`.
  using Trial = std::function<PathClock(std::chrono::milliseconds full_ramp)>;

  /// The kinematics must outlive this.
  SmoothRamp(const MachineDescription& machine, const Kinematics& kinematics);

  /// The shortest `full_ramp`, from `least` (and 20 ms) on, with which what is planned from `from` on keeps
  /// the limits wherever it keeps them undisturbed; 510 ms if none does. `from`: path time at `now`. Whole 2
  /// ms. Cost: an inverse kinematics each ms of path time that the ramp takes, and some looks at each ms of
  /// it; a ramp that is too short is left at the first look that shows it. No heap.
  std::chrono::milliseconds full_ramp(const Planned& planned, const Trial& trial,
                                      std::chrono::milliseconds least, PathTime from, BusTime now);

 private:
  static constexpr std::size_t kAxes = kMaxJoints + 3;  ///< the tool along x, y, z, then the joints
  using Row = std::array<double, kAxes>;
  struct Sample {
    Row at{};
    Frame frame = Frame::kPart;
  };
  /// By path time, in parts of the jerk limit.
  struct Terms {
    Row speed{}, accel{}, jerk{};
  };
  /// What path time does.
  struct Rate {
    double rate = 0, slope = 0, bend = 0;
  };

  /// A time in which the rate's slope changes evenly.
  struct Bend {
    Rate from;
    PathTime tau{0};
    double lasts_s = 0;
  };
  /// Moments of a ramp's first half at which it may be cut short, that are looked at; its end is one.
  static constexpr std::size_t kCuts = 8;
  using Bends = std::array<Bend, 2 + kCuts - 1>;
  /// A look that showed too much.
  struct Failed {
    std::size_t bend = 0;
    double share = 0;
  };

  bool take_sample(const Planned& planned);
  bool reach(const Planned& planned, std::size_t terms);
  static PathTime way(const Rate& from, double t);
  static Bend bend_between(const PathClock& clock, BusTime from, BusTime to);
  static Bends bends_of(const PathClock& clock, BusTime now);
  bool keeps_limits_at(const Planned& planned, const Bend& bend, double share);
  bool keeps_limits(const Planned& planned, const Bends& bends, std::size_t which, double step_s);
  bool keeps_limits(const Planned& planned, const PathClock& clock, BusTime now);
  double worst_at(const Planned& planned, PathTime tau, const Rate& rate);
  double ratio(const Terms& here, const Row& jerk, const Rate& rate) const;
  double unknown_ratio(const Terms& last, const Rate& rate) const;

  const Kinematics& kinematics_;
  std::size_t axes_;
  Row per_jerk_{};        ///< 1 / jerk limit
  Row jerk_per_accel_{};  ///< jerk limit / acceleration limit, 1/s
  PathTime first_{0};     ///< of samples_[0]
  bool ended_ = false;    ///< no more is planned
  std::optional<Failed> failed_;
  std::vector<Sample> samples_;
  std::vector<Terms> terms_;  ///< terms_[i]: at samples_[i + 1]
};

}  // namespace kinebus
