// What of the boot loader is the Octopus'.

#include "node_firmware/port/stm32f4/boot_board.hpp"

#include "node_firmware/board/node_images.hpp"
#include "node_firmware/port/stm32f4/backup_port.hpp"
#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f4/program_flash.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/port/stm32f446_octopus/loader_port.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace kinebus::stm32::boot_board {
namespace {

constexpr const BoardFacts& kFacts = Stm32f446OctopusBoard::kFacts;

// The maker's loader writes over sectors 2 and 3 when it finds a file on its card: they stay open.
constinit ProgramSectors<octopus::kProgramSectors, octopus::kProgramBytes, 0> program_sectors;
constinit ParameterFlash<octopus::kParameterSectors, octopus::kParameterPageBytes> parameter_flash;
constinit PageStore store{parameter_flash};
constinit NodeImages<kFacts.consecutive_ids> images{store};

}  // namespace

extern constexpr ImageTarget kTarget = image_target(kFacts);
extern constexpr std::uint32_t kVectors = octopus::kBootAddress, kProgram = octopus::kProgramAddress;

void begin() {
  if (!end_loader()) reset_processor();
  backup::load();
}
// On another chip or board the same pins may be wired to anything: nothing but the bus is touched there.
void configure_pins() {
  if (device_id() == kDeviceF446 && board_record::is_own(record::memory(), kFacts.hardware))
    stm32::configure_pins<octopus::kPins>();
  else
    stm32::configure_pins<octopus::kBusPins>();
}
std::uint16_t start_clocks() {
  return stm32::start_clocks<octopus::kCrystals>();
}
ProgramFlash& program_flash() {
  return program_sectors;
}
std::span<const std::uint8_t> stored_parameters() {
  return images.load()[0];
}
void show(bool) {}  // the board has no LED of the chip's
void select_system_boot() {}

}  // namespace kinebus::stm32::boot_board
