#pragma once
// A probe on a switch input of a node with axes. TPDO1 tells at once that it touches, touch probe 1 of the
// node's first axis (60B8h ff.) when it did.

#include <memory>

#include "gateway/description/machine_description.hpp"
#include "gateway/devices/device.hpp"

namespace kinebus {

class NodeProbe : public ContactProbe {
 public:
  explicit NodeProbe(DevicePlace place) : place_(place) {}
  bool on_frame(BusTime now, const CanFrame& frame) override;
  bool touches() const override { return touches_; }
  void arm(bool away) override;
  void ask() override;
  Watch watch() const override { return watch_; }
  BusTime contact() const override { return contact_; }
  std::optional<ProbeRequest> next_request() override;
  void on_reply(BusTime now, std::optional<std::int64_t> value) override;

 private:
  enum class Request : std::uint8_t { kNone, kFunction, kLevels, kStatus, kTime };
  void take_inputs(std::int64_t inputs) { touches_ = ((inputs >> (place_.channel - 1)) & 1) != 0; }

  DevicePlace place_;
  bool touches_ = false, away_ = false;
  bool last_ = false;  ///< what the status says now is final
  Watch watch_ = Watch::kOff;
  Request next_ = Request::kNone, asked_ = Request::kNone;
  BusTime contact_{0};
};

std::unique_ptr<ContactProbe> node_probe(const ProbeDescription& probe, const MachineDescription& machine);

}  // namespace kinebus
