#include "tools/machine_setup/first_machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <stdexcept>

#include "gateway/description/commented_file.hpp"
#include "gateway/description/machine_file.hpp"
#include "gateway/description/shipped_machines.hpp"

namespace kinebus {
namespace {

constexpr std::string_view kHeatExample = "corexy_heat";

std::string_view word_of(SetupMachine machine) {
  return setup_machines()[static_cast<std::size_t>(machine)].word;
}
const SetupChoice& choice_of(BoardSet set) {
  return board_sets()[static_cast<std::size_t>(set)];
}

std::string_view shipped_text(std::string_view name) {
  for (const ShippedMachine& shipped : shipped_machines())
    if (shipped.name == name) return shipped.text;
  throw std::logic_error("no shipped machine " + std::string(name));
}

/// Of a machine file the tables that say what is heated and how.
std::string heat_tables(std::string_view text) {
  std::string kept, line;
  bool heat = false;
  std::istringstream in{std::string(text)};
  while (std::getline(in, line)) {
    if (line.starts_with("["))
      heat = line.starts_with("[heater.") || line.starts_with("[fan.") || line.starts_with("[thermal");
    if (heat) kept += line + "\n";
  }
  return kept;
}

MachineDescription shipped(std::string_view name) {
  auto machine = parse_machine(shipped_text(name), name);
  if (!machine) throw std::logic_error(to_string(machine.error()));
  return std::move(*machine);
}

NodeDescription& node_of(MachineDescription& d, std::uint8_t id) {
  const auto place =
      std::lower_bound(d.nodes.begin(), d.nodes.end(), id,
                       [](const NodeDescription& node, std::uint8_t wanted) { return node.id < wanted; });
  if (place != d.nodes.end() && place->id == id) return *place;
  NodeDescription node;
  node.id = id;
  return *d.nodes.insert(place, node);
}

DevicePlace at(const DeviceConnector& connector) {
  return {DevicePlace::Where::kNode, connector.node, connector.channel};
}

/// Heaters and fans on the boards' heat nodes, wired as in the shipped example; without a heat node there are
/// none: a heater that only seems to be there must be no oversight.
void connect_heat(MachineDescription& d, const FirstMachine& first, const BoardPlan& plan) {
  d.heaters.clear();
  d.fans.clear();
  for (const HeatNodePlace& place : plan.heat_nodes)
    node_of(d, place.node).functions = {.axis_pairs = 0,
                                        .inputs = 0,
                                        .heaters = place.heaters,
                                        .sensors = place.sensors,
                                        .outputs = place.outputs};
  for (HeaterDescription heater : shipped(kHeatExample).heaters) {
    const bool hotend = heater.kind == HeaterKind::kHotend;
    const auto& connector = hotend ? plan.hotend : plan.bed;
    if (!connector) continue;
    heater.place = at(*connector);
    heater.wiring.sensor = hotend ? first.hotend_sensor : first.bed_sensor;
    heater.wiring.fan_channel =
        hotend && plan.hotend_fan && plan.hotend_fan->node == connector->node ? plan.hotend_fan->channel : 0;
    heater.wiring.fan_pulses = 0;
    d.heaters.push_back(heater);
  }
  if (plan.part_fan) d.fans.push_back({.name = "part", .index = 0, .place = at(*plan.part_fan)});
}

}  // namespace

std::size_t joints_of(SetupMachine machine) {
  return machine == SetupMachine::kM1 ? 6 : 4;
}

BoardPlan plan_of(const FirstMachine& first) {
  BoardPlan plan = plan_boards(first.boards, joints_of(first.machine), first.heat_node);
  if (plan.hotend && plan.hotend_amplifier && first.hotend_sensor.max31865)
    plan.hotend->connector = "heater and MAX31865 of the EBB";
  return plan;
}

void connect_switches(MachineDescription& d) {
  for (NodeDescription& node : d.nodes)
    for (SwitchInput& input : node.inputs)
      if (input.function == InputFunction::kHome) input.function = InputFunction::kNone;
  for (const JointDescription& joint : d.joints) {
    if (!joint.homing || joint.homing->method == 37) continue;
    SwitchInput& input = node_of(d, joint.node_id).inputs[joint.homing->switch_input - 1U];
    input.function = InputFunction::kHome;
    input.axis = joint.axis;
  }
  for (NodeDescription& node : d.nodes)
    for (SwitchInput& input : node.inputs)
      if (input.function == InputFunction::kNone) input = {};
}

MachineDescription make_description(const FirstMachine& first) {
  const BoardPlan plan = plan_of(first);
  MachineDescription d = shipped(word_of(first.machine));
  d.name = fmt::format("{}_{}", word_of(first.machine), choice_of(first.boards).word);
  for (const char sign : {'+', '-'}) std::replace(d.name.begin(), d.name.end(), sign, '_');
  d.bus.interface = first.interface;
  d.nodes.clear();
  for (std::size_t j = 0; j < d.joints.size(); ++j) {
    JointDescription& joint = d.joints[j];
    joint.node_id = plan.motors[j].node;
    joint.axis = plan.motors[j].axis;
    node_of(d, joint.node_id);
    if (joint.homing) joint.homing->switch_input = static_cast<std::uint8_t>(joint.axis + 1);
  }
  connect_switches(d);
  connect_heat(d, first, plan);
  d.thermal.mains_hz = first.mains_hz;
  if (first.probe) {
    d.probe.present = true;
    d.probe.place = at(plan.probe);
    node_of(d, plan.probe.node).inputs[plan.probe.channel - 1U].function = InputFunction::kProbe;
  }
  return d;
}

std::string file_text(const FirstMachine& first, const MachineDescription& description) {
  const BoardPlan plan = plan_of(first);
  FileRemarks remarks;
  remarks.header = fmt::format(
      "# {}: {}; {}.\n"
      "# Geometry and limits are those of {}.toml: make them this machine's. What is connected where stands "
      "above\n"
      "# each table.\n"
      "#\n"
      "# Lengths are mm, angles deg, times as the key says. A key that is unknown, missing or out of range "
      "is refused\n"
      "# with its line and the allowed range. What may be left out has a default or means \"no limit\".\n\n",
      description.name, setup_machines()[static_cast<std::size_t>(first.machine)].description,
      choice_of(first.boards).description, word_of(first.machine));
  for (const JointDescription& joint : description.joints)
    for (const MotorPlace& place : plan.motors)
      if (place.node == joint.node_id && place.axis == joint.axis)
        remarks.tables["joint." + joint.name] = place.connector;
  for (const NodeDescription& node : description.nodes) {
    remarks.tables[fmt::format("node.{}", node.id)] = "A pair of axes";
    for (std::size_t i = 0; i < kNodeInputs; ++i)
      remarks.tables[fmt::format("node.{}.input{}", node.id, i + 1)] =
          switch_words(first.boards, node.id, static_cast<int>(i + 1));
  }
  for (const HeatNodePlace& place : plan.heat_nodes)
    remarks.tables[fmt::format("node.{}", place.node)] = place.board + ": heaters, sensors and fans";
  const auto remark = [&](const std::string& table, const std::optional<DeviceConnector>& connector) {
    if (connector) remarks.tables[table] = connector->connector;
  };
  remark("heater.hotend", plan.hotend);
  remark("heater.bed", plan.bed);
  remark("fan.part", plan.part_fan);
  remarks.tables["probe"] = plan.probe.connector;
  const std::string heat = heat_tables(shipped_text(kHeatExample));
  const std::array<std::string_view, 4> examples{heat, shipped_text(word_of(first.machine)),
                                                 shipped_text("m1"), key_remarks()};
  return with_comments(write_machine(description), examples, remarks);
}

}  // namespace kinebus
