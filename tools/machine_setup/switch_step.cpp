// Each switch is pressed by a person, and seen or not.

#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "tools/card/node_sdo.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

using namespace std::chrono_literals;

constexpr LocalTime kPress = 30s, kLetGo = 10s, kLook = 50ms;

/// An input that has changed: its level when it is pressed.
struct PressedInput {
  std::uint8_t node = 0;
  int input = 1;  ///< 1..7
  bool high = false;
  bool is_at(std::uint8_t at_node, int at_input) const { return node == at_node && input == at_input; }
};

class SwitchTest {
  using Levels = std::map<std::uint8_t, unsigned>;  ///< at the pins, by node

 public:
  explicit SwitchTest(SetupState& state) : s_(state) {
    for (const NodeDescription& node : s_.machine.nodes)
      if (node.functions.has_axes()) nodes_.insert(node.id);
  }

  void run() {
    s_.dialogue.say("\nSwitches: press the one that is asked for, by hand, and let it go.");
    for (JointDescription& joint : s_.machine.joints)
      if (joint.homing && joint.homing->at_switch())
        while (!test(joint)) {
        }
    if (s_.machine.probe.present && s_.machine.probe.place.on_node())
      while (!test_probe()) {
      }
  }

 private:
  /// The inputs of all nodes as they are at the pins.
  Levels levels() {
    Levels all;
    for (const std::uint8_t id : nodes_) {
      NodeSdo node(s_.host.bus, id);
      auto bits = static_cast<unsigned>(node.read(object::kSwitchLevels));
      if (!inverted_.contains(id)) {
        unsigned inverted = 0;
        for (int i = 0; i < kSwitchInputs; ++i)
          if (node.read({object::kSwitchPolarity.index, static_cast<std::uint8_t>(i + 1)}) != 0)
            inverted |= 1U << i;
        inverted_[id] = inverted;
      }
      all[id] = bits ^ inverted_[id];
    }
    return all;
  }

  /// One pin may be an input of several nodes (the Octopus' stops): of those that change at once the one at
  /// `node`, `input` counts, or one of that node, or the first. nullopt: none, or it has not come back.
  std::optional<PressedInput> wait_for_press(std::uint8_t node, int input) {
    const auto before = levels();
    for (const LocalTime end = s_.host.bus.now() + kPress; s_.host.bus.now() < end;) {
      if (s_.host.interrupted()) throw SetupInterrupted("interrupted");
      if (const auto pressed = best(changed(before, levels()), node, input)) {
        if (let_go(*pressed)) return pressed;
        s_.dialogue.say(fmt::format(
            "{} has not come back: it is stuck, or was pressed before it was asked for. Let it go, and once "
            "more.",
            words(pressed->node, pressed->input)));
        return std::nullopt;
      }
      NodeSdo(s_.host.bus, *nodes_.begin()).pause(kLook);
    }
    s_.dialogue.say(
        "Nothing was seen in 30 s: is the plug in the right socket, and its wire whole? A switch that is "
        "pressed "
        "already cannot be seen: let it go first.");
    return std::nullopt;
  }

  static std::vector<PressedInput> changed(const Levels& before, const Levels& after) {
    std::vector<PressedInput> all;
    for (const auto& [node, now] : after)
      for (int i = 0; i < kSwitchInputs; ++i)
        if (const unsigned bit = 1U << i; ((now ^ before.at(node)) & bit) != 0)
          all.push_back({node, i + 1, (now & bit) != 0});
    return all;
  }
  static std::optional<PressedInput> best(const std::vector<PressedInput>& all, std::uint8_t node,
                                          int input) {
    for (const PressedInput& one : all)
      if (one.is_at(node, input)) return one;
    for (const PressedInput& one : all)
      if (one.node == node) return one;
    return all.empty() ? std::nullopt : std::optional(all.front());
  }

  bool let_go(const PressedInput& pressed) {
    for (const LocalTime end = s_.host.bus.now() + kLetGo; s_.host.bus.now() < end;) {
      if (s_.host.interrupted()) throw SetupInterrupted("interrupted");
      if ((levels().at(pressed.node) >> (pressed.input - 1) & 1U) != (pressed.high ? 1U : 0U)) return true;
      NodeSdo(s_.host.bus, pressed.node).pause(kLook);
    }
    return false;
  }

  std::string words(std::uint8_t node, int input) const { return switch_words(s_.first.boards, node, input); }

  /// Asks for a press, until one was seen or the switch is passed over. `node`, `input`: where it belongs.
  std::optional<PressedInput> ask(const std::string& what, std::uint8_t node, int input) {
    for (;;) {
      static constexpr SetupChoice kReady[] = {{"press", "it is pressed within 30 s from now"},
                                               {"skip", "this switch is not tested now"}};
      if (s_.dialogue.choose("switch", what, kReady, 0) == 1) return std::nullopt;
      if (const auto pressed = wait_for_press(node, input)) return pressed;
    }
  }

  void note(SwitchInput& input, const PressedInput& pressed) {
    input.active_low = !pressed.high;
    s_.save();
    if (!pressed.high && s_.first.boards != BoardSet::kCards)
      s_.dialogue.say(
          "It closes when it is pressed: a wire that breaks will not be noticed. A contact that opens (NC) "
          "tells.");
  }

  /// False: the same switch again.
  bool test(JointDescription& joint) {
    const std::string key = "switch_" + joint.name;
    const std::uint8_t wanted = joint.homing->switch_input;
    const std::string place = fmt::format("Switch of {}: {}", joint.name, words(joint.node_id, wanted));
    if (s_.done(key, place)) return true;
    const auto pressed = ask(place, joint.node_id, wanted);
    if (!pressed) return s_.answers.set(key, kSkipped), true;
    if (pressed->node != joint.node_id) {
      s_.dialogue.say(
          fmt::format("That was {}. A joint homes by an input of its own node, {}: put the plug into {}.",
                      words(pressed->node, pressed->input), joint.node_id, words(joint.node_id, wanted)));
      return false;
    }
    if (pressed->input != wanted && !take_other(joint, *pressed)) return false;
    note(node_of(joint.node_id).inputs[static_cast<std::size_t>(pressed->input) - 1], *pressed);
    s_.answers.set(key, fmt::format("seen at {}, {} when pressed", words(pressed->node, pressed->input),
                                    pressed->high ? "high" : "low"));
    s_.dialogue.say("Seen.");
    return true;
  }

  bool take_other(JointDescription& joint, const PressedInput& pressed) {
    for (const JointDescription& other : s_.machine.joints)
      if (&other != &joint && other.homing && other.homing->method != 37 && other.node_id == pressed.node &&
          other.homing->switch_input == pressed.input)
        return s_.dialogue.say(fmt::format("That was {}, where {}'s switch belongs: exchange the plugs.",
                                           words(pressed.node, pressed.input), other.name)),
               false;
    if (!s_.dialogue.yes("switch",
                         fmt::format("That was {}. Is it {}'s from now on?",
                                     words(pressed.node, pressed.input), joint.name),
                         true))
      return false;
    joint.homing->switch_input = static_cast<std::uint8_t>(pressed.input);
    connect_switches(s_.machine);
    return true;
  }

  bool test_probe() {
    const std::string key = "switch_probe";
    const DevicePlace& at = s_.machine.probe.place;
    const std::string place = fmt::format("Probe: {}", words(at.node_id, at.channel));
    if (s_.done(key, place)) return true;
    const auto pressed = ask(place, at.node_id, at.channel);
    if (!pressed) return s_.answers.set(key, kSkipped), true;
    // An Octopus' probe is an input of each of its nodes.
    if (pressed->input != at.channel)
      return s_.dialogue.say(fmt::format("That was {}: put the plug into {}.",
                                         words(pressed->node, pressed->input),
                                         words(at.node_id, at.channel))),
             false;
    note(node_of(at.node_id).inputs[at.channel - 1U], *pressed);
    s_.answers.set(key, fmt::format("seen, {} when it touches", pressed->high ? "high" : "low"));
    s_.dialogue.say("Seen.");
    return true;
  }

  NodeDescription& node_of(std::uint8_t id) {
    for (NodeDescription& node : s_.machine.nodes)
      if (node.id == id) return node;
    throw std::logic_error("a joint without a node");
  }

  SetupState& s_;
  std::set<std::uint8_t> nodes_;
  std::map<std::uint8_t, unsigned> inverted_;  ///< 2131h, by node
};

}  // namespace

void test_switches(SetupState& s) {
  SwitchTest(s).run();
}

}  // namespace kinebus
