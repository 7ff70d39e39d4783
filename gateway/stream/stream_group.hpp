#pragma once
// From phases to frames, for all nodes of the machine together.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/kinematics/kinematics.hpp"
#include "gateway/motion/trajectory.hpp"
#include "gateway/result.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "gateway/stream/backlash_take_up.hpp"
#include "gateway/stream/bus_budget.hpp"
#include "gateway/stream/joint_sampler.hpp"
#include "gateway/stream/node_stream.hpp"
#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/stream_error.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Owns sampler, segmenters and node streams. One run = START on all nodes at one path time, motion, END at
/// rest.
///
///   set_state(node, ...) for each node    where it stands, once after homing or a restart
///   begin_run()                           then push(phase) while wants_phases(), up to the one marked `last`
///   release(tau_start)                    names the START time; from then on frames come
///   next_frame(now, tau), on_status(...)  tau: the gateway's own path clock
///   run_done(tau)                         all nodes are at rest behind their END
///
/// Feed hold and resume need nothing here: path time stops and goes on. After a run was lost, cancel() and
/// start anew from joints_at(tau).
class StreamGroup {
 public:
  struct Options {
    JointSampler::Options sampler;
    Segmenter::Options segmenter;
    NodeStream::Options stream;
    BusBudget::Options budget;
    /// Path time that is fitted ahead of now, s: horizon 0.4, look-ahead of the rate 1.0, and some.
    double lead_s = 1.6;
    /// A run may begin this far from where an axis stands; the first segments take it back.
    double start_offset_counts = 4;
  };
  enum class State : std::uint8_t { kIdle, kFilling, kRunning, kDone };

  StreamGroup(const Kinematics& kinematics, const std::vector<NodeAxes>& nodes)
      : StreamGroup(kinematics, nodes, Options{}) {}
  StreamGroup(const Kinematics& kinematics, const std::vector<NodeAxes>& nodes, const Options& options);

  std::size_t node_count() const { return nodes_.size(); }
  /// Where the axes of a node stand (their velocity counts as 0), and the stream status it last reported.
  /// Only when idle or done.
  void set_state(std::uint8_t node_id, const std::array<AxisState, kAxesPerNode>& states,
                 const StreamStatus& status);

  /// Only when idle, or when every node has accepted the END of the run before.
  void begin_run();
  /// One more phase can be taken: buffers have room and less than lead_s is fitted beyond `tau`.
  bool wants_phases(PathTime tau) const;
  Result<void, StreamError> push(const Phase& phase);
  /// START at this path time on all nodes (rounded up to 16 us); must lie after the previous run's end.
  void release(PathTime start);
  /// Homing has brought every joint to its home side of the gap.
  void homed() { take_up_.homed(); }
  /// Where a joint's motor stands in its gap, for AxisScaling.
  double side(int joint) const { return take_up_.side(joint); }
  /// Drops all that is not sent; nodes must be stopped and their queues cleared. Then set_state() again.
  void cancel();

  /// Next frame for the bus: the node with the least queued path time first.
  std::optional<CanFrame> next_frame(BusTime now, PathTime tau);
  Result<void, StreamError> on_status(BusTime now, std::uint8_t node_id, const StreamStatus& status,
                                      PathTime tau);
  State state() const { return state_; }
  /// begin_run() may be called.
  bool may_begin() const;
  /// All records up to END are made (the last phase came and every span of it is fitted).
  bool complete() const;
  /// The nodes have confirmed enough for path time to run, or the whole run.
  bool primed(PathTime tau) const;
  /// Every node accepted its END, and tau is past it.
  bool run_done(PathTime tau) const;
  /// All nodes have passed this path time, by what they said last; at most `tau`.
  PathTime confirmed(PathTime tau) const;
  /// Rate (0..1) that bus and buffers allow now; 1 when idle.
  double allowed_rate(PathTime tau) const;

  PathTime run_start() const { return PathTime{start_units_ * kPathTicksPerUnit}; }
  /// End of what is fitted so far; after complete(): the run's end at rest.
  PathTime fitted_until() const;
  /// Exact states and joint positions at path time tau, from the records kept.
  std::optional<std::array<AxisState, kAxesPerNode>> state_at(std::uint8_t node_id, PathTime tau) const;
  std::optional<JointVector> joints_at(PathTime tau) const;
  std::uint32_t line_at(PathTime tau) const;

  const JointSampler& sampler() const { return sampler_; }
  const Segmenter& segmenter(std::size_t i) const { return nodes_[i].segmenter; }
  const NodeStream& stream(std::size_t i) const { return nodes_[i].stream; }

 private:
  struct Node {
    Segmenter segmenter;
    NodeStream stream;
    bool end_pushed = false;
  };
  Node* find(std::uint8_t node_id);
  const Node* find(std::uint8_t node_id) const;
  bool all_accepted() const;
  /// Sampler to segmenters to streams, as far as there is room.
  Result<void, StreamError> pump();
  Result<void, StreamError> feed(const JointSpan& span);
  void drain(Node& node);
  /// Time of the run, s.
  double run_time(PathTime tau) const { return to_seconds(tau) - to_seconds(run_start()); }

  Options options_;
  JointSampler sampler_;
  BacklashTakeUp take_up_;
  BusBudget budget_;
  std::vector<Node> nodes_;
  State state_ = State::kIdle;
  PathTime last_tau_{0};
  bool released_ = false;
  std::int64_t start_units_ = 0;
};

}  // namespace kinebus
