#pragma once
// What the nodes say, and what it means for the machine: nodes that fall silent or restart, emergencies,
// clocks that drift apart, streams that went wrong.

#include <deque>
#include <optional>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/status/event_queue.hpp"
#include "gateway/status/state.hpp"
#include "gateway/status/status.hpp"
#include "gateway/stream/path_rate.hpp"
#include "gateway/stream/stream_group.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class NodeWatch {
 public:
  /// What the machine is about.
  struct Situation {
    MachineState state{};
    bool bringing_up = false;
    bool homes = false;    ///< the carriages of this node home, and it has told where they are in time
    bool enabled = false;  ///< all drives were enabled, and nobody has been told to switch them off
    bool follows = false;  ///< all axes are at the gateway's records
    std::optional<BusTime> rests_since{};  ///< nothing was to move since then
  };
  /// What has to follow.
  struct Verdict {
    bool stop = false;
    bool by_absence = false;      ///< all of the stop's reasons are that nobody spoke to the nodes
    bool fault = false;           ///< the stop ends in an alarm
    bool positions_lost = false;  ///< of a node
    bool stream_lost = false;     ///< what the nodes hold is not what was sent
  };

  NodeWatch(const MachineDescription& machine, std::deque<NodeLink>& links, const PathRate& rate,
            StreamGroup& group, EventQueue& events, MachineCounters& counters)
      : machine_(machine), links_(links), rate_(rate), group_(group), events_(events), counters_(counters) {}

  /// Before look() at each node. `streaming`: records flow and path time runs. Behind the end of a run nodes
  /// have nothing to tell, though path time may still come to rest.
  void on_time(BusTime now, bool streaming);
  /// At what a node has said, or not said for too long.
  Verdict look(BusTime now, std::size_t node, const Situation& situation);
  /// At the stream status that has just come. `stopping`: the run is being stopped, and may go on.
  Verdict take_stream(BusTime now, NodeLink& link, const StreamStatus& status, bool stopping);

  /// A node stops for it when the gateway says nothing.
  static bool is_of_absence(StopReason reason);
  /// The gateway was away until now: no node could be heard.
  void on_stall(BusTime now) { listens_since_ = now; }

  /// A node was lost or restarted: nothing but a bring-up helps.
  bool needs_bring_up() const { return needs_bring_up_; }
  void lose() { needs_bring_up_ = true; }
  void bring_up_begins() { needs_bring_up_ = false; }

  /// A node that executes records sends its status every 100 to 120 ms; one of two may be late or lost.
  static constexpr BusTime kStatusTimeout = std::chrono::milliseconds{250};

 private:
  void take_emergencies(BusTime now, NodeLink& link, const Situation& situation, Verdict& verdict);
  /// What another device may have done to its drives.
  void check_drives(BusTime now, const NodeLink& link, const Situation& situation, Verdict& verdict);
  void tell_order(BusTime now, const NodeLink& link, const StreamStatus& status);
  bool check_clock(BusTime now, const NodeLink& link, const StreamStatus& status, Verdict& verdict);

  const MachineDescription& machine_;
  std::deque<NodeLink>& links_;
  const PathRate& rate_;
  StreamGroup& group_;
  EventQueue& events_;
  MachineCounters& counters_;
  bool needs_bring_up_ = false;
  bool told_order_ = false;
  BusTime listens_since_{0};    ///< what was not heard before says nothing
  BusTime streaming_since_{0};  ///< path time runs; the present, when it does not
};

}  // namespace kinebus
