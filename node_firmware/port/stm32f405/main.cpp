// The node's firmware: builds the parts, connects them, loops.

#include <optional>
#include <utility>

#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/node_pass.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/board/status_led.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32f4/can_port.hpp"
#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/no_clock.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f4/record_port.hpp"
#include "node_firmware/port/stm32f4/reset_port.hpp"
#include "node_firmware/port/stm32f4/supply_port.hpp"
#include "node_firmware/port/stm32f4/switch_port.hpp"
#include "node_firmware/port/stm32f4/watchdog_port.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/power_stage.hpp"
#include "node_firmware/port/stm32f405/scale_port.hpp"
#include "node_firmware/port/stm32f405/usart_port.hpp"
#include "node_firmware/port/stm32f405/usb_port.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

constinit CanPort can_port;
using Switches = SwitchPort<board::kSwitchPins>;
constinit Switches switch_port;
constinit MotionPlanExchange motion_plan;
constinit BridgeMotors<PowerStage> motors{motion_plan};
constinit ParameterFlash<board::kParameterSectors, board::kParameterPageBytes> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit WatchdogPort dog;
constinit WatchdogKeeper keeper;
constinit UsartPort usart;
constinit ScalePort scales;
constinit UsbPort usb_port;
constinit std::optional<NodeProgram<CanPort, Switches, LocalTimer>> program;

// Asked for by 1F51h, when the answer is on the bus, or by a console. Motors have no power then (Node and
// Console refuse otherwise).
void give_way(const Node& node, std::uint32_t to) {
  handover_ram = Handover{.stay = to, .node_id = node.node_id()};
  reset_processor();
}

// Once a step of the pattern: the main loop has better things to do.
void show(const Node& node) {
  static std::uint32_t shown = 0;
  const std::uint32_t step = local_counts() / kLedStep;
  if (std::exchange(shown, step) == step) return;
  const auto faulty = [&](int axis) { return node.axis(axis).state() == cia402::State::kFault; };
  const LedState state{.on_bus = can_port.joined() && !can_port.bus_off(),
                       .fault = faulty(0) || faulty(1),
                       .node_id = node.node_id(),
                       .nmt = node.nmt_state()};
  write(board::kStatusLed, !led_on(state, step));
}

}  // namespace

extern "C" {
void isr_control() {
  motors.on_control();
}
void isr_break_a() {
  motors.on_break(0);
}
void isr_break_b() {
  motors.on_break(1);
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
  // On another chip, or a board that says that it is another, nothing is driven.
  const bool own_board =
      device_id() == kDeviceF405 && board_record::is_own(record::memory(), Stm32f405Board::kFacts.hardware);
  if (own_board)
    configure_pins<board::kPins>();
  else
    configure_pins<board::kTalkingPins>();
  const std::uint16_t clock = start_clocks<board::kCrystals>();
  if (!clocks_run(clock)) tell_no_clock(clock, [](bool lit) { write(board::kStatusLed, !lit); });
  system_control().VTOR = board::kProgramAddress;
  start_local_time();
  can_port.start();
  const auto stored = parameters.load();
  static_cast<void>(parameters.prepare(kLargestParameterImage));
  const std::uint32_t serial = serial_number(unique_id());
  program.emplace(
      NodeOptions{.identity = {.serial = serial},
                  .node_id = take_inherited_node_id(handover_ram),
                  .program_crc = kImageHeader.crc,
                  .reset = take_reset_report(clock),
                  .scale_inputs = {ScaleInput::kQuadratureOrEncoder + ScaleInput::kAbsoluteOrEncoder,
                                   ScaleInput::kQuadrature + ScaleInput::kAbsoluteOrEncoder},
                  .may_fit_scale = &Node::may_fit_scale},
      stored, can_port, switch_port, motion_plan);
  Node& node = program->node();
  if (own_board) switch_port.start(local_counts());
  enable_interrupts();
  const bool motors_good = own_board && watch_supply() && motors.start();
  const std::uint16_t refusal = !own_board     ? emcy::kOtherBoard
                                : !motors_good ? emcy::kControlHardware
                                               : emcy::kNoError;
  usart.start();
  if (own_board) usb_port.start();
  dog.start();
  for (;;) {
    scales.serve(node);
    pass(
        *program, motors, refusal, [](std::size_t, auto image) { return parameters.save(image); }, dog);
    const Console::Subject subject{.node = node,
                                   .motors = motors.supervision(),
                                   .cycles = motors.cycles(),
                                   .control_interrupts = motors.ticks(),
                                   .can = can_port.events(),
                                   .off_the_bus = can_port.bus_off(),
                                   .no_bus = !can_port.joined(),
                                   .own_board = own_board,
                                   .serial = serial,
                                   .image_bytes = kImageHeader.length};
    usart.serve(subject);
    usb_port.serve(subject);
    show(node);
    if (program->stop_requested() && can_port.queue().idle()) give_way(node, Handover::kBootLoader);
    if (usart.console().system_boot_requested() || usb_port.console().system_boot_requested())
      give_way(node, Handover::kSystemBoot);
    // So long without a reset: this program is good.
    if (program->now() > kProgramProved) handover_ram.starts = 0;
    // Without a power stage that measures there is no control interrupt: only the bus is served.
    keeper.serve(dog, program->now(), node, motors_good ? motors.ticks() : local_counts());
    if (motors_good) wait_for_interrupt();  // 50 us at most
  }
}

// For a debugger, and for the emulator that looks into the image as one does (gdb: call debug_path_time(n));
// the program itself never calls them.
extern "C" {
/// Path ticks at a count of local time.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_path_time(std::uint32_t counts) {
  return program ? program->path_time(counts).count() : 0;
}
/// What the control interrupt would take as command now: counts with 32 fractional bits.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_position(int axis) {
  return motion_plan.current().at(axis, local_counts()).position;
}
}
