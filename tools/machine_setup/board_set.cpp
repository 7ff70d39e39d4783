#include "tools/machine_setup/board_set.hpp"

#include <fmt/format.h>

#include <array>

namespace kinebus {
namespace {

// The Octopus' nodes: four axis pairs and one for heat, with ids in a row; its heaters' channels are those of
// port/stm32f446_octopus.
constexpr std::uint8_t kOctopusFirst = 1, kOctopusPairs = 4, kOctopusHeat = 5;
constexpr std::uint8_t kOctopusStops = 8;
constexpr std::uint8_t kEbb = 6;  // its extruder, or its heat: one program each

/// nullptr: this build knows no such board.
const BoardFacts* facts_of(std::string_view name) {
  const BoardDescription* board = find_board(name);
  return board != nullptr ? &board->facts : nullptr;
}

MotorPlace octopus_motor(std::size_t driver) {
  const auto pair = static_cast<std::uint8_t>(driver / 2);
  return {static_cast<std::uint8_t>(kOctopusFirst + pair), static_cast<std::uint8_t>(driver % 2),
          fmt::format("MOTOR{} of the Octopus", driver), fmt::format("STOP{} of the Octopus", driver)};
}

MotorPlace card_motor(std::size_t motor) {
  const std::size_t card = motor / 2 + 1, axis = motor % 2;
  return {static_cast<std::uint8_t>(card), static_cast<std::uint8_t>(axis),
          fmt::format("motor {} of card {}", "AB"[axis], card),
          fmt::format("switch input {} of card {}", axis + 1, card)};
}

void add_octopus(BoardPlan& plan, std::size_t motors) {
  plan.roles.push_back(
      {"Octopus", facts_of("stm32f446_octopus"), kOctopusFirst, kOctopusPairs + 1, "kinebus-octopus-f446"});
  for (std::size_t driver = 0; driver < motors; ++driver) plan.motors.push_back(octopus_motor(driver));
  plan.heat_nodes.push_back({kOctopusHeat, 4, 1, 6, "Octopus"});
  plan.bed = {kOctopusHeat, 2, "bed heater and TB of the Octopus"};
  plan.hotend = {kOctopusHeat, 1, "HE0 and T0 of the Octopus"};
  plan.hotend_fan = {kOctopusHeat, 1, "FAN0 of the Octopus"};
  plan.part_fan = {kOctopusHeat, 2, "FAN1 of the Octopus"};
  plan.probe = {kOctopusFirst, 7, "PROBE of the Octopus"};
}

void add_ebb_axis(BoardPlan& plan) {
  plan.roles.push_back(
      {"EBB", facts_of("stm32g0b1_ebb"), kEbb, 1, "kinebus-ebb-g0b1", true, facts_of("heat")});
  plan.motors.push_back({kEbb, 0, "the extruder's driver of the EBB", "PROBE of the EBB"});
  // That image has no heat node: the hot end and its fans are the Octopus'.
  plan.probe = {kEbb, 1, "PROBE of the EBB"};
}

/// Hot end and fans at the tool head; the Octopus keeps the motors, the bed and the probe.
void add_ebb_heat(BoardPlan& plan) {
  plan.roles.push_back(
      {"EBB", facts_of("heat"), kEbb, 1, "kinebus-ebb-g0b1-heat", true, facts_of("stm32g0b1_ebb")});
  plan.heat_nodes.push_back({kEbb, 1, 0, 2, "EBB"});
  plan.hotend = {kEbb, 1, "heater and TH0 of the EBB"};
  plan.hotend_amplifier = true;
  plan.hotend_fan = {kEbb, 1, "FAN1 of the EBB"};
  plan.part_fan = {kEbb, 2, "FAN2 of the EBB"};
}

void add_cards(BoardPlan& plan, std::size_t joints, std::uint8_t heat_node) {
  for (std::size_t motor = 0; motor < joints; ++motor) plan.motors.push_back(card_motor(motor));
  for (std::size_t card = 1; card <= (joints + 1) / 2; ++card)
    plan.roles.push_back({fmt::format("card {}", card), facts_of("stm32f405"),
                          static_cast<std::uint8_t>(card), 1, "kinebus-node"});
  plan.probe = {1, 7, "switch input 7 of card 1"};
  if (heat_node == 0) return;
  plan.heat_nodes.push_back({heat_node, 2, 0, 2, "heat node"});
  plan.hotend = {heat_node, 1, "heater 1 and sensor 1 of the heat node"};
  plan.bed = {heat_node, 2, "heater 2 and sensor 2 of the heat node"};
  plan.hotend_fan = {heat_node, 1, "fan 1 of the heat node"};
  plan.part_fan = {heat_node, 2, "fan 2 of the heat node"};
}

}  // namespace

std::span<const SetupChoice> setup_machines() {
  static constexpr std::array<SetupChoice, 4> kChoices{
      {{"m1", "four-leg parallel printer with a rotary table (six motors)"},
       {"delta", "linear delta printer (four motors)"},
       {"corexy", "CoreXY printer (four motors)"},
       {"cartesian", "printer with a motor each for X, Y and Z (four motors)"}}};
  return kChoices;
}

std::span<const SetupChoice> board_sets() {
  static constexpr std::array<SetupChoice, 4> kChoices{
      {{"octopus", "one BTT Octopus with everything on it"},
       {"octopus+ebb", "one BTT Octopus, and a BTT EBB36 or EBB42 at the tool head"},
       {"octopus+ebb-heat",
        "one BTT Octopus with all motors, and a BTT EBB36 or EBB42 with the hot end and its fans"},
       {"cards", "driver cards with an STM32F405, two motors each"}}};
  return kChoices;
}

BoardPlan plan_boards(BoardSet set, std::size_t joints, std::uint8_t heat_node) {
  BoardPlan plan;
  switch (set) {
    case BoardSet::kOctopus:
      add_octopus(plan, joints);
      break;
    case BoardSet::kOctopusEbb:
      add_octopus(plan, joints - 1);
      add_ebb_axis(plan);
      break;
    case BoardSet::kOctopusEbbHeat:
      add_octopus(plan, joints);
      add_ebb_heat(plan);
      break;
    case BoardSet::kCards:
      add_cards(plan, joints, heat_node);
      break;
  }
  return plan;
}

std::string switch_words(BoardSet set, std::uint8_t node, int input) {
  std::string plain = fmt::format("input {} of node {}", input, node);
  if (set == BoardSet::kCards) return plain;
  if (node >= kOctopusFirst && node < kOctopusFirst + kOctopusPairs) {
    if (input == 7) return "PROBE (" + plain + ")";
    return fmt::format("STOP{} ({})", (2 * (node - kOctopusFirst) + input - 1) % kOctopusStops, plain);
  }
  constexpr std::array kEbbInputs{"PROBE", "PB4", "PB3"};
  if (set == BoardSet::kOctopusEbb && node == kEbb && input <= int{kEbbInputs.size()})
    return fmt::format("{} ({})", kEbbInputs[static_cast<std::size_t>(input - 1)], plain);
  return plain;
}

}  // namespace kinebus
