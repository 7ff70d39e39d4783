#pragma once
// The machine coming to rest, and the standstill in which queues are emptied and positions are read before
// anything moves again; and why it does, so what comes after.

#include <cstdint>
#include <deque>

#include "gateway/bus_nodes/standstill.hpp"
#include "gateway/description/machine_description.hpp"
#include "gateway/stream/path_rate.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class Rest {
 public:
  enum class After : std::uint8_t { kBringUp, kHoming, kCancel, kJog, kClear, kHeatFault, kProbe };

  Rest(const MachineDescription& machine, std::deque<NodeLink>& links, const PathRate& rate)
      : rate_(rate), standstill_(machine, links) {}

  /// Path time stands. Notes since when: to be asked as time passes.
  bool standing(BusTime now) {
    if (rate_.at_rest(now)) return true;
    since_ = now;
    return false;
  }
  /// It stood since `since` at the earliest.
  void begin(BusTime since) { since_ = since; }
  /// Path time stands for so long that the nodes' last status frames are here.
  bool settled(BusTime now) { return standing(now) && now - since_ >= kSettle; }

  void read(BusTime now, After after) {
    after_ = after;
    standstill_.start(rate_.tau(now));
  }
  /// What is being read is for something else now.
  void read_for(After after) { after_ = after; }
  bool reading() const { return standstill_.busy(); }
  Standstill::Outcome on_time() { return standstill_.on_time(); }
  void abort() { standstill_.abort(); }
  const StepFailure& failure() const { return standstill_.failure(); }
  /// What was read, after kDone.
  const Standstill& found() const { return standstill_; }
  After after() const { return after_; }

  /// Status frames come 100 ms apart.
  static constexpr BusTime kSettle = std::chrono::milliseconds{150};

 private:
  const PathRate& rate_;
  Standstill standstill_;
  After after_ = After::kBringUp;
  BusTime since_{0};
};

}  // namespace kinebus
