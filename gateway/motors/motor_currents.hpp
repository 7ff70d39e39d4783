#pragma once
// What the motors' currents and their power stages' temperatures are, as their nodes measure them (2150h:9
// and :10). Read over SDO, one axis after the other, and only while somebody looks: a print that nobody
// watches has no such frames on its bus.

#include <array>
#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "gateway/bus_nodes/node_link.hpp"
#include "gateway/stream/axis_scaling.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class MotorCurrents {
 public:
  explicit MotorCurrents(std::size_t nodes) : read_(nodes) {}

  /// Somebody looks now, and will look again.
  void watch(BusTime now) { until_ = now + std::chrono::seconds{2}; }
  /// `may_ask`: nothing else is asked of the nodes. `axes`: by node, as the links.
  void on_time(BusTime now, std::deque<NodeLink>& links, const std::vector<NodeAxes>& axes, bool may_ask);
  /// Amplitude, A; empty: not read in the last seconds.
  std::optional<double> amperes(std::size_t node, std::size_t axis, BusTime now) const;
  /// Of the power stage; empty: not read in the last half minute, or the node has no sensor.
  std::optional<double> celsius(std::size_t node, std::size_t axis, BusTime now) const;

 private:
  struct Read {
    std::array<double, kAxesPerNode> amperes{}, celsius{};
    std::array<std::optional<BusTime>, kAxesPerNode> when{}, warm_when{};
  };
  void take(BusTime now, Read& read, const SdoResult& answer);

  std::vector<Read> read_;
  std::size_t next_ = 0;       ///< node and axis to ask next: 2 * node + axis
  std::size_t next_warm_ = 0;  ///< of the temperature likewise
  std::size_t turns_ = 0;
  BusTime until_{0}, due_{0};
};

}  // namespace kinebus
