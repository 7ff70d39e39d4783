// The EBB's boot loader: starts the node's program when it is good and nobody asked for anything else, or
// serves a download over CAN.

#include <optional>

#include "node_firmware/board/boot_program.hpp"
#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/can_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"
#include "node_firmware/port/stm32g0b1_ebb/program_flash.hpp"
#include "node_firmware/port/stm32g0b1_ebb/reset_port.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::g0b1;

struct LocalTimer {
  static PlanCounts counts() { return local_counts(); }
};

constexpr ImageTarget kTarget = image_target(Stm32g0b1EbbBoard::kFacts);

constinit CanPort can_port;
constinit CanTap tap{can_port, 0};
constinit ProgramSectors<ebb::kProgramPages> program_flash;
constinit ParameterFlash<ebb::kParameterPages> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit ParameterImage parameter_image;
constinit std::optional<BootProgram<CanTap, LocalTimer>> boot;

// Nothing has been touched since reset: the program finds the processor as after one.
[[noreturn]] void jump_to_program() {
  constexpr std::uint32_t kVectors = ebb::kProgramPages.address();
  system_control().VTOR = kVectors;
  barrier();
  const std::uint32_t stack = peripheral<Reg>(kVectors);
  const std::uint32_t entry = peripheral<Reg>(kVectors + 4);
  asm volatile("msr msp, %0\n bx %1" ::"r"(stack), "r"(entry) : "memory");
  __builtin_unreachable();
}

// On another chip the same pins may be wired to anything: nothing but the bus is touched there.
void configure() {
  enable_clock(rcc().APBENR1, Rcc::kDebug);
  if (device_id() == kDeviceG0B1)
    configure_pins<ebb::kPins>();
  else
    configure_pins<ebb::kBusPins>();
}

// Until an interrupt; one that comes after the last look is pending, and ends the wait at once.
void rest() {
  disable_interrupts();
  if (tap.front() == nullptr && tap.queue().idle()) wait_for_interrupt();
  enable_interrupts();
}

}  // namespace

extern "C" {
void isr_tick() {}
void isr_can_receive() {
  can_port.on_receive(local_counts());
}
void isr_can_state() {
  can_port.on_state();
}
}

int main() {
  if (start_program(handover_ram, check_image(program_flash.bytes(), kTarget))) jump_to_program();
  system_control().VTOR = ebb::kBootPages.address();
  configure();
  if (!start_clocks()) power_off_and_reset(fault_reason::kNoClock, nullptr);
  start_local_time();
  can_port.start();
  start_tick();
  enable_interrupts();
  const LssIdentity identity{kVendorId, kTarget.product_code, kTarget.revision, serial_number(unique_id())};
  boot.emplace(kTarget, identity, boot_node_id(handover_ram, parameter_image, parameters.load()),
               program_flash, tap);
  for (;;) {
    if (boot->pass()) {
      handover_ram = Handover{.node_id = boot->node_id()};
      reset_processor();
    }
    rest();
  }
}
