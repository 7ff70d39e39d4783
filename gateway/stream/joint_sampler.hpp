#pragma once
// Phase -> JointSpans: q(tau) as cubic Hermite polynomials in time through exact joint positions and
// velocities.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "gateway/calibration/joint_map.hpp"
#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/joint_span.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/result.hpp"
#include "gateway/stream/stream_error.hpp"

namespace kinebus {

/// Post-condition: spans join with equal value and slope; each stays within the tolerance of the exact
/// inverse kinematics of pose(tau). Pull style: push one phase when wants_phase(), then call next() until it
/// gives no more. Cost: one inverse_along a span, and one inverse for the check of a long one. No heap.
class JointSampler {
 public:
  struct Options {
    double tolerance_mm = 35e-6;    ///< 0.045 counts of a carriage: a tenth of the half count for everything
    double tolerance_rad = 1.8e-6;  ///< the same for M1's table: 24,446 counts a rad
    double longest_span_s = 0.25;   ///< about two of the longest segments
    /// Not checked below this: the fourth derivative is at most 3 a^2 / r = 0.27e6 mm/s^4 for a = 3000 mm/s^2
    /// and inverse kinematics with a radius of curvature of 100 mm; times 0.005^4 / 384 that is 0.0005 um.
    double unchecked_span_s = 0.005;
    /// Up to this the check costs nothing: by what the cubic's second derivative misses at the span's end.
    /// Beyond, where the fourth derivative may change on the way, by the position in the middle.
    double end_checked_span_s = 0.03;
    /// Calibration: spans are in the motors' own coordinates then. nullptr: the joint's.
    std::array<std::shared_ptr<const JointMap>, kMaxJoints> maps{};
  };
  struct Counters {
    std::uint64_t phases = 0, spans = 0, evaluations = 0;
  };

  explicit JointSampler(const Kinematics& kinematics) : JointSampler(kinematics, Options{}) {}
  JointSampler(const Kinematics& kinematics, Options options);

  /// Begins a new run at path time 0 of the run.
  void restart();
  bool wants_phase() const { return !active_ && !ended_; }
  /// Error kPose: its first pose cannot be taken; kPhaseOrder: not asked for; kNotAtRest: a speed at the
  /// run's start or, with phase.last, at its end. Phases below 0.2 us go into the next span.
  Result<void, StreamError> push(const Phase& phase);
  /// The next span, valid until the next call, of which the one that ends a phase with `last` is marked
  /// `last`. nullptr: push a phase, or the run is over. Error kPose: the path cannot be reached there.
  Result<const JointSpan*, StreamError> next();

  /// The run's last span was given out.
  bool ended() const { return ended_; }
  /// Path time up to which phases were taken, s since the run's start.
  double end_s() const { return phase_start_s_ + (active_ ? phase_.duration_s : 0.0); }
  const Counters& counters() const { return counters_; }

 private:
  struct Knot {
    JointVector q{}, q1{}, q2{};  ///< q2: as seen from the span before
  };
  Result<void, StreamError> evaluate(double t, Knot& knot);
  /// Largest error over tolerance at the middle of `span`, which covers t0..t1 of the phase.
  Result<double, StreamError> middle_error(const JointSpan& span, double t0, double t1);
  /// The same, by the second derivative at its end.
  double end_error(const JointSpan& span, const Knot& end, double duration_s) const;
  void hermite(const Knot& a, const Knot& b, double duration_s, JointSpan& span) const;
  /// How far the span goes, over what its ends and middle can vouch for; 1 or less: near enough.
  double stretch(const Knot& end) const;
  StreamError pose_error(const PoseError& error) const;

  const Kinematics* kinematics_;
  Options options_;
  Counters counters_;
  std::size_t joints_;
  JointVector per_tolerance_{};  ///< 1 / tolerance of each joint
  Phase phase_{};
  bool active_ = false, ended_ = false, have_knot_ = false;
  double phase_start_s_ = 0;
  double done_s_ = 0;  ///< of the phase; negative at first where shorter phases came before
  double step_s_ = 0;
  Knot knot_{};
  JointSpan span_;
};

}  // namespace kinebus
