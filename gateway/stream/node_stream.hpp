#pragma once
// The records of one node: numbering, checkpoints, credit, horizon, and what each of them means exactly.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/stream/segmenter.hpp"
#include "gateway/stream/stream_error.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"
#include "protocol/time.hpp"

namespace kinebus {

/// Sends segment records to one node ahead of their time, within what the node has room for.
/// A record is kept until the node's path time has passed its end, so the exact position at the tau of a stop
/// is known.
class NodeStream {
 public:
  struct Options {
    /// Path time ahead of now that is kept in the node: stop ramp (half of 100 ms) + status interval 100 ms +
    /// margin.
    SegmentUnits horizon{25'000};  ///< 400 ms
    /// Records between two checkpoints, axes in turn. 1.6 % more frames; a wrong axis is seen after 128
    /// records.
    int checkpoint_interval = 64;
    /// Sent but not accepted for this long, while statuses do come: the records are lost.
    BusTime lost_after{std::chrono::milliseconds{350}};
    int acceleration_shift = kDefaultAccelerationShift;
    int queue_records = 120;  ///< a node's queue: more credit than this is not believed
  };
  struct Counters {
    std::uint64_t records = 0, checkpoints = 0, statuses = 0;
  };
  /// A status that comes after one that was sent later may be so many records behind it. One so far ahead
  /// instead would have taken more at once than a node's queue holds.
  static constexpr int kMaxOvertaken = kSequenceModulus - 121;
  static constexpr std::size_t kCapacity = 1024;  ///< records kept: executed-not-confirmed, sent and waiting

  explicit NodeStream(std::uint8_t node_id) : NodeStream(node_id, Options{}) {}
  NodeStream(std::uint8_t node_id, Options options);

  /// Where the node stands (its velocity counts as 0) and which record it expects; forgets all records.
  void reset(const std::array<AxisState, kAxesPerNode>& states, std::uint8_t next_sequence,
             std::uint8_t free_records);
  bool has_room() const { return end_ - begin_ + 2 < kCapacity; }
  /// Room for this many more records is left.
  std::size_t room() const { return kCapacity - 2 - static_cast<std::size_t>(end_ - begin_); }

  void push_start();                        ///< opens a run; its records wait for release()
  void push(const FittedSegment& segment);  ///< times relative to the run's start
  void push_end();
  /// The open run starts at this absolute path time (16 us units): its records may now go out.
  void release(std::int64_t start_units);

  /// A frame may go out at path time tau: there is a record, the node has room for it, and it is within the
  /// horizon.
  bool has_frame(PathTime tau) const {
    return sent_ < end_ && sent_ < credit_ && !(open_ && sent_ >= released_) &&
           at(sent_).start_units <= (tau.count() >> 8) + options_.horizon.count();
  }
  /// That frame; nullopt: none now.
  std::optional<CanFrame> next_frame(BusTime now, PathTime tau);
  Result<void, StreamError> on_status(BusTime now, const StreamStatus& status, PathTime tau);

  bool all_sent() const { return sent_ == end_; }
  bool all_accepted() const { return accepted_ == end_; }
  /// Path time (units) at which the node runs out of accepted records, of sent ones, of all that are made.
  std::int64_t accepted_until_units() const { return begins_units(accepted_); }
  std::int64_t sent_until_units() const { return begins_units(sent_); }
  std::int64_t made_until_units() const { return tail_units_; }
  /// The n-th record that is not sent begins here (path time, units); n may go beyond the last.
  std::int64_t unsent_begins_units(std::uint64_t n) const { return begins_units(sent_ + n); }
  std::uint64_t unsent() const { return end_ - sent_; }
  /// How many of those begin at or before `units`; `known`: so many do, as was found for an earlier time.
  /// Cost: logarithmic in what there is beyond the known ones.
  std::uint64_t unsent_until(std::int64_t units, std::uint64_t known = 0) const;

  /// Exact state of both axes at path time tau, by the records kept. nullopt: tau lies before the records
  /// kept.
  std::optional<std::array<AxisState, kAxesPerNode>> state_at(PathTime tau) const;
  /// Behind all records made.
  const std::array<AxisState, kAxesPerNode>& final_state() const { return tail_; }
  /// Behind the last record that the node accepted.
  const std::array<AxisState, kAxesPerNode>& accepted_state() const;
  /// The job's line at path time tau; 0: none known.
  std::uint32_t line_at(PathTime tau) const;
  std::optional<StreamStatus> last_status() const { return last_status_; }
  std::uint8_t node_id() const { return node_id_; }
  const Counters& counters() const { return counters_; }

 private:
  Result<void, StreamError> silence(BusTime now, PathTime tau) const;
  /// What the node has made of the records that it accepted is what was sent, as far as 8 bits tell.
  bool agrees(const StreamStatus& status, std::int64_t path_units) const;
  struct Record {
    std::int64_t start_units = 0;  ///< absolute path time of its first knot
    std::int32_t duration = 0;     ///< 0: control record
    std::array<std::int32_t, kAxesPerNode> acceleration{};
    std::array<AxisState, kAxesPerNode> start{};
    std::uint32_t line = 0;
    SegmentControl control = SegmentControl::kNone;
    std::uint8_t checkpoints = 0;  ///< bit per axis: sent before this record
  };
  Record& at(std::uint64_t n) { return records_[n & (kCapacity - 1)]; }
  const Record& at(std::uint64_t n) const { return records_[n & (kCapacity - 1)]; }
  const Record* covering(std::int64_t units) const;
  std::int64_t begins_units(std::uint64_t n) const { return n < end_ ? at(n).start_units : tail_units_; }
  /// Path time at the knot before record n, as the node counts it: a START is where the run before ended.
  std::int64_t knot_units(std::uint64_t n) const {
    return n < end_ && at(n).control == SegmentControl::kStart ? at(n - 1).start_units : begins_units(n);
  }
  void append(Record record);
  void forget_before(std::int64_t units);

  std::uint8_t node_id_;
  Options options_;
  Counters counters_;
  std::vector<Record> records_;  ///< ring of kCapacity, allocated once
  // Record numbers since reset(), unwrapped; the sequence on the wire is the number mod 128.
  // begin <= accepted <= sent <= end.
  std::uint64_t begin_ = 0, accepted_ = 0, sent_ = 0, end_ = 0, credit_ = 0;
  std::uint64_t released_ = 0;  ///< records before this one have absolute times
  bool open_ = false;  ///< a run is begun and not released: its records have times relative to its start
  std::uint8_t checkpoints_sent_ = 0;  ///< of record sent_
  std::uint64_t next_checkpoint_ = 0;
  int checkpoint_axis_ = 0;
  std::int64_t run_start_units_ = 0, tail_units_ = 0;
  std::array<AxisState, kAxesPerNode> tail_{};
  std::optional<StreamStatus> last_status_;
  BusTime progress_{0};  ///< when a record was last accepted, or first sent after that
};

}  // namespace kinebus
