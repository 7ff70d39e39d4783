#include "gateway/stream/joint_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus {

namespace {
// Shorter phases have no span of their own: rounding would show as acceleration (1e-13 mm over 1e-8 s is 1000
// mm/s^2). The span after them begins before them; a change of 6000 mm/s^2 in between costs it 0.004 um.
constexpr double kShortestPhase_s = 2e-7;
constexpr double kRestSpeed = 1e-3;  // mm/s: what the planner's rounding may leave of a stop
// Both checks hold exactly as long as the fourth derivative is constant over the span; the rest is for when
// it is not.
constexpr double kCheckedShare = 0.85;
}  // namespace

JointSampler::JointSampler(const Kinematics& kinematics, Options options)
    : kinematics_(&kinematics),
      options_(std::move(options)),
      joints_(static_cast<std::size_t>(kinematics.joint_count())) {
  for (std::size_t j = 0; j < joints_; ++j) {
    const bool rotary = kinematics.joint_info(static_cast<int>(j)).rotary;
    per_tolerance_[j] = 1 / (kCheckedShare * (rotary ? options_.tolerance_rad : options_.tolerance_mm));
  }
}

void JointSampler::restart() {
  active_ = ended_ = have_knot_ = false;
  phase_start_s_ = done_s_ = step_s_ = 0;
}

StreamError JointSampler::pose_error(const PoseError& error) const {
  StreamError e{.kind = StreamError::Kind::kPose, .line = phase_.line};
  e.pose = error;
  return e;
}

Result<void, StreamError> JointSampler::evaluate(double t, Knot& knot) {
  JointPoint joints;
  if (auto ok = kinematics_->inverse_along(phase_.piece.frame, phase_.at(t), joints); !ok)
    return Error<StreamError>(pose_error(ok.error()));
  ++counters_.evaluations;
  knot.q = joints.q;
  knot.q1 = joints.q1;
  knot.q2 = joints.q2;
  for (std::size_t j = 0; j < joints_; ++j) {
    if (!options_.maps[j]) continue;
    const JointMap::Value v = options_.maps[j]->at(knot.q[j]);
    knot.q2[j] = v.g1 * knot.q2[j] + v.g2 * knot.q1[j] * knot.q1[j];
    knot.q1[j] *= v.g1;
    knot.q[j] = v.g;
  }
  return {};
}

double JointSampler::stretch(const Knot& end) const {
  double worst = 0;
  for (std::size_t j = 0; j < joints_; ++j)
    if (options_.maps[j])
      worst = std::max(worst, std::abs(end.q[j] - knot_.q[j]) / options_.maps[j]->longest_step());
  return worst;
}

Result<void, StreamError> JointSampler::push(const Phase& phase) {
  if (!wants_phase()) return Error<StreamError>({.kind = StreamError::Kind::kPhaseOrder, .line = phase.line});
  const double end_speed = phase.last ? phase.pose_speed(phase.duration_s) : 0.0;
  const double speed = std::max(have_knot_ ? 0.0 : phase.pose_speed(0), end_speed);
  if (speed > kRestSpeed)
    return Error<StreamError>({.kind = StreamError::Kind::kNotAtRest, .line = phase.line, .amount = speed});
  ++counters_.phases;
  phase_ = phase;
  if (!have_knot_) {
    if (auto ok = evaluate(0, knot_); !ok) return ok;
    knot_.q1 = {};
    have_knot_ = true;
  }
  if (phase.duration_s < kShortestPhase_s && !phase.last) {
    done_s_ -= phase.duration_s;
    phase_start_s_ += phase.duration_s;
    return {};
  }
  active_ = true;
  step_s_ = phase.duration_s / std::max(1.0, std::ceil(phase.duration_s / options_.longest_span_s));
  return {};
}

void JointSampler::hermite(const Knot& a, const Knot& b, double h, JointSpan& span) const {
  const double per_h = h > kShortestPhase_s ? 1 / h : 0;
  for (std::size_t j = 0; j < joints_; ++j) {
    const double slope = (b.q[j] - a.q[j]) * per_h;
    span.coefficients[j] = {a.q[j], a.q1[j], (3 * slope - 2 * a.q1[j] - b.q1[j]) * per_h,
                            (a.q1[j] + b.q1[j] - 2 * slope) * per_h * per_h};
  }
}

Result<double, StreamError> JointSampler::middle_error(const JointSpan& span, double t0, double t1) {
  const double t = 0.5 * (t0 + t1);
  JointVector q;
  if (auto ok = kinematics_->inverse(phase_.piece.frame, phase_.piece.evaluate(phase_.s(t)).x, q); !ok)
    return Error<StreamError>(pose_error(ok.error()));
  ++counters_.evaluations;
  double worst = 0;
  for (std::size_t j = 0; j < joints_; ++j)
    if (options_.maps[j]) q[j] = options_.maps[j]->to_drive(q[j]);
  for (std::size_t j = 0; j < joints_; ++j)
    worst = std::max(worst, std::abs(span.position(static_cast<int>(j), t - t0) - q[j]) * per_tolerance_[j]);
  return worst;
}

double JointSampler::end_error(const JointSpan& span, const Knot& end, double h) const {
  // A cubic Hermite's error is q4 t^2 (h - t)^2 / 24: q4 h^4 / 384 in the middle, with a second derivative of
  // q4 h^2 / 12 at both ends.
  double worst = 0;
  for (std::size_t j = 0; j < joints_; ++j)
    worst =
        std::max(worst, std::abs(end.q2[j] - 2 * span.coefficients[j][2] - 6 * h * span.coefficients[j][3]) *
                            per_tolerance_[j]);
  return worst * h * h / 32;
}

Result<const JointSpan*, StreamError> JointSampler::next() {
  if (!active_) return nullptr;
  JointSpan& span = span_;
  Knot end;
  double t1 = 0;
  for (;;) {
    const bool final = done_s_ + 1.5 * step_s_ > phase_.duration_s;
    t1 = final ? phase_.duration_s : done_s_ + step_s_;
    if (auto ok = evaluate(t1, end); !ok) return Error<StreamError>(ok.error());
    if (final && phase_.last) end.q1 = {};
    hermite(knot_, end, t1 - done_s_, span);
    const double h = t1 - done_s_;
    if (h <= options_.unchecked_span_s) break;
    double error = 0;
    if (const double far = stretch(end); far > 1) {
      error = far * far * far * far;
    } else if (h <= options_.end_checked_span_s) {
      error = end_error(span, end, h);
    } else {
      const auto middle = middle_error(span, done_s_, t1);
      if (!middle) return Error<StreamError>(middle.error());
      error = *middle;
    }
    if (error <= 1) break;
    // The error goes with the fourth power of the span; the rest of the phase is divided evenly.
    const double rest = phase_.duration_s - done_s_;
    const double wanted = h * std::max(0.1, 0.95 / std::sqrt(std::sqrt(error)));
    step_s_ = rest / std::ceil(rest / wanted);
  }
  span.start_s = phase_start_s_ + done_s_;
  span.duration_s = t1 - done_s_;
  span.line = phase_.line;
  span.eased = phase_.jerk != 0;
  knot_ = end;
  done_s_ = t1;
  ++counters_.spans;
  span.last = false;
  if (t1 >= phase_.duration_s) {
    span.last = phase_.last;
    ended_ = phase_.last;
    phase_start_s_ += phase_.duration_s;
    done_s_ = 0;
    active_ = false;
  }
  return &span;
}

}  // namespace kinebus
