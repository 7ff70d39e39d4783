// The node's firmware: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/port/stm32f405/clock_tree.hpp"
#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/node_program.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

constinit CanPort can_port;
constinit SwitchPort switch_port;
constinit MotionPlanExchange motion_plan;
constinit std::optional<NodeProgram> program;

}  // namespace

extern "C" {
void isr_can_receive() {
  can_port.on_receive(local_counts());
}
void isr_can_state() {
  can_port.on_state();
}
void isr_switches() {
  switch_port.on_edges(local_counts());
}
void isr_can_transmit() {
  // Wakes the main loop, which serves the mailboxes; until then no further interrupt.
  can1().IER = can1().IER & ~Can::kOnMailboxEmpty;
}
}

int main() {
  configure_pins();
  if (!start_clocks()) isr_fault();
  system_control().VTOR = board::kProgramAddress;
  start_local_time();
  if (!can_port.start()) isr_fault();
  program.emplace(NodeOptions{.identity = {.serial = serial_number()}}, can_port, switch_port, motion_plan);
  switch_port.start(local_counts());
  enable_interrupts();
  for (;;) {
    program->pass();
    wait_for_interrupt();
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
