// The EBB as a heat node: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/node_program.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/board/upkeep.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/can_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/flash_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/heat_stage.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"
#include "node_firmware/port/stm32g0b1_ebb/reset_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/switch_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/watchdog_port.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::g0b1;

struct LocalTimer {
  static PlanCounts counts() { return local_counts(); }
};

constinit CanPort can_port;
constinit CanTap tap{can_port, 0};
constinit SwitchPort switch_port;
constinit ParameterFlash<ebb::kParameterPages> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit WatchdogPort dog;
constinit WatchdogKeeper keeper;
constinit std::optional<NodeProgram<CanTap, SwitchPort, LocalTimer, 0, BoardHeat<HeatPort>>> program;

}  // namespace

extern "C" {
void isr_tick() {}
void isr_can_receive() {
  can_port.on_receive(local_counts());
}
void isr_can_state() {
  can_port.on_state();
}
void isr_switches() {
  switch_port.on_edges(local_counts());
}
}

int main() {
  enable_clock(rcc().APBENR1, Rcc::kDebug);
  // On another chip the same pins may be wired to anything: nothing but the bus is touched there.
  const bool own_chip = device_id() == kDeviceG0B1;
  if (own_chip) {
    configure_pins<ebb::kPins>();
    configure_pins<ebb::kHeatPins>();
  } else {
    configure_pins<ebb::kBusPins>();
  }
  if (!start_clocks()) power_off_and_reset(fault_reason::kNoClock, nullptr);
  system_control().VTOR = ebb::kProgramPages.address();
  start_local_time();
  can_port.start();
  const auto stored = parameters.load();
  static_cast<void>(parameters.prepare(kLargestParameterImage));
  static_cast<void>(take_reset_report());
  program.emplace(tap, switch_port);
  auto& heat = program->heat();
  if (own_chip) {
    switch_port.start(local_counts());
    static_cast<void>(heat.driver().start());  // where it does not, no sensor is good and nothing heats
  }
  heat.begin({.node_id = take_inherited_node_id(handover_ram),
              .serial = serial_number(unique_id()),
              .program_crc = kImageHeader.crc},
             program->now(), stored);
  start_tick();
  enable_interrupts();
  dog.start();
  for (;;) {
    program->pass();
    heat.store(dog,
               [](auto image) { return parameters.save(std::array{std::span<const std::uint8_t>(image)}); });
    // Asked for by 1F51h, when the answer is on the bus. Nothing heats then (the node refuses otherwise).
    if (program->stop_requested() && can_port.queue().idle()) {
      handover_ram = Handover{.stay = Handover::kBootLoader, .node_id = heat.node_id()};
      reset_processor();
    }
    if (program->now() > kProgramProved) handover_ram.starts = 0;
    keeper.serve(dog, program->now(), *program, local_counts());
    wait_for_interrupt();  // 1 ms at most
  }
}
