// The EBB's firmware: builds the parts, connects them, loops.

#include <optional>

#include "node_firmware/board/identity.hpp"
#include "node_firmware/board/node_pass.hpp"
#include "node_firmware/board/runtime.hpp"
#include "node_firmware/boot/image_header.hpp"
#include "node_firmware/port/stm32/handlers.hpp"
#include "node_firmware/port/stm32g0b1_ebb/board.hpp"
#include "node_firmware/port/stm32g0b1_ebb/can_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/clock_tree.hpp"
#include "node_firmware/port/stm32g0b1_ebb/flash_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/motors.hpp"
#include "node_firmware/port/stm32g0b1_ebb/pins.hpp"
#include "node_firmware/port/stm32g0b1_ebb/reset_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/switch_port.hpp"
#include "node_firmware/port/stm32g0b1_ebb/watchdog_port.hpp"
#include "protocol/canopen/boards/stm32g0b1_ebb.hpp"

namespace {

using namespace kinebus;
using namespace kinebus::g0b1;

struct LocalTimer {
  static constexpr int kClockWindow = ClockEstimate::kShortWindow;  // 64-bit arithmetic is software here
  static PlanCounts counts() { return local_counts(); }
};
static_assert(1'000'000'000 / kLocalHz == kPlanCount.count());

constinit CanPort can_port;
constinit CanTap axis_tap{can_port, 0};
constinit SwitchPort switch_port;
constinit ParameterFlash<ebb::kParameterPages> parameter_flash;
constinit PageStore parameters{parameter_flash};
constinit WatchdogPort dog;
constinit WatchdogKeeper keeper;
constinit std::optional<NodeProgram<CanTap, SwitchPort, LocalTimer>> program;

static_assert(shares_slots(kNodeTable, BoardObjects<Stm32g0b1EbbBoard>::kTable));

constexpr NodeIdentity identity() {
  constexpr const BoardFacts& kFacts = Stm32g0b1EbbBoard::kFacts;
  return {.product_code = kFacts.product_code, .revision = kFacts.revision};
}

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
}

int main() {
  enable_clock(rcc().APBENR1, Rcc::kDebug);
  // On another chip the same pins may be wired to anything: nothing but the bus is touched there.
  const bool own_chip = device_id() == kDeviceG0B1;
  if (own_chip)
    configure_pins<ebb::kPins>();
  else
    configure_pins<ebb::kBusPins>();
  if (!start_clocks()) power_off_and_reset(fault_reason::kNoClock, nullptr);
  system_control().VTOR = ebb::kProgramPages.address();
  start_local_time();
  MotorParts& parts = motor_parts.emplace();
  auto& motors = parts.motors;
  if (own_chip) {
    DriverUart::start();
    settle_drivers<LocalTimer>(parts.drivers);  // 50 ms, where it does not answer, too
  }
  can_port.start();
  const auto stored = parameters.load();
  static_cast<void>(parameters.prepare(kLargestParameterImage));
  NodeOptions options{.identity = identity(),
                      .node_id = take_inherited_node_id(handover_ram),
                      .program_crc = kImageHeader.crc,
                      .reset = take_reset_report(),
                      .table = &BoardObjects<Stm32g0b1EbbBoard>::kTable};
  options.identity.serial = serial_number(unique_id());
  program.emplace(options, stored, axis_tap, switch_port, parts.plans[0]);
  Node& node = program->node();
  if (own_chip) {
    switch_port.start(local_counts());
    motors.start();
    program->align_plans(motors.plan_grid());
  }
  enable_interrupts();
  dog.start();
  for (;;) {
    pass(
        *program, motors, own_chip ? emcy::kNoError : emcy::kOtherBoard,
        [](std::size_t, auto image) {
          return parameters.save(std::array{std::span<const std::uint8_t>(image)});
        },
        dog);
    if (own_chip) parts.drivers.serve(program->now());
    // Asked for by 1F51h, when the answer is on the bus. Nothing has power then (the node refuses otherwise).
    if (node.program_stop_requested() && can_port.queue().idle()) {
      handover_ram = Handover{.stay = Handover::kBootLoader, .node_id = node.node_id()};
      reset_processor();
    }
    if (program->now() > kProgramProved) handover_ram.starts = 0;
    // Without its own chip there is no control interrupt: only the bus is served.
    keeper.serve(dog, program->now(), node, own_chip ? motors.ticks() : local_counts());
    if (own_chip) wait_for_interrupt();  // 64 us at most
  }
}

// For the emulator, which looks into the image as a debugger does; the program itself never calls them.
extern "C" {
/// Path ticks at a count of local time.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_path_time(std::uint32_t counts) {
  return program ? program->path_time(counts).count() : 0;
}
/// What the plan asks of a motor now: counts with 32 fractional bits.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_position(int axis) {
  return motor_parts->plans[0].current().at(axis, local_counts()).position;
}
/// Steps up to the end of the frame that was computed last.
[[gnu::used, gnu::section(".kept.debug_calls")]] std::int64_t debug_steps(int axis) {
  return motor_parts->motors.steps(axis);
}
}
