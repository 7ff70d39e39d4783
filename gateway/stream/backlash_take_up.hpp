#pragma once
// Backlash in the path: after a joint has turned round, its motor leads by the gap, brought in by a motion of
// constant acceleration on top of the planned one. Never a jump: value and slope stay continuous.

#include <array>
#include <deque>
#include <optional>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/joint_span.hpp"

namespace kinebus {

/// Spans in, spans out: the same motion plus side * gap / 2 of each joint. side is +1 after motion in
/// positive direction, -1 after the other. Pull style: push a span when wants_span(), then call next() until
/// it gives no more. A run whose last span ends inside a take-up becomes longer by the rest of it.
class BacklashTakeUp {
 public:
  struct Joint {
    double gap = 0;            ///< mm or rad, drive units
    double accel_per_s2 = 0;   ///< kept free for this by the planner
    double hysteresis = 1e-3;  ///< a joint has turned round when it went back by this
    double home_side = 1;      ///< after homing
  };
  using Joints = std::array<Joint, kMaxJoints>;

  explicit BacklashTakeUp(const Joints& joints);

  bool needed() const { return needed_; }
  /// Homing left every joint on its home side.
  void homed();
  /// Begins a run at time 0. Sides go on from the run before.
  void restart();
  /// The run was lost at this time: take-ups stay as far as they had come.
  void abandon(double time_s);

  bool wants_span() const { return out_.empty(); }
  void push(const JointSpan& span);
  std::optional<JointSpan> next();

  /// -1..1, at a time of the run not long ago; and at the end of all that was pushed.
  double side_at(int joint, double time_s) const;
  double side(int joint) const;

 private:
  struct Event {
    double start_s = 0, duration_s = 0, from = 0, to = 0;
    double end_s() const { return start_s + duration_s; }
  };
  struct Track {
    Joint joint;
    double direction = 1, extreme = 0;
    bool started = false;
    double settled = 0;        ///< offset before the first event kept
    std::deque<Event> events;  ///< in order, none overlapping
  };
  static double offset_at(const Track& track, double time_s);
  static std::array<double, 3> branch_at(const Track& track, double time_s, double from_s);
  void watch(Track& track, const JointSpan& span, std::size_t joint);
  static void add_event(Track& track, double time_s);
  void turn_round(Track& track, double time_s, double position);
  void cut(const JointSpan& span);

  std::array<Track, kMaxJoints> tracks_;
  std::deque<JointSpan> out_;
  bool needed_ = false;
};

}  // namespace kinebus
