#pragma once
// An input of a job (M66) on a switch input of a node with axes: TPDO1 tells at once when it changes.

#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/device.hpp"

namespace kinebus {

class NodeInput : public Input {
 public:
  explicit NodeInput(DevicePlace place) : place_(place) {}
  bool on_frame(BusTime now, const CanFrame& frame) override;
  /// Until its node tells again, nobody knows.
  void on_bring_up(BusTime, bool done) override {
    if (!done) level_ = InputLevel::kUnknown;
  }
  InputLevel level() const override { return level_; }
  Changes changes() const override { return changes_; }

 private:
  DevicePlace place_;
  InputLevel level_ = InputLevel::kUnknown;
  Changes changes_;
};

std::unique_ptr<Input> node_input(const InputDescription& input, const MachineDescription& machine);

}  // namespace kinebus
