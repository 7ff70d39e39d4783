// The boot loader's program: starts the node's program when it is good and nobody asked for anything else, or
// serves a download over CAN.

#include <optional>

#include "node_firmware/boot/boot_loader.hpp"
#include "node_firmware/core/parameter_image.hpp"
#include "node_firmware/port/stm32f405/can_port.hpp"
#include "node_firmware/port/stm32f405/clock_tree.hpp"
#include "node_firmware/port/stm32f405/flash_port.hpp"
#include "node_firmware/port/stm32f405/handlers.hpp"
#include "node_firmware/port/stm32f405/handover_port.hpp"
#include "node_firmware/port/stm32f405/identity.hpp"
#include "node_firmware/port/stm32f405/local_time.hpp"
#include "node_firmware/port/stm32f405/pins.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

class ProgramSector final : public ProgramFlash {
 public:
  std::span<const std::uint8_t> bytes() const override {
    return flash::bytes(board::kProgramAddress, board::kProgramBytes);
  }
  bool erase() override { return flash::erase(board::kProgramSector); }
  bool program(std::uint32_t offset, std::uint32_t word) override {
    return flash::program(board::kProgramAddress + offset, word);
  }
};

constinit ProgramSector program_sector;
constinit CanPort can_port;
constinit ParameterFlash parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit ParameterImage parameter_image;
constinit std::optional<BootLoader> boot_loader;

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
  rcc().AHB1ENR = rcc().AHB1ENR | Rcc::kGpioC;
  rcc().APB2ENR = rcc().APB2ENR | Rcc::kSysConfig;
  static_assert(board::kSystemBoot.port == board::Port::C);
  Gpio& g = gpio(static_cast<unsigned>(board::kSystemBoot.port));
  write(board::kSystemBoot, true);
  g.MODER = g.MODER | std::uint32_t{1} << (2 * board::kSystemBoot.number);
  sysconfig().MEMRMP = SysConfig::kSystemFlashAtZero;
  jump(board::kSystemBootAddress);
}

std::uint8_t node_id() {
  if (handover_ram.node_id >= 1 && handover_ram.node_id <= 127)
    return static_cast<std::uint8_t>(handover_ram.node_id);
  return parameter_image.adopt(parameters.load()) == ParameterImage::Load::kGood ? parameter_image.node_id()
                                                                                 : std::uint8_t{0};
}

void hear(std::uint8_t id) {
  std::array<CanPort::Accept, 3> filters{{{0x000}, {0x7E5}, {static_cast<std::uint16_t>(0x600 + id)}}};
  can_port.accept(std::span(filters).first(id == 0 ? 2 : 3));
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
  if (start_program(handover_ram, check_image(program_sector.bytes()))) jump_to_program();
  configure_pins();
  if (!start_clocks()) isr_fault();
  start_local_time();
  if (!can_port.start()) isr_fault();
  start_tick();
  LocalClock clock;
  const LssIdentity identity{kVendorId, kProductCode, kRevisionNumber, serial_number()};
  boot_loader.emplace(identity, node_id(), program_sector, clock.now());
  std::uint8_t heard = boot_loader->node_id();
  hear(heard);
  for (;;) {
    boot_loader->on_time(clock.now());
    while (const CanPort::Received* received = can_port.front()) {
      boot_loader->on_frame(clock.now(), received->frame());
      can_port.drop();
    }
    can_port.serve_mailboxes();
    while (can_port.queue().has_room()) {
      const auto frame = boot_loader->next_frame();
      if (!frame) break;
      can_port.queue().push(*frame);
      can_port.serve_mailboxes();
    }
    if (heard != boot_loader->node_id()) hear(heard = boot_loader->node_id());
    if (boot_loader->start_requested() && can_port.queue().idle()) {
      handover_ram = Handover{.node_id = boot_loader->node_id()};
      reset_processor();
    }
    rest();
  }
}
