#pragma once
// How fast path time may run, so that every record is in its node in time and the bus keeps its share free.

#include <cstddef>
#include <cstdint>
#include <span>

#include "gateway/stream/node_stream.hpp"
#include "protocol/time.hpp"

namespace kinebus {

inline constexpr std::size_t kMostNodes = 127;  ///< node-ids that CANopen has

/// Deadline test over the records that wait: all bits due before tau + x must fit the budget while path time
/// covers x. Queued path time is slack, so a short burst does not slow the path and a long dense stretch
/// does, early.
class BusBudget {
 public:
  struct Options {
    double share = 0.60;     ///< of the bus, for everything together
    double overhead = 0.03;  ///< share for SYNC, stamps, statuses, heartbeats, SDO
    double bits_per_second = 1e6;
    double bits_per_record = 137;  ///< 135 stuffed at most, and 1.6 % checkpoints
    /// Path time that must be in a node beyond now: half of the stop ramp (50 ms), a status interval and
    /// margin.
    SegmentUnits reserve{7'500};  ///< 120 ms
    int node_records = 120;       ///< queue of a node
    double lowest_rate = 0.05;
    SegmentUnits stop_way{3'125};  ///< half of the stop ramp: 50 ms
    /// Path time that all nodes have confirmed before it begins to run: a record behind it that a node takes
    /// otherwise than it was sent is seen by the next status, 120 ms later, of which the start's lead is 50,
    /// and the stop that follows ends before that record.
    SegmentUnits confirmed() const { return stop_way + SegmentUnits{6'250}; }
  };

  BusBudget() : BusBudget(Options{}) {}
  explicit BusBudget(Options options) : options_(options) {}

  /// Greatest rate (0..1) that the waiting records allow at path time tau. 0 only when a node is about to run
  /// dry and the run is not complete. Cost: a few dozen look-ups.
  double allowed_rate(std::span<const NodeStream* const> nodes, PathTime tau, bool run_complete) const;
  const Options& options() const { return options_; }

 private:
  /// At which a record that a node takes otherwise is seen, and a stop made, before it begins.
  double rate_of_full_queue(double covered_s) const;

  Options options_;
};

}  // namespace kinebus
