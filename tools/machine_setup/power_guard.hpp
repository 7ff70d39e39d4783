#pragma once
// Whatever happens while something is tested: in the end nothing has power.

#include <vector>

#include "protocol/canopen/heat_objects.hpp"
#include "protocol/canopen/nmt.hpp"
#include "tools/card/card.hpp"

namespace kinebus {

/// Both motors of each node are off when it ends.
class MotorsOff {
 public:
  MotorsOff(BusAccess bus, std::vector<std::uint8_t> nodes)
      : bus_(std::move(bus)), nodes_(std::move(nodes)) {}
  MotorsOff(const MotorsOff&) = delete;
  MotorsOff& operator=(const MotorsOff&) = delete;
  ~MotorsOff() {
    for (const std::uint8_t node : nodes_)
      for (const int axis : {0, 1}) try {
          Card(bus_, node).power(axis, false);
        } catch (const std::exception&) {  // a node that does not answer cannot be told
        }
  }

 private:
  BusAccess bus_;
  std::vector<std::uint8_t> nodes_;
};

/// All set points and outputs of each heat node are 0 when it ends, and it is pre-operational as a gateway
/// expects it: else the first SYNC, which it was not told of, is an alarm.
class HeatOff {
 public:
  HeatOff(BusAccess bus, std::vector<std::uint8_t> nodes) : bus_(std::move(bus)), nodes_(std::move(nodes)) {}
  HeatOff(const HeatOff&) = delete;
  HeatOff& operator=(const HeatOff&) = delete;
  ~HeatOff() {
    for (const std::uint8_t node : nodes_) try {
        NodeSdo heat(bus_, node, kHeatTable);
        for (std::uint8_t n = 0; n < kHeaters; ++n)
          heat.write({heat_object::kSetPoint.index, static_cast<std::uint8_t>(n + 1)}, 0);
        for (std::uint8_t n = 0; n < kFans; ++n)
          heat.write({heat_object::kFanOutput.index, static_cast<std::uint8_t>(n + 1)}, 0);
        heat.send(nmt_frame(NmtCommand::kEnterPreOperational, node));
      } catch (const std::exception&) {  // it lets go by itself without a master
      }
  }

 private:
  BusAccess bus_;
  std::vector<std::uint8_t> nodes_;
};

}  // namespace kinebus
