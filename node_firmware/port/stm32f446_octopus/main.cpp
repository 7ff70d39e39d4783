// The Octopus' firmware: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/node_pass.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32f4/can_port.hpp"
#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f4/handlers.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f4/reset_port.hpp"
#include "node_firmware/port/stm32f4/supply_port.hpp"
#include "node_firmware/port/stm32f4/switch_port.hpp"
#include "node_firmware/port/stm32f4/watchdog_port.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/port/stm32f446_octopus/loader_port.hpp"
#include "node_firmware/port/stm32f446_octopus/step_stage.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

using Switches = SwitchPort<octopus::kSwitchPins>;
constinit CanPort can_port;
constinit Switches switch_port;
constinit MotionPlanExchange motion_plan;
constinit StepMotors<StepPort> motors{motion_plan};
constinit ParameterFlash<octopus::kParameterSectors, octopus::kParameterPageBytes> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit WatchdogPort dog;
constinit WatchdogKeeper keeper;
constinit std::optional<NodeProgram<CanPort, Switches, LocalTimer>> program;

static_assert(shares_slots(kNodeTable, BoardObjects<Stm32f446OctopusBoard>::kTable));

constexpr NodeIdentity identity() {
  constexpr const BoardFacts& kFacts = Stm32f446OctopusBoard::kFacts;
  return {.product_code = kFacts.product_code, .revision = kFacts.revision};
}

}  // namespace

extern "C" {
void isr_control() {
  motors.on_control();
}
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
  const bool alone = end_loader();
  // On another chip the same pins may be wired to anything: nothing but the bus is touched there.
  const bool own_chip = device_id() == kDeviceF446;
  if (own_chip)
    configure_pins<octopus::kPins>();
  else
    configure_pins<octopus::kBusPins>();
  if (!alone || !start_clocks<octopus::kCrystalHz>()) power_off_and_reset(fault_reason::kNoClock, nullptr);
  system_control().VTOR = octopus::kProgramAddress;
  start_local_time();
  can_port.start();
  const auto stored = parameters.load();
  static_cast<void>(parameters.prepare(kLargestParameterImage));
  NodeOptions options{.identity = identity(),
                      .node_id = take_inherited_node_id(handover_ram),
                      .program_crc = kImageHeader.crc,
                      .reset = take_reset_report(),
                      .table = &BoardObjects<Stm32f446OctopusBoard>::kTable};
  options.identity.serial = serial_number(unique_id());
  program.emplace(options, stored, can_port, switch_port, motion_plan);
  Node& node = program->node();
  const bool good = own_chip && watch_supply();
  if (own_chip) switch_port.start(local_counts());
  enable_interrupts();
  if (good) motors.start();
  dog.start();
  for (;;) {
    pass(*program, motors, good, parameters, dog);
    // There is no boot loader of ours to give way to: the program begins anew, under its id.
    if (node.program_stop_requested() && can_port.queue().idle()) {
      handover_ram = Handover{.node_id = node.node_id()};
      reset_processor();
    }
    // Without its own chip there is no control interrupt: only the bus is served.
    keeper.serve(dog, program->now(), node, good ? motors.ticks() : local_counts());
    if (good) wait_for_interrupt();  // 64 us at most
  }
}

// For the emulator, which looks into the image as a debugger does; the program itself never calls them.
extern "C" {
/// Path ticks at a count of local time.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_path_time(std::uint32_t counts) {
  return program ? program->path_time(counts).count() : 0;
}
/// What the plan asks of a motor now: counts with 32 fractional bits.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_position(int axis) {
  return motion_plan.current().at(axis, local_counts()).position;
}
/// Steps up to the end of the frame that was computed last.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_steps(int axis) {
  return motors.steps(axis);
}
}
