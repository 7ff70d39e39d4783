// The Octopus' firmware: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/node_images.hpp"
#include "node_firmware/board/node_pass.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32/outputs_off.hpp"
#include "node_firmware/port/stm32f4/backup_port.hpp"
#include "node_firmware/port/stm32f4/bridged_can.hpp"
#include "node_firmware/port/stm32f4/clock_tree.hpp"
#include "node_firmware/port/stm32f4/flash_port.hpp"
#include "node_firmware/port/stm32f4/handover_port.hpp"
#include "node_firmware/port/stm32f4/local_time.hpp"
#include "node_firmware/port/stm32f4/pins.hpp"
#include "node_firmware/port/stm32f4/record_port.hpp"
#include "node_firmware/port/stm32f4/reset_port.hpp"
#include "node_firmware/port/stm32f4/supply_port.hpp"
#include "node_firmware/port/stm32f4/switch_port.hpp"
#include "node_firmware/port/stm32f4/watchdog_port.hpp"
#include "node_firmware/port/stm32f446_octopus/board.hpp"
#include "node_firmware/port/stm32f446_octopus/bridge_port.hpp"
#include "node_firmware/port/stm32f446_octopus/driver_wires.hpp"
#include "node_firmware/port/stm32f446_octopus/heat_stage.hpp"
#include "node_firmware/port/stm32f446_octopus/loader_port.hpp"
#include "node_firmware/port/stm32f446_octopus/step_stage.hpp"
#include "protocol/canopen/boards/stm32f446_octopus.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::stm32;

using Switches = SwitchPort<octopus::kSwitchPins>;
constexpr std::size_t kNodes = octopus::kNodes;
using Motors = StepMotors<StepPort, OctopusDrivers>;
// The axis pairs, and the heat node.
constexpr std::size_t kBoardIds = kNodes + 1;
static_assert(Motors::kNodes == kNodes && Stm32f446OctopusBoard::kFacts.consecutive_ids == kBoardIds);
using Heat = BoardHeat<HeatPort>;

constexpr GsUsbFacts kCanFacts{.clock_hz = kApb1Hz, .bit_rate = 1'000'000};
constinit GsUsbDevice gs_usb_device{kCanFacts};
constinit BridgedCan can_port{gs_usb_device};
constinit BridgePort usb_port{gs_usb_device, can_port};
constinit Switches switch_port;
constinit Motors::Plans plans;
constinit DriverWires driver_wires;
constinit OctopusDrivers drivers{driver_wires};
constinit Motors motors{plans, drivers};
constinit ParameterFlash<octopus::kParameterSectors, octopus::kParameterPageBytes> parameter_flash;
constinit PageStore store{parameter_flash};
constinit NodeImages<kBoardIds> images{store};
constinit WatchdogPort dog;
constinit WatchdogKeeper keeper;
constinit std::optional<NodeProgram<BridgedCan, Switches, LocalTimer, kNodes, Heat>> program;

static_assert(shares_slots(kNodeTable, BoardObjects<Stm32f446OctopusBoard>::kTable));

/// The first node has its id from LSS or from flash; the others have those that follow.
NodeOptions options_of(std::size_t number, std::uint8_t node_id) {
  constexpr const BoardFacts& kFacts = Stm32f446OctopusBoard::kFacts;
  return {.identity = {.product_code = kFacts.product_code,
                       .revision = kFacts.revision,
                       .serial = serial_number(unique_id()) + static_cast<std::uint32_t>(number)},
          .node_id = node_id,
          .program_crc = kImageHeader.crc,
          .table = &BoardObjects<Stm32f446OctopusBoard>::kTable,
          .id_from_board = number != 0,
          .consecutive_ids = kBoardIds};
}

void begin_node(std::size_t number, std::uint8_t first_id) {
  const auto id = static_cast<std::uint8_t>(first_id + number);
  const auto stored = images.load()[number];
  if (number == octopus::kHeatNode)
    program->heat().begin(
        {.node_id = id, .serial = options_of(number, id).identity.serial, .id_from_board = true},
        program->now(), stored);
  else
    program->begin(number, options_of(number, id), stored, plans[number], octopus::kInputPlaces[number]);
}
void end_node(std::size_t number) {
  number == octopus::kHeatNode ? program->heat().end() : program->end(number);
}

// While no motor has power: a carriage must not lose its node. One node a pass: each takes milliseconds.
void follow_first_id() {
  static std::uint8_t followed = 0;
  static std::size_t next = kBoardIds;
  const std::uint8_t first = program->node().node_id();
  if (!motors.dark()) return;
  if (first != followed) {
    followed = first;
    next = 1;
  }
  if (next == kBoardIds) return;
  first == 0 ? end_node(next) : begin_node(next, first);
  ++next;
}

// Flash is written while nothing of the board has power: the processor stands still then.
void serve_heat() {
  Heat& heat = program->heat();
  motors.set_other_power(heat.heats());
  heat.set_neighbours_powered(!motors.dark());
  if (motors.dark()) heat.store(dog, [](auto image) { return images.save(octopus::kHeatNode, image); });
}

}  // namespace

extern "C" {
void isr_control() {
  motors.on_control();
}
void isr_can_receive() {
  can_port.on_receive(local_counts());
}
void isr_can_transmit() {
  can_port.on_transmit(local_counts());
}
void isr_usb() {
  usb_port.on_event();
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
  backup::load();
  // On another chip, or a board that says that it is another, the same pins may be wired to anything: nothing
  // but the bus is touched there.
  const bool own_board = device_id() == kDeviceF446 &&
                         board_record::is_own(record::memory(), Stm32f446OctopusBoard::kFacts.hardware);
  if (own_board)
    configure_pins<octopus::kPins>();
  else
    configure_pins<octopus::kBusPins>();
  const std::uint16_t clock = alone ? start_clocks<octopus::kCrystals>() : fault_reason::kNoClock;
  if (!clocks_run(clock)) power_off_and_reset(clock, nullptr);
  system_control().VTOR = octopus::kProgramAddress;
  start_local_time();
  if (own_board) {
    DriverWires::start();
    settle_drivers<LocalTimer>(drivers);  // 0.25 s; less where they do not answer
  }
  can_port.start();
  const auto stored = images.load();
  static_cast<void>(store.prepare(kBoardIds * kLargestParameterImage));
  NodeOptions options = options_of(0, take_inherited_node_id(handover_ram));
  options.reset = take_reset_report(clock);
  keep_records();  // without what was taken
  program.emplace(options, stored[0], can_port, switch_port, plans[0], octopus::kInputPlaces[0]);
  const bool good = own_board && watch_supply();
  const std::uint16_t refusal = !own_board ? emcy::kOtherBoard
                                : !good    ? emcy::kControlHardware
                                           : emcy::kNoError;
  if (own_board) {
    switch_port.start(local_counts());
    usb_port.start();
  }
  enable_interrupts();
  if (good) {
    motors.start();
    program->align_plans(motors.plan_grid());
    program->heat().driver().start();
  }
  dog.start();
  for (;;) {
    can_port.serve();
    usb_port.serve();
    pass(
        *program, motors, refusal, [](std::size_t i, auto image) { return images.save(i, image); }, dog);
    follow_first_id();
    if (good) {
      drivers.serve(program->now());
      serve_heat();
    }
    // Asked for by 1F51h, when the answer is on the bus. Nothing has power then (the nodes refuse otherwise).
    if (program->stop_requested() && can_port.queue().idle()) {
      handover_ram = Handover{.stay = Handover::kBootLoader, .node_id = program->node().node_id()};
      keep_records();
      reset_processor();
    }
    // So long without a reset: this program is good.
    if (handover_ram.starts != 0 && program->now() > kProgramProved) {
      handover_ram.starts = 0;
      keep_records();
    }
    // Without its own chip there is no control interrupt: only the bus is served.
    keeper.serve(dog, program->now(), *program, good ? motors.ticks() : local_counts());
    if (good) wait_for_interrupt();  // 64 us at most
  }
}

// For the emulator, which looks into the image as a debugger does; the program itself never calls them.
extern "C" {
/// Path ticks at a count of local time.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_path_time(std::uint32_t counts) {
  return program ? program->path_time(counts).count() : 0;
}
/// What the plan asks of a motor (0 to 7) now: counts with 32 fractional bits.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_position(int axis) {
  const auto number = static_cast<std::size_t>(axis / kAxesPerNode);
  return plans[number].current().at(axis % kAxesPerNode, local_counts()).position;
}
}
