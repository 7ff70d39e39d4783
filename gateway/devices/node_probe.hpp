#pragma once
// A probe on a switch input of a node with axes: TPDO1 tells its inputs whenever one changes.

#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/device.hpp"

namespace kinebus {

class NodeProbe : public ContactProbe {
 public:
  explicit NodeProbe(DevicePlace place) : place_(place) {}
  bool on_frame(BusTime now, const CanFrame& frame) override;
  bool touches() const override { return touches_; }

 private:
  DevicePlace place_;
  bool touches_ = false;
};

std::unique_ptr<ContactProbe> node_probe(const ProbeDescription& probe, const MachineDescription& machine);

}  // namespace kinebus
