// The boot loader's program: starts the node's program when it is good and nobody asked for anything else, or
// serves a download over CAN.

#include <optional>

#include "node_firmware/board/boot_program.hpp"
#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/board/status_led.hpp"
#include "node_firmware/core/reset_report.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32f4/can_port.hpp"
#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "node_firmware/port/stm32f405/option_port.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

class ProgramSectors final : public ProgramFlash {
 public:
  std::span<const std::uint8_t> bytes() const override {
    return flash::bytes(board::kProgramAddress, board::kProgramBytes);
  }
  // The header goes first: what a cut leaves of the rest is then no program.
  bool erase() override {
    for (const FlashSector& sector : board::kProgramSectors)
      if (!flash::erase(sector.number)) return false;
    return true;
  }
  bool program(std::uint32_t offset, std::uint32_t word) override {
    return flash::program(board::kProgramAddress + offset, word);
  }
  std::uint8_t unprotected() const override { return options::missing(); }
  bool protect() override { return options::protect(); }
};

constinit ProgramSectors program_sectors;
constinit CanPort can_port;
constinit ParameterFlash<board::kParameterSectors, board::kParameterPageBytes> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit ParameterImage parameter_image;
constinit std::optional<BootProgram<CanPort, LocalTimer>> boot;

constexpr ImageTarget kBoard = image_target(Stm32f405Board::kFacts);

[[noreturn]] void jump(std::uint32_t vectors) {
  barrier();
  const std::uint32_t stack = peripheral<Reg>(vectors);
  const std::uint32_t entry = peripheral<Reg>(vectors + 4);
  asm volatile("msr msp, %0\n bx %1" ::"r"(stack), "r"(entry) : "memory");
  __builtin_unreachable();
}

// Nothing has been touched since reset: the program finds the processor as after one.
[[noreturn]] void jump_to_program() {
  system_control().VTOR = board::kProgramAddress;
  jump(board::kProgramAddress);
}

// As BOOT0 would: its flash at address 0, the connector led to its USB pins, no gate driver enabled.
[[noreturn]] void jump_to_system_boot() {
  enable_clock(rcc().AHB1ENR, Rcc::gpio_clock(Port::C));
  enable_clock(rcc().APB2ENR, Rcc::kSysConfig);
  static_assert(board::kSystemBoot.port == board::Port::C);
  Gpio& g = gpio(static_cast<unsigned>(board::kSystemBoot.port));
  write(board::kSystemBoot, true);
  g.MODER = g.MODER | std::uint32_t{1} << (2 * board::kSystemBoot.number);
  sysconfig().MEMRMP = SysConfig::kSystemFlashAtZero;
  jump(board::kSystemBootAddress);
}

// What is due by time is looked at every millisecond.
void start_tick() {
  sys_tick().LOAD = board::kCoreHz / 1000 - 1;
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
  if (start_system_boot(handover_ram)) jump_to_system_boot();
  if (start_program(handover_ram, check_image(program_sectors.bytes(), kBoard))) jump_to_program();
  configure_pins<board::kPins>();
  if (!start_clocks<board::kCrystalHz>()) power_off_and_reset(fault_reason::kNoClock, nullptr);
  start_local_time();
  can_port.start();
  start_tick();
  const LssIdentity identity{kVendorId, kBoard.product_code, kBoard.revision, serial_number(unique_id())};
  boot.emplace(kBoard, identity, boot_node_id(handover_ram, parameter_image, parameters.load()),
               program_sectors, can_port);
  for (;;) {
    if (boot->pass()) {
      handover_ram = Handover{.node_id = boot->node_id()};
      reset_processor();
    }
    // One flash a second: the boot loader.
    const LedState state{.on_bus = can_port.joined(), .node_id = 1, .nmt = NmtState::kStopped};
    write(board::kStatusLed, !led_on(state, local_counts() / kLedStep));
    rest();
  }
}
