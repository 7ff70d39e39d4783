#pragma once
// Streams from outside: what is on the bus between gateway and nodes. Every record in its sequence, never
// more than the node has room for, no queue that ran empty in motion.

#include <algorithm>
#include <array>
#include <cstdint>

#include "protocol/bytes.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/motion/segment.hpp"

namespace kinebus {

class QueueChecker {
 public:
  struct Findings {
    std::uint32_t out_of_sequence = 0;  ///< records whose number is not the next one
    std::uint32_t overruns = 0;         ///< records sent beyond the room that the node had reported
    std::uint32_t error_flags = 0;      ///< status frames that tell of an underrun or a lost record
    int fullest = 0;                    ///< most records in one queue
  };

  /// A node without axes: what it sends and is sent by these identifiers is no stream.
  void leave_out(std::uint8_t node) { nodes_[node & 0x7Fu].streams = false; }

  void on_frame(const CanFrame& frame) {
    if (frame.extended || frame.remote || frame.length != 8) return;
    const std::uint32_t node = frame.id & 0x7F;
    if (node == 0 || !nodes_[node].streams) return;
    if (frame.id - node == kRecords)
      on_record(nodes_[node], frame);
    else if (frame.id - node == kStatus)
      on_status(nodes_[node], decode_stream_status(get_u64_le(frame.data)));
  }
  const Findings& findings() const { return findings_; }
  /// Another gateway: its streams begin with the numbers that the nodes tell it.
  void on_new_gateway() {
    for (Node& node : nodes_) node.next = -1;
  }

 private:
  static constexpr std::uint32_t kRecords = 0x400, kStatus = 0x280;
  struct Node {
    bool streams = true;
    int next = -1;  // the sequence number due; -1: not known yet
    StreamStatus status;
    int capacity = 0;
  };

  void on_record(Node& node, const CanFrame& frame) {
    const int sequence = static_cast<int>(get_u64_le(frame.data) & 0x7F);
    if (node.next >= 0 && sequence != node.next) ++findings_.out_of_sequence;
    node.next = (sequence + 1) % kSequenceModulus;
    const int ahead = (sequence - node.status.next_sequence + kSequenceModulus) % kSequenceModulus;
    if (node.capacity > 0 && ahead >= node.status.free_records) ++findings_.overruns;
  }

  void on_status(Node& node, const StreamStatus& status) {
    constexpr unsigned kErrors =
        StreamStatus::kUnderrun | StreamStatus::kSequenceError | StreamStatus::kCheckpointError;
    if ((status.flags & kErrors) != 0) ++findings_.error_flags;
    node.status = status;
    node.capacity = std::max<int>(node.capacity, status.free_records);
    findings_.fullest = std::max(findings_.fullest, node.capacity - status.free_records);
  }

  std::array<Node, 128> nodes_{};
  Findings findings_;
};

}  // namespace kinebus
