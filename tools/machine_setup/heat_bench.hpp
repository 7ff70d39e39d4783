#pragma once
// One heat node without a gateway: told what the machine file says of it, its heaters warmed a little, its
// fans run.

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "gateway/description/machine_description.hpp"
#include "protocol/canopen/heat_objects.hpp"
#include "tools/card/node_sdo.hpp"

namespace kinebus {

class HeatBench {
 public:
  struct Limits {
    double rise_k = 5;            ///< wanted
    double most_rise_k = 15;      ///< of any sensor: the test ends
    double warmest_begin_c = 45;  ///< hotter, it has to cool down first
    LocalTime time = std::chrono::seconds{180};
  };
  struct Rise {
    bool reached = false;
    std::string trouble;                        ///< why it ended before; empty: time was up
    std::array<double, kHeatSensors> rise_k{};  ///< of each sensor
    /// Which sensor rose most, 0 ..; -1: none by more than a third of what was wanted.
    int warmest = -1;
  };

  HeatBench(BusAccess bus, std::uint8_t node) : node_(std::move(bus), node, kHeatTable) {}

  /// All may throw CardError. What the file says of its heaters, sensors and fans; `fans_free`: no fan
  /// belongs to a hot end meanwhile, so that each runs when it is told to.
  void describe(const MachineDescription& machine, bool fans_free);
  /// 0.1 C resolution; nullopt: its sensor does not measure.
  std::optional<double> temperature_c(int sensor);
  /// Why it does not; empty: it does.
  std::string sensor_trouble(int sensor, const SensorWiring& wiring);
  /// Heats one (0 ..) until its sensor has risen, then lets go. `stop`: asked all the time.
  Rise warm(int heater, const Limits& limits, const std::function<bool()>& stop);
  /// Full speed, or stands.
  void run_fan(int fan, bool on);

 private:
  std::int64_t read(ObjectAddress first, int n);
  void write(ObjectAddress first, int n, std::int64_t value);

  NodeSdo node_;
};

}  // namespace kinebus
