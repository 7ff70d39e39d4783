// What of the boot loader is the dual-stepper board's.

#include "node_firmware/port/stm32f4/boot_board.hpp"

#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f4/program_flash.hpp"
#include "node_firmware/port/stm32f405/board.hpp"
#include "protocol/canopen/boards/stm32f405.hpp"

namespace kinebus::stm32::boot_board {
namespace {

constexpr std::uint32_t kBootSectors =
    FlashInterface::not_write_protected(0) | FlashInterface::not_write_protected(1);
static_assert(board::kBootBytes == 2 * 0x4000, "sectors 0 and 1, of 16 KiB");

constinit ProgramSectors<board::kProgramSectors, board::kProgramBytes, kBootSectors> program_sectors;
constinit ParameterFlash<board::kParameterSectors, board::kParameterPageBytes> parameter_flash;
constinit PageStore parameters{parameter_flash};

}  // namespace

extern constexpr ImageTarget kTarget = image_target(Stm32f405Board::kFacts);
extern constexpr std::uint32_t kVectors = board::kBootAddress, kProgram = board::kProgramAddress;

// The chip comes here from its reset, and RAM keeps its content.
void begin() {}

// Another board may be wired to anything.
void configure_pins() {
  if (device_id() == kDeviceF405 && board_record::is_own(record::memory(), Stm32f405Board::kFacts.hardware))
    stm32::configure_pins<board::kPins>();
  else
    stm32::configure_pins<board::kTalkingPins>();
}
std::uint16_t start_clocks() {
  return stm32::start_clocks<board::kCrystals>();
}
ProgramFlash& program_flash() {
  return program_sectors;
}
std::span<const std::uint8_t> stored_parameters() {
  return parameters.load();
}
void show(bool lit) {
  write(board::kStatusLed, !lit);
}

// The connector is led to its USB pins, and no gate driver enabled.
void select_system_boot() {
  enable_clock(rcc().AHB1ENR, Rcc::gpio_clock(board::kSystemBoot.port));
  Gpio& g = gpio(static_cast<unsigned>(board::kSystemBoot.port));
  write(board::kSystemBoot, true);
  g.MODER = g.MODER | std::uint32_t{1} << (2 * board::kSystemBoot.number);
}

}  // namespace kinebus::stm32::boot_board
