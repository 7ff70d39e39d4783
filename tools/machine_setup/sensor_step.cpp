// What the heaters are measured with: asked for, and where the board has two ways to measure, looked at
// before anything heats.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "gateway/description/device_schema.hpp"
#include "tools/machine_setup/heat_bench.hpp"
#include "tools/machine_setup/power_guard.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

constexpr const char* kHotend = "hotend_sensor";
constexpr const char* kAmplified = "hotend_amplifier";
constexpr const char* kWires = "hotend_wires";
constexpr const char* kMains = "mains_hz";
constexpr int kFewestWires = 2, kMostWires = 4;

SensorElement element_of(SetupState& s, const std::string& key, std::string_view what) {
  std::vector<SetupChoice> choices;
  std::size_t usual = 0;
  for (const machine_schema::Choice& choice : machine_schema::kSensorElements) {
    if (choice.value == static_cast<int>(SensorElement::kGeneric3950)) usual = choices.size();
    choices.push_back({choice.word, ""});
  }
  const std::size_t chosen =
      s.kept_choice(key, fmt::format("What does the {} measure with?", what), choices, usual);
  return static_cast<SensorElement>(machine_schema::kSensorElements[chosen].value);
}

/// Words and numbers would be mixed up in a list: a number is asked for.
int wires_of(SetupState& s) {
  if (const auto known = s.answers.get(kWires))
    for (int wires = kFewestWires; wires <= kMostWires; ++wires)
      if (*known == std::to_string(wires)) return s.dialogue.say(fmt::format("{}: {}", kWires, wires)), wires;
  const int wires = s.dialogue.number(
      kWires, "How many wires lead from the amplifier to it? The board's switches must be set for so many",
      kFewestWires, kMostWires, kFewestWires);
  s.answers.set(kWires, std::to_string(wires));
  return wires;
}

/// A sensor on the board's MAX31865, or nothing of it.
std::optional<SensorWiring> amplified_sensor(SetupState& s) {
  static constexpr SetupChoice kWays[] = {{"no", "a thermistor, or another sensor that is plugged into TH0"},
                                          {"pt100", "a Pt100 in the amplifier's socket"},
                                          {"pt1000", "a Pt1000 in the amplifier's socket"}};
  static constexpr SetupChoice kHertz[] = {{"50", "Europe, Africa, Australia, most of Asia"},
                                           {"60", "North America, parts of South America and of Asia"}};
  const std::size_t way = s.kept_choice(
      kAmplified,
      "Is the hot end measured by the EBB's amplifier for a Pt100 or Pt1000? Boards that have one bear a "
      "chip MAX31865, a socket for four wires and switches beside it.",
      kWays, 0);
  if (way == 0) return std::nullopt;
  SensorWiring sensor{.max31865 = true};
  sensor.element = way == 1 ? SensorElement::kPt100 : SensorElement::kPt1000;
  sensor.reference_ohm = way == 1 ? 430 : 4300;  // what those switches choose
  sensor.wires = wires_of(s);
  const std::size_t mains = s.kept_choice(
      kMains, "What does the mains swing with here, Hz? The amplifier takes away its hum.", kHertz, 0);
  s.first.mains_hz = mains == 0 ? 50 : 60;
  return sensor;
}

void ask_for_hotend(SetupState& s) {
  s.first.hotend_sensor = {};
  if (plan_of(s.first).hotend_amplifier)
    if (const auto sensor = amplified_sensor(s)) {
      s.first.hotend_sensor = *sensor;
      return;
    }
  s.first.hotend_sensor.element = element_of(s, kHotend, "hot end");
}

HeaterDescription* hotend_of(MachineDescription& machine) {
  const auto found = std::find_if(
      machine.heaters.begin(), machine.heaters.end(),
      [](const HeaterDescription& h) { return h.kind == HeaterKind::kHotend && h.place.on_node(); });
  return found == machine.heaters.end() ? nullptr : &*found;
}

class SensorTest {
 public:
  SensorTest(SetupState& state, HeaterDescription& hotend) : s_(state), hotend_(hotend) {}

  void run() {
    const std::string place = "Sensor of the hot end: " + words(hotend_.wiring.sensor);
    if (s_.done(kKey, place)) return;
    s_.dialogue.say("\nThe hot end's sensor, while all is cold.");
    const HeatOff off(s_.host.bus, {hotend_.place.node_id});
    while (!look()) {
    }
  }

 private:
  static constexpr const char* kKey = "sensor_hotend";

  static std::string words(const SensorWiring& sensor) {
    if (!sensor.max31865) return "at TH0";
    return fmt::format("{} with {} wires at the amplifier",
                       sensor.element == SensorElement::kPt100 ? "Pt100" : "Pt1000", sensor.wires);
  }

  /// False: once more.
  bool look() {
    const SensorWiring& sensor = hotend_.wiring.sensor;
    std::string trouble;
    try {
      HeatBench bench(s_.host.bus, hotend_.place.node_id);
      bench.describe(s_.machine, true);
      const int input = hotend_.place.channel - 1;
      if (const auto celsius = bench.temperature_c(input)) return agree(*celsius);
      trouble = bench.sensor_trouble(input, sensor);
    } catch (const CardError& error) {
      trouble = error.what();
      if (sensor.max31865)
        trouble += ". A board without the amplifier, or an older program, refuses such a sensor";
    }
    s_.dialogue.say(fmt::format("Sensor of the hot end, {}: {}", words(sensor), trouble));
    if (sensor.max31865)
      s_.dialogue.say(fmt::format(
          "Look at the four switches beside the amplifier, too: they are set for {} and {} wires.",
          sensor.element == SensorElement::kPt100 ? "Pt100 (430 ohm)" : "Pt1000 (4300 ohm)", sensor.wires));
    return ask_what_now();
  }

  bool agree(double celsius) {
    if (s_.dialogue.yes(
            "sensor",
            fmt::format("The hot end's sensor says {:.1f} C. Is it as warm as that, by some 5 K?", celsius),
            true)) {
      s_.answers.set(kKey, fmt::format("says {:.1f} C", celsius));
      return true;
    }
    s_.dialogue.say(
        hotend_.wiring.sensor.max31865
            ? "Far away from it: another element than was said, or the switches beside the amplifier are set "
              "for another one. Some "
              "degrees too many: as many wires must be said, and set there, as there are; each ohm of two "
              "long wires is 2.6 K of a "
              "Pt100."
            : "Then it is another sensor than was said.");
    return ask_what_now();
  }

  bool ask_what_now() {
    static constexpr SetupChoice kNow[] = {{"again", "it is looked at again"},
                                           {"another", "it is another sensor, or another way to connect it"},
                                           {"skip", "not now"}};
    switch (s_.dialogue.choose("sensor", "What now?", kNow, 0)) {
      case 1:
        change();
        return false;
      case 2:
        s_.answers.set(kKey, kSkipped);
        return true;
      default:
        if (s_.host.interrupted()) throw SetupInterrupted("interrupted");
        return false;
    }
  }

  void change() {
    for (const char* key : {kAmplified, kWires, kMains, kHotend}) s_.answers.forget(key);
    ask_for_hotend(s_);
    hotend_.wiring.sensor = s_.first.hotend_sensor;
    s_.machine.thermal.mains_hz = s_.first.mains_hz;
    s_.save();
  }

  SetupState& s_;
  HeaterDescription& hotend_;
};

}  // namespace

void ask_for_sensors(SetupState& s) {
  // What is in the file already is changed where it is looked at.
  std::error_code ignored;
  const bool written = s.answers.get("file_written") && std::filesystem::exists(s.file, ignored);
  if (plan_of(s.first).heat_nodes.empty() || written) return;
  ask_for_hotend(s);
  s.first.bed_sensor = {};
  s.first.bed_sensor.element = element_of(s, "bed_sensor", "bed");
}

void test_sensors(SetupState& s) {
  HeaterDescription* hotend = hotend_of(s.machine);
  if (hotend != nullptr && plan_of(s.first).hotend_amplifier) SensorTest(s, *hotend).run();
}

}  // namespace kinebus
