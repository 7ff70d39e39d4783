#pragma once
// Phase -> JointSpans: q(tau) as cubic Hermite polynomials in time through exact joint positions and
// velocities.

#include <cstdint>
#include <optional>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/joint_span.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/result.hpp"
#include "gateway/stream/stream_error.hpp"

namespace kinebus {

/// Post-condition: spans join with equal value and slope; each stays within `tolerance` of the exact inverse
/// kinematics of pose(tau) (checked where a cubic Hermite's error is largest: at its middle).
/// Pull style: push one phase when wants_phase(), then call next() until it gives no more.
/// Cost: one inverse_along a span, and one inverse for its check. No heap.
class JointSampler {
 public:
  struct Options {
    double tolerance = 20e-6;      ///< mm or rad: 0.02 um, a twentieth of half a count
    double longest_span_s = 0.25;  ///< about two of the longest segments
    /// Not checked below this: |q''''| <= 3 a^2 / r = 0.27e6 mm/s^4 for a = 3000 mm/s^2 and a radius of
    /// curvature of the inverse kinematics of 100 mm; times 0.005^4 / 384 that is 0.0005 um.
    double unchecked_span_s = 0.005;
  };
  struct Counters {
    std::uint64_t phases = 0, spans = 0, evaluations = 0;
  };

  explicit JointSampler(const Kinematics& kinematics) : JointSampler(kinematics, Options{}) {}
  JointSampler(const Kinematics& kinematics, Options options);

  /// Begins a new run at path time 0 of the run.
  void restart();
  bool wants_phase() const { return !active_ && !finished_; }
  /// Phases shorter than a nanosecond are passed over. Error kPose: where the path cannot be reached.
  Result<void, StreamError> push(const Phase& phase);
  /// No more phases: the last span is released, marked `last`.
  void finish();
  /// The next span; nullopt: push a phase (or, after finish(), the run is over). Error kPose ends the run.
  Result<std::optional<JointSpan>, StreamError> next();

  /// Path time up to which phases were taken, s since the run's start.
  double end_s() const { return phase_start_s_ + (active_ ? phase_.duration_s : 0.0); }
  const Counters& counters() const { return counters_; }

 private:
  struct Knot {
    JointVector q{}, q1{};
  };
  Result<void, StreamError> evaluate(double t, Knot& knot);
  Result<double, StreamError> middle_error(const JointSpan& span, double t0, double t1);
  JointSpan hermite(const Knot& a, const Knot& b, double t0, double t1) const;
  StreamError pose_error(const PoseError& error) const;

  const Kinematics* kinematics_;
  Options options_;
  Counters counters_;
  int joints_;
  Phase phase_{};
  bool active_ = false, finished_ = false, have_knot_ = false;
  double phase_start_s_ = 0, done_s_ = 0, step_s_ = 0;
  Knot knot_{};
  std::optional<JointSpan> held_;  ///< kept back until it is known whether it is the last
};

}  // namespace kinebus
