#pragma once
// Nodes that do all they should, at once: they take records, execute them by path time, and report their
// stream status as the real ones do. What `kinebus plan` streams against.

#include <array>
#include <cstdint>
#include <vector>

#include "protocol/can/frame.hpp"
#include "protocol/motion/broadcast.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class IdealNode {
 public:
  static constexpr int kQueueRecords = 120;
  static constexpr int kRecordsPerStatus = 32;
  static constexpr BusTime kStatusPeriod = std::chrono::milliseconds{100};

  explicit IdealNode(std::uint8_t id) : id_(id) {}
  std::uint8_t id() const { return id_; }

  /// Takes a record of this node; other frames are of no interest.
  void on_frame(const CanFrame& frame);
  /// Executes up to path time `tau`; true: a status is due at `now`.
  bool on_time(BusTime now, PathTime tau);
  StreamStatus status(PathTime tau) const;
  std::uint64_t segments() const { return segments_; }

 private:
  static constexpr std::size_t kRing = 128;
  std::uint8_t id_;
  std::array<std::int64_t, kRing> end_units_{};  ///< end of each record in the queue
  std::uint64_t taken_ = 0, executed_ = 0, executed_at_status_ = 0;
  std::uint64_t segments_ = 0;
  std::int64_t tail_units_ = 0;
  bool at_rest_ = true;
  BusTime next_status_{0};
};

}  // namespace kinebus
