#include "node_firmware/port/stm32f446_octopus/bridge_port.hpp"

namespace kinebus::stm32 {
namespace {

// Until the core has become a device (25 ms).
constexpr std::uint32_t kSettle = kLocalHz / 20;

}  // namespace

void BridgePort::start() {
  good_ = otg_.start();
  since_ = local_counts();
}

void BridgePort::serve() {
  if (!good_ || otg_.attached() || local_counts() - since_ < kSettle) return;
  otg_.attach();
  otg_.interrupt_on_events();
  enable_interrupt(Irq::kOtgFs, 14);
}

void BridgePort::on_event() {
  otg_.serve();
  device_.frames_to_bus();
}

}  // namespace kinebus::stm32
