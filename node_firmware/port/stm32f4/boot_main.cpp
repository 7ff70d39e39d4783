// The boot loader's program: starts the node's program when it is good and nobody asked for anything else, or
// serves a download over CAN.

#include <optional>

#include "node_firmware/board/boot_program.hpp"
#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/board/status_led.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32/outputs_off.hpp"
#include "node_firmware/port/stm32f4/boot_board.hpp"
#include "node_firmware/port/stm32f4/can_port.hpp"
#include "node_firmware/port/stm32f4/clocks.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/no_clock.hpp"
#include "node_firmware/port/stm32f4/registers.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

/// The chip's own boot loader (DFU over PA11, PA12, and others): its vectors.
constexpr std::uint32_t kSystemBootAddress = 0x1FFF'0000;

constinit CanPort can_port;
constinit ParameterImage parameter_image;
constinit std::optional<BootProgram<CanPort, LocalTimer>> boot;

[[noreturn]] void jump(std::uint32_t vectors) {
  barrier();
  const std::uint32_t stack = peripheral<Reg>(vectors);
  const std::uint32_t entry = peripheral<Reg>(vectors + 4);
  asm volatile("msr msp, %0\n bx %1" ::"r"(stack), "r"(entry) : "memory");
  __builtin_unreachable();
}

// Nothing has been touched since reset: the program finds the processor as after one.
[[noreturn]] void jump_to_program() {
  keep_records();
  system_control().VTOR = boot_board::kProgram;
  jump(boot_board::kProgram);
}

// As BOOT0 would: its flash at address 0, and the board as it must be for that.
[[noreturn]] void jump_to_system_boot() {
  keep_records();
  enable_clock(rcc().APB2ENR, Rcc::kSysConfig);
  boot_board::select_system_boot();
  sysconfig().MEMRMP = SysConfig::kSystemFlashAtZero;
  enable_interrupts();
  jump(kSystemBootAddress);
}

// What is due by time is looked at every millisecond.
void start_tick() {
  sys_tick().LOAD = kCoreHz / 1000 - 1;
  sys_tick().VAL = 0;
  sys_tick().CTRL = SysTick::kEnable | SysTick::kInterrupt | SysTick::kCoreClock;
}

// Until an interrupt; one that comes after the last look is pending, and ends the wait at once.
void rest() {
  disable_interrupts();
  if (can_port.front() == nullptr && can_port.queue().idle()) wait_for_interrupt();
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
  boot_board::begin();
  ProgramFlash& program_flash = boot_board::program_flash();
  if (start_system_boot(handover_ram)) jump_to_system_boot();
  if (start_program(handover_ram, check_image(program_flash.bytes(), boot_board::kTarget))) jump_to_program();
  system_control().VTOR = boot_board::kVectors;
  boot_board::configure_pins();
  if (const std::uint16_t reason = boot_board::start_clocks(); !clocks_run(reason))
    tell_no_clock(reason, boot_board::show);
  start_local_time();
  can_port.start();
  start_tick();
  enable_interrupts();
  const ImageTarget& target = boot_board::kTarget;
  const LssIdentity identity{kVendorId, target.product_code, target.revision, serial_number(unique_id())};
  boot.emplace(target, identity, boot_node_id(handover_ram, parameter_image, boot_board::stored_parameters()),
               program_flash, can_port);
  for (;;) {
    if (boot->pass()) {
      handover_ram = Handover{.node_id = boot->node_id()};
      keep_records();
      reset_processor();
    }
    // One flash a second: the boot loader.
    const LedState state{.on_bus = can_port.joined(), .node_id = 1, .nmt = NmtState::kStopped};
    boot_board::show(led_on(state, local_counts() / kLedStep));
    rest();
  }
}
