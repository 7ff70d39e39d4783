#pragma once
// The gateway's own voice on the bus, SYNC with its stamps and the heartbeat; and how busy the bus is.

#include <optional>

#include "gateway/description/machine_description.hpp"
#include "gateway/jobs/bus_load.hpp"
#include "gateway/stream/sync_producer.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/heartbeat.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class BusVoice {
 public:
  BusVoice(const MachineDescription& machine, std::uint8_t epoch);

  /// SYNC and heartbeat are sent.
  bool speaks() const { return speaks_; }
  void begin(BusTime now);
  void end() { speaks_ = false; }
  /// A node that was restarted has few SYNCs yet: they come often for a while.
  void nodes_are_new(BusTime now) { since_ = now; }

  void on_time(BusTime now, bool bringing_up);
  void on_frame(BusTime when, const CanFrame& frame);
  void on_frame_sent(BusTime when, const CanFrame& frame);
  std::optional<CanFrame> next_frame(BusTime now);
  /// Of what is not due yet; `otherwise` when that is earlier.
  BusTime next_deadline(BusTime now, BusTime otherwise) const;
  /// max: none is to come.
  BusTime sync_due() const { return speaks_ ? sync_.next_deadline() : BusTime::max(); }
  const BusLoad& load() const { return load_; }

 private:
  const MachineDescription& machine_;
  StampedSyncProducer sync_;
  HeartbeatProducer heartbeat_;
  BusLoad load_;
  bool speaks_ = false;
  BusTime since_{0};  ///< when SYNC began, or the last bring-up ended
};

}  // namespace kinebus
