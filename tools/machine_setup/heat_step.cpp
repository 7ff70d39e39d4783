// Fans run one by one, and heaters get a little warm one by one.

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "tools/machine_setup/heat_bench.hpp"
#include "tools/machine_setup/power_guard.hpp"
#include "tools/machine_setup/setup_state.hpp"

namespace kinebus {
namespace {

/// Off again while it is asked which one it was: a fan runs for so long.
constexpr LocalTime kFanTime = std::chrono::seconds{3};

class HeatTest {
 public:
  explicit HeatTest(SetupState& state) : s_(state), plan_(plan_of(state.first)) {}

  void run() {
    std::set<std::uint8_t> nodes;
    for (const HeaterDescription& heater : s_.machine.heaters)
      if (heater.place.on_node()) nodes.insert(heater.place.node_id);
    for (const FanDescription& fan : s_.machine.fans)
      if (fan.place.on_node()) nodes.insert(fan.place.node_id);
    if (nodes.empty()) return;
    const HeatOff off(s_.host.bus, {nodes.begin(), nodes.end()});
    s_.dialogue.say("\nFans: each one runs for some seconds.");
    for (const FanDescription& fan : s_.machine.fans)
      fan_test(fan.name, {fan.place.node_id, fan.place.channel, connector("fan", plan_.part_fan)});
    if (plan_.hotend_fan) fan_test("hotend_fan", *plan_.hotend_fan);
    s_.dialogue.say(
        "\nHeaters: each one is warmed by 5 K. Look that nothing lies on the bed and that each thermistor "
        "sits in "
        "its place.");
    for (const HeaterDescription& heater : s_.machine.heaters)
      while (!heater_test(heater)) {
      }
  }

 private:
  static std::string connector(const char* what, const std::optional<DeviceConnector>& place) {
    return place ? place->connector : what;
  }

  void fan_test(const std::string& name, const DeviceConnector& at) {
    const std::string key = "fan_" + name, place = fmt::format("Fan {}: {}", name, at.connector);
    if (s_.done(key, place)) return;
    static constexpr SetupChoice kReady[] = {{"run", "it runs for 3 s now"}, {"skip", "not now"}};
    static constexpr SetupChoice kSeen[] = {{"yes", "it ran"},
                                            {"no", "nothing, or another one ran"},
                                            {"again", "once more"},
                                            {"skip", "not now"}};
    for (;;) {
      if (s_.dialogue.choose("fan", place, kReady, 0) == 1) return s_.answers.set(key, kSkipped);
      try {
        HeatBench bench(s_.host.bus, at.node);
        bench.describe(s_.machine, true);
        bench.run_fan(at.channel - 1, true);
        NodeSdo(s_.host.bus, at.node, kHeatTable).pause(kFanTime);
        bench.run_fan(at.channel - 1, false);
      } catch (const CardError& error) {
        s_.dialogue.say(error.what());
        continue;
      }
      switch (s_.dialogue.choose("fan", "Did it run?", kSeen)) {
        case 0:
          return s_.answers.set(key, "runs");
        case 1:
          s_.dialogue.say(
              fmt::format("Put its plug into {}; look at the plug's polarity and the fans' voltage jumper.",
                          at.connector));
          break;
        case 3:
          return s_.answers.set(key, kSkipped);
        default:
          break;
      }
    }
  }

  /// False: the same one again.
  bool heater_test(const HeaterDescription& heater) {
    if (!heater.place.on_node()) return true;
    const auto& at = heater.kind == HeaterKind::kHotend ? plan_.hotend : plan_.bed;
    const std::string key = "heater_" + heater.name;
    const std::string place = fmt::format("Heater {}: {}", heater.name, connector("heater", at));
    if (s_.done(key, place)) return true;
    static constexpr SetupChoice kReady[] = {{"warm", "it is warmed by 5 K now"}, {"skip", "not now"}};
    if (s_.dialogue.choose("heater", place, kReady, 0) == 1) return s_.answers.set(key, kSkipped), true;
    HeatBench::Rise rise;
    try {
      HeatBench bench(s_.host.bus, heater.place.node_id);
      bench.describe(s_.machine, false);
      rise = bench.warm(heater.place.channel - 1, {}, s_.host.interrupted);
    } catch (const CardError& error) {
      rise.trouble = error.what();
    }
    if (s_.host.interrupted()) throw SetupInterrupted("interrupted");
    if (!rise.reached) return tell_trouble(heater, rise), false;
    s_.dialogue.say(fmt::format("Its sensor has risen by {:.1f} K.", rise.rise_k[heater.place.channel - 1U]));
    std::vector<SetupChoice> warm;
    for (const HeaterDescription& each : s_.machine.heaters) warm.push_back({each.name, "got warm"});
    warm.push_back({"none", "nothing is warm to the hand yet"});
    const std::size_t felt = s_.dialogue.choose("heater", "Which one got warm? (Feel it with care.)", warm);
    if (felt < s_.machine.heaters.size() && &s_.machine.heaters[felt] != &heater) {
      s_.dialogue.say(
          fmt::format("Then heater and sensor of {} are both plugged in for {}: exchange both plugs.",
                      warm[felt].word, heater.name));
      return false;
    }
    s_.answers.set(key, felt < s_.machine.heaters.size() ? "warms" : "its sensor rises");
    return true;
  }

  void tell_trouble(const HeaterDescription& heater, const HeatBench::Rise& rise) {
    const int own = heater.place.channel - 1;
    if (!rise.trouble.empty()) return s_.dialogue.say(fmt::format("{}: {}", heater.name, rise.trouble));
    if (rise.warmest >= 0 && rise.warmest != own)
      return s_.dialogue.say(
          fmt::format("{}: its own sensor stayed, and sensor {} of the node rose by {:.1f} K: heater and "
                      "sensor belong to "
                      "different things. Exchange the plugs of the sensors.",
                      heater.name, rise.warmest + 1, rise.rise_k[static_cast<std::size_t>(rise.warmest)]));
    s_.dialogue.say(
        fmt::format("{}: its sensor rose by {:.1f} K only. Has the board its heater supply, is its fuse "
                    "whole, and sits the "
                    "thermistor in its block?",
                    heater.name, rise.rise_k[static_cast<std::size_t>(own)]));
  }

  SetupState& s_;
  BoardPlan plan_;
};

}  // namespace

void test_heat(SetupState& s) {
  HeatTest(s).run();
}

}  // namespace kinebus
