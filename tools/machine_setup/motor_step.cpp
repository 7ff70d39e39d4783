// Each motor moves a bit, and a person says which one it was and which way.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tools/machine_setup/power_guard.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

constexpr double kMove_mm = 5, kSpeed_mm_per_s = 10, kMove_rad = 20 * kRadPerDeg,
                 kSpeed_rad_per_s = 40 * kRadPerDeg;
constexpr LocalTime kRest = std::chrono::milliseconds{500};

struct Directions {
  std::string_view positive, negative;
};
/// As a person beside the machine sees them.
Directions directions_of(const JointDescription& joint) {
  const std::string& name = joint.name;
  if (name == "X") return {"the tool to the right (or the bed to the left)", "the tool to the left"};
  if (name == "Y") return {"the tool to the back (or the bed to the front)", "the tool to the front"};
  if (name == "Z") return {"tool and bed apart", "tool and bed towards each other"};
  if (name == "C") return {"counter-clockwise, seen from above", "clockwise, seen from above"};
  if (name == "E") return {"filament forward, into the hot end", "filament back"};
  if (name == "beltA")
    return {"the tool to the right and to the back", "the tool to the left and to the front"};
  if (name == "beltB")
    return {"the tool to the right and to the front", "the tool to the left and to the back"};
  return {"its carriage up", "its carriage down"};
}

/// Joints that hold while this one moves, since they move the same tool.
bool holds(const JointDescription& moving, const JointDescription& other) {
  const auto mechanism = [](const JointDescription& j) {
    return j.name.starts_with("tower") ? "tower" : j.name.starts_with("belt") ? "belt" : j.name.c_str();
  };
  return &moving != &other && std::string_view(mechanism(moving)) == mechanism(other);
}

enum class Seen : std::uint8_t { kAsSaid, kOtherWay, kNothing, kAnother, kAgain, kSkip };

class MotorTest {
 public:
  explicit MotorTest(SetupState& state) : s_(state) {}

  void run() {
    s_.dialogue.say("\nMotors: each one moves a bit and back. Keep hands and tools off the machine.");
    for (const JointDescription& joint : s_.machine.joints)
      static_cast<void>(s_.done(key_of(joint), place_of(joint)));
    while (JointDescription* joint = next()) test(*joint);
  }

 private:
  static std::string key_of(const JointDescription& joint) { return "motor_" + joint.name; }

  std::string place_of(const JointDescription& joint) const {
    return fmt::format("{}: {}", joint.name, s_.connector_of(joint));
  }
  /// The first one that is neither tested nor passed over; nullptr: none is left.
  JointDescription* next() {
    for (JointDescription& joint : s_.machine.joints) {
      const auto known = s_.answers.get(key_of(joint));
      if (!known || (*known == kSkipped && !skipped_.contains(joint.name))) return &joint;
    }
    return nullptr;
  }

  void test(JointDescription& joint) {
    const Directions directions = directions_of(joint);
    static constexpr SetupChoice kReady[] = {{"move", "it moves now, and back"},
                                             {"skip", "this motor is not tested now"}};
    if (s_.dialogue.choose("motor", fmt::format("{}: first {}.", place_of(joint), directions.positive),
                           kReady, 0) == 1)
      return skip(joint);
    try {
      move(joint);
    } catch (const CardError& error) {
      s_.dialogue.say(error.what());
      if (s_.dialogue.yes("motor", "Try again?", true)) return;
      return skip(joint);
    }
    const SetupChoice seen[] = {{"yes", directions.positive},  {"inverted", directions.negative},
                                {"nothing", "no motor moved"}, {"another", "another joint's motor moved"},
                                {"again", "once more"},        {"skip", "this motor is not tested now"}};
    switch (static_cast<Seen>(s_.dialogue.choose("motor", "What moved first?", seen))) {
      case Seen::kAsSaid:
        return finish(joint, joint.drive.inverted ? "moves (inverted)" : "moves");
      case Seen::kOtherWay:
        joint.drive.inverted = !joint.drive.inverted;
        s_.save();
        s_.dialogue.say(fmt::format("joint.{}.inverted = {}: it moves again, to see it.", joint.name,
                                    joint.drive.inverted));
        return;
      case Seen::kNothing:
        s_.dialogue.say(
            "Has the board its motor supply? Is the motor's plug in that connector, and all four wires on "
            "their "
            "pairs? Does its driver stand in its socket the right way round?");
        return;
      case Seen::kAnother:
        return exchange(joint);
      case Seen::kAgain:
        return;
      default:
        return skip(joint);
    }
  }

  void finish(const JointDescription& joint, const std::string& result) {
    s_.answers.set(key_of(joint), result);
  }
  void skip(const JointDescription& joint) {
    skipped_.insert(joint.name);
    finish(joint, kSkipped);
  }

  void move(const JointDescription& joint) {
    std::set<std::uint8_t> nodes;
    for (const JointDescription& each : s_.machine.joints) nodes.insert(each.node_id);
    const MotorsOff off(s_.host.bus, {nodes.begin(), nodes.end()});
    for (const JointDescription& other : s_.machine.joints)
      if (holds(joint, other)) {
        Card card(s_.host.bus, other.node_id);
        card.set_currents(other.axis, other.run_current_ma, other.hold_current_ma);
        card.power(other.axis, true);
      }
    Card card(s_.host.bus, joint.node_id);
    card.set_currents(joint.axis, joint.run_current_ma, joint.hold_current_ma);
    const double counts = joint.drive.counts_per_unit() * (joint.rotary ? kMove_rad : kMove_mm);
    const double usual = joint.rotary ? kSpeed_rad_per_s : kSpeed_mm_per_s;
    const double counts_per_s = std::abs(joint.drive.counts_per_unit()) * std::min(usual, joint.speed_per_s);
    for (const double way : {counts, -counts}) {
      card.jog(joint.axis, std::llround(way), counts_per_s, s_.host.interrupted);
      if (s_.host.interrupted()) throw SetupInterrupted("interrupted");
      NodeSdo(s_.host.bus, joint.node_id).pause(kRest);
    }
  }

  /// The two joints' plugs are exchanged: so are they in the file. Both are to be tested again.
  void exchange(JointDescription& joint) {
    std::vector<SetupChoice> choices;
    std::vector<JointDescription*> others;
    for (JointDescription& other : s_.machine.joints) {
      if (&other == &joint) continue;
      choices.push_back({other.name, ""});
      others.push_back(&other);
    }
    JointDescription& other = *others[s_.dialogue.choose("joint", "Which joint moved?", choices)];
    std::swap(joint.node_id, other.node_id);
    std::swap(joint.axis, other.axis);
    for (JointDescription* each : {&joint, &other}) {
      if (each->homing) each->homing->switch_input = static_cast<std::uint8_t>(each->axis + 1);
      s_.answers.forget(key_of(*each));
    }
    connect_switches(s_.machine);
    s_.save();
    s_.dialogue.say(fmt::format("{} is {} now, and {} is {}.", joint.name, s_.connector_of(joint), other.name,
                                s_.connector_of(other)));
  }

  SetupState& s_;
  std::set<std::string> skipped_;  ///< now; those of an earlier time are asked for again
};

}  // namespace

void test_motors(SetupState& s) {
  MotorTest(s).run();
}

}  // namespace kinebus
