#include "tools/machine_setup/walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>

#include "gateway/description/machine_file.hpp"
#include "tools/card/node_sdo.hpp"
#include "tools/machine_setup/demo_print.hpp"

namespace kinebus {
namespace {

constexpr int kInterrupted = 130;

void ask_for_machine(SetupState& s) {
  s.first.machine =
      static_cast<SetupMachine>(s.kept_choice("machine", "Which machine is it?", setup_machines()));
  s.first.boards = static_cast<BoardSet>(s.kept_choice("boards", "Which boards does it have?", board_sets()));
  for (const BoardRole& role : plan_of(s.first).roles)
    if (role.kind == nullptr)
      throw std::runtime_error(fmt::format("boards: this release has no program for the {}", role.name));
  if (s.first.boards == BoardSet::kCards) {
    constexpr int kUsualHeatNode = 20;
    if (const auto known = s.answers.get("heat_node"))
      s.first.heat_node = static_cast<std::uint8_t>(std::clamp(std::atoi(known->c_str()), 0, 126));
    else
      s.first.heat_node = static_cast<std::uint8_t>(
          s.dialogue.number("heat_node", "Node id of the heat node (0: there is none, and nothing heats)", 0,
                            126, kUsualHeatNode));
    for (const BoardRole& role : plan_of(s.first).roles)
      if (s.first.heat_node == role.first_id)
        throw std::runtime_error(
            fmt::format("heat_node: found {}; expected an id that no card has", s.first.heat_node));
    s.answers.set("heat_node", std::to_string(s.first.heat_node));
  }
  ask_for_sensors(s);
  s.first.probe = s.kept_yes("probe", "Is there a probe that touches the bed?", false);
}

/// Made anew, or as an earlier, interrupted set-up has left it. The boards' serial numbers are in it: the
/// gateway takes no other board in their place, and gives no heat to one.
void begin_file(SetupState& s) {
  std::error_code ignored;
  const bool there = std::filesystem::exists(s.file, ignored);
  const bool ours = s.answers.get("file_written").has_value();
  if (there && !ours)
    throw std::runtime_error(fmt::format(
        "{} is there already and was not written by this set-up: --file another name", s.file.string()));
  if (there) {
    auto machine = load_machine(s.file);
    if (!machine) throw std::runtime_error(to_string(machine.error()));
    s.machine = std::move(*machine);
    for (const HeaterDescription& heater : s.machine.heaters)
      (heater.kind == HeaterKind::kHotend ? s.first.hotend_sensor : s.first.bed_sensor) =
          heater.wiring.sensor;
    s.dialogue.say(fmt::format("Going on with {}.", s.file.string()));
  } else {
    s.machine = make_description(s.first);
  }
  for (NodeDescription& node : s.machine.nodes)
    if (const auto known = s.serials.find(node.id); known != s.serials.end()) node.serial = known->second;
  s.save();
  s.answers.set("file_written", "yes");
  if (!there) s.dialogue.say(fmt::format("Written: {}", s.file.string()));
}

/// What the daemon will read, by its own reader.
bool check_file(const SetupState& s) {
  const auto machine = load_machine(s.file);
  if (!machine) {
    s.dialogue.say(to_string(machine.error()));
    return false;
  }
  s.dialogue.say(fmt::format("\n{}: {} joints on {} nodes, {} heaters: in order.", s.file.string(),
                             machine->joints.size(), machine->nodes.size(), machine->heaters.size()));
  const std::string file = std::filesystem::absolute(s.file).string();
  const std::string demo = std::filesystem::absolute(s.file).replace_extension(".demo.gcode").string();
  write_file(demo, demo_print(*machine));
  s.dialogue.say(fmt::format("Written: {}", demo));
  s.dialogue.say(fmt::format(
      "Before the first print look into the machine file: travel, limits, currents and geometry are those of "
      "a usual "
      "machine of this kind.\n"
      "Start the gateway: kinebusd --machine {0} --bus {1}\n"
      "How it will home:  kinebus plan --home --machine {0}\n"
      "A demo print:      kinebus plan {2} --machine {0}\n"
      "                   kinebus home\n"
      "                   kinebus run {2}",
      file, s.first.interface, demo));
  if (!machine->heaters.empty())
    s.dialogue.say(
        "After it, once for each heater: kinebus tune hotend. What was measured is watched closer.");
  return true;
}

int run_steps(SetupState& s) {
  ask_for_machine(s);
  give_ids(s);
  offer_programs(s);
  begin_file(s);
  test_motors(s);
  test_switches(s);
  test_sensors(s);
  test_heat(s);
  if (!check_file(s)) return 1;
  s.answers.set("finished", "yes");
  return 0;
}

}  // namespace

void SetupState::save() const {
  const std::string text = file_text(first, machine);
  // What is written must be what the gateway will read.
  const auto again = parse_machine(text, file.string());
  if (!again) throw std::runtime_error(to_string(again.error()));
  write_file(file, text);
}

bool SetupState::done(const std::string& key, const std::string& what) const {
  const auto known = answers.get(key);
  if (!known || *known == kSkipped) return false;
  dialogue.say(fmt::format("{}: {}", what, *known));
  return true;
}

std::size_t SetupState::kept_choice(const std::string& key, std::string_view question,
                                    std::span<const SetupChoice> choices, std::optional<std::size_t> usual) {
  if (const auto known = answers.get(key))
    for (std::size_t i = 0; i < choices.size(); ++i)
      if (choices[i].word == *known) return dialogue.say(fmt::format("{}: {}", key, *known)), i;
  const std::size_t chosen = dialogue.choose(key, question, choices, usual);
  answers.set(key, std::string(choices[chosen].word));
  return chosen;
}

bool SetupState::kept_yes(const std::string& key, std::string_view question, bool usual) {
  if (const auto known = answers.get(key))
    return dialogue.say(fmt::format("{}: {}", key, *known)), *known == "yes";
  const bool yes = dialogue.yes(key, question, usual);
  answers.set(key, yes ? "yes" : "no");
  return yes;
}

std::string SetupState::connector_of(const JointDescription& joint) const {
  std::string node = fmt::format("node {}, axis {}", joint.node_id, "AB"[joint.axis & 1]);
  for (const MotorPlace& place : plan_of(first).motors)
    if (place.node == joint.node_id && place.axis == joint.axis)
      return fmt::format("{} ({})", place.connector, node);
  return node;
}

int walk(SetupHost& host, const WalkOptions& options) {
  Dialogue dialogue(host.io);
  auto answers = SetupAnswers::load(options.file.string() + ".setup");
  if (!answers) return dialogue.say(answers.error()), 1;
  if (options.anew && !answers->empty()) answers->forget("");
  SetupState state{.host = host, .dialogue = dialogue, .answers = *answers, .file = options.file};
  state.first.interface = options.interface;
  try {
    if (!answers->empty())
      dialogue.say(
          fmt::format("Going on with the answers in {} (--anew begins anew).", answers->file().string()));
    return run_steps(state);
  } catch (const SetupInterrupted& interrupted) {
    dialogue.say(fmt::format("\n{}: motors and heaters are off. The same command goes on from here.",
                             interrupted.what()));
    return kInterrupted;
  } catch (const std::exception& error) {
    dialogue.say(
        fmt::format("{}\nMotors and heaters are off. The same command goes on from here.", error.what()));
    return 1;
  }
}

}  // namespace kinebus
