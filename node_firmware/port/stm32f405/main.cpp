// The node's firmware: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/port/stm32f405/clock_tree.hpp"
#include "node_firmware/port/stm32f405/flash_port.hpp"
#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/handover_port.hpp"
#include "node_firmware/port/stm32f405/identity.hpp"
#include "node_firmware/port/stm32f405/motor_port.hpp"
#include "node_firmware/port/stm32f405/node_program.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"
#include "node_firmware/port/stm32f405/usart_port.hpp"
#include "node_firmware/port/stm32f405/usb_port.hpp"
#include "node_firmware/port/stm32f405/watchdog_port.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

constinit CanPort can_port;
constinit SwitchPort switch_port;
constinit MotionPlanExchange motion_plan;
constinit MotorPort motors{motion_plan};
constinit ParameterFlash parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit WatchdogPort dog;
constinit UsartPort usart;
constinit UsbPort usb;
constinit std::optional<NodeProgram> program;

// An erase that a save needs is made now, while nothing moves.
constexpr std::size_t kLargestImage = 5000;
constexpr LocalTime kProved = std::chrono::seconds{5};

void store(Node& node) {
  const auto image = node.image_to_store();
  if (image.empty()) return;
  const bool erases = parameters.save_erases(image.size());
  if (erases) dog.allow_erase();
  node.on_image_stored(parameters.save(image));
  if (erases) dog.back_to_normal();
}

// The id under which the boot loader answered, which may have come by LSS and be stored nowhere; 0: as
// stored.
std::uint8_t inherited_node_id() {
  const std::uint32_t id = handover_ram.magic == Handover::kMagic ? handover_ram.node_id : 0;
  handover_ram.node_id = 0;
  return id <= 127 ? static_cast<std::uint8_t>(id) : std::uint8_t{0};
}

// Asked for by 1F51h, when the answer is on the bus, or by a console. Motors have no power then (Node and
// Console refuse otherwise).
void give_way(const Node& node, std::uint32_t to) {
  handover_ram = Handover{.stay = to, .node_id = node.node_id()};
  reset_processor();
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
  configure_pins();
  if (!start_clocks()) isr_fault();
  system_control().VTOR = board::kProgramAddress;
  start_local_time();
  if (!can_port.start()) isr_fault();
  const auto stored = parameters.load();
  static_cast<void>(parameters.prepare(kLargestImage));
  program.emplace(NodeOptions{.identity = {.serial = serial_number()},
                              .node_id = inherited_node_id(),
                              .program_crc = kImageHeader.crc},
                  stored, can_port, switch_port, motion_plan);
  Node& node = program->node();
  if (WatchdogPort::caused_reset()) node.count(NodeCounter::kWatchdogResets);
  rcc().CSR = rcc().CSR | Rcc::kClearResetFlags;
  switch_port.start(local_counts());
  enable_interrupts();
  const bool motors_good = motors.start();
  usart.start();
  usb.start();
  dog.start();
  for (;;) {
    program->pass();
    // A stop for a drive's sake is named from this very moment, and told before anything else is done.
    if (motors_good ? motors.serve(node, program->read_time()) : program->refuse_power()) {
      program->send();
      program->touch();
    }
    store(node);
    const Console::Subject subject{node, motors, can_port};
    usart.serve(subject);
    usb.serve(subject);
    if (node.program_stop_requested() && can_port.queue().idle()) give_way(node, Handover::kBootLoader);
    if (usart.console().system_boot_requested() || usb.console().system_boot_requested())
      give_way(node, Handover::kSystemBoot);
    // So long without a reset: this program is good.
    if (program->now() > kProved) handover_ram.starts = 0;
    // Without a power stage that measures there is no control interrupt: only the bus is served.
    dog.serve(program->now(), node, motors_good ? motors.ticks() : local_counts());
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
