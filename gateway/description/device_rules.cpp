#include "gateway/description/device_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "gateway/description/camera_address.hpp"

namespace kinebus {
namespace {

/// A thermistor's curve (Steinhart-Hart) through three points, as its node makes it: the hotter the less, at
/// the points and between them.
bool falls(const std::array<double, 3>& celsius, const std::array<double, 3>& ohm) {
  std::array<double, 3> l{}, y{};  // ln R, 1/T
  for (std::size_t i = 0; i < 3; ++i) {
    l[i] = std::log(ohm[i]);
    y[i] = 1 / (celsius[i] + 273.15);
  }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < i; ++k)
      if ((l[i] - l[k]) * (y[i] - y[k]) < 1e-9) return false;
  const double g2 = (y[1] - y[0]) / (l[1] - l[0]), g3 = (y[2] - y[0]) / (l[2] - l[0]);
  const double c = (g3 - g2) / (l[2] - l[1]) / (l[0] + l[1] + l[2]);
  const double b = g2 - c * (l[0] * l[0] + l[0] * l[1] + l[1] * l[1]);
  constexpr double kHighestLog = 18.4;  // of 100 MOhm; at 1 Ohm it is 0
  return b > 0 && b + 3 * c * kHighestLog * kHighestLog > 0;
}

std::string listed(const std::array<double, 3>& values) {
  return printed("[%.6g, ", values[0]) + printed("%.6g, ", values[1]) + printed("%.6g]", values[2]);
}

class DeviceRules {
 public:
  DeviceRules(const MachineDescription& description, std::vector<BrokenRule>& broken)
      : d_(description), broken_(broken) {}

  void judge() {
    require(d_.thermal.mains_hz == 50 || d_.thermal.mains_hz == 60, {"thermal.mains_hz"},
            number(d_.thermal.mains_hz), say("50 or 60"));
    for (const NodeDescription& node : d_.nodes) inputs(node);
    for (const JointDescription& joint : d_.joints) axes(joint);
    std::map<HeaterId, std::string> heaters;
    for (const HeaterDescription& h : d_.heaters) {
      const std::string key = "heater." + h.name + ".";
      const auto [first, is_new] = heaters.emplace(h.id(), h.name);
      require(is_new, {key + "index", key + "kind"}, number(h.index),
              say("an index that no other heater of the kind has: [heater.%1] has it", first->second));
      place(h.place, key, Channels::kHeaters);
      if (h.place.on_node()) wiring(h, key);
    }
    for (const MaterialDescription& m : d_.materials) material(m);
    for (const CameraDescription& c : d_.cameras) camera(c);
    indices("fan", d_.fans);
    indices("output", d_.outputs);
    indices("input", d_.inputs, Channels::kInputs);
    for (const InputDescription& i : d_.inputs) input(i);
    for (const SensorDescription& s : d_.sensors) {
      const std::string key = "sensor." + s.name + ".";
      place(s.place, key, Channels::kSensors);
      if (s.place.on_node()) sensor(s.wiring, key);
    }
    for (const FilamentSensorDescription& f : d_.filament_sensors)
      filament(f, "filament_sensor." + f.name + ".");
    if (d_.spindle.present) {
      place(d_.spindle.place, "spindle.", Channels::kOutputs);
      require(d_.spindle.min_rpm <= d_.spindle.max_rpm, {"spindle.min_rpm", "spindle.max_rpm"},
              Sentence::verbatim(printed("%.6g", d_.spindle.min_rpm)),
              say("at most the largest speed, %1", printed("%.6g", d_.spindle.max_rpm)));
      require(d_.spindle.tap_rpm_per_s == 0 || (d_.spindle.reversible && d_.spindle.encoder_counts > 0),
              {"spindle.tap_rpm_per_s"}, Sentence::verbatim(printed("%.6g", d_.spindle.tap_rpm_per_s)),
              say("taps need a spindle that is reversible and has encoder_counts"));
    }
    if (d_.probe.present) probe();
    if (d_.probe.bltouch) bltouch();
    if (d_.accelerometer.present)
      require(d_.node(d_.accelerometer.node) != nullptr, {"accelerometer.node"},
              number(d_.accelerometer.node),
              say("a heat node that has its table, [node.%1], with axis_pairs = 0", d_.accelerometer.node));
    for (const NodeDescription& node : d_.nodes)
      if (d_.carries_heat(node.id)) heat_node(node);
  }

 private:
  /// Every heater of the kind can have it: any of them may be told.
  void material(const MaterialDescription& m) {
    const auto within = [&](HeaterKind kind, const char* key, double celsius) {
      const auto words = [](double c) { return Sentence::verbatim(printed("%.6g", c)); };
      const std::string name = "material." + m.name + "." + key;
      bool any = false;
      for (const HeaterDescription& h : d_.heaters) {
        if (h.kind != kind) continue;
        any = true;
        require(celsius <= h.max_c, {name, "heater." + h.name + ".max_c"}, words(celsius),
                say("at most max_c of [heater.%1], %2", h.name, words(h.max_c)));
      }
      require(any || celsius == 0, {name}, words(celsius), say("0, or a heater of this kind"));
    };
    within(HeaterKind::kHotend, "hotend_c", m.hotend_c);
    within(HeaterKind::kBed, "bed_c", m.bed_c);
    within(HeaterKind::kChamber, "chamber_c", m.chamber_c);
  }

  void camera(const CameraDescription& c) {
    const auto address = [&](const char* key, const std::string& text) {
      require(is_camera_address(text), {"camera." + c.name + "." + key}, Sentence::verbatim("'" + text + "'"),
              say("an address http://HOST/PATH, https://HOST/PATH or, on this computer, :PORT/PATH"));
    };
    address("stream", c.stream);
    if (!c.snapshot.empty()) address("snapshot", c.snapshot);
  }

  enum class Channels : std::uint8_t { kHeaters, kSensors, kOutputs, kInputs, kFilaments };

  void require(bool holds, std::vector<std::string> keys, Sentence found, Sentence expected) {
    if (!holds) broken_.push_back({std::move(keys), std::move(found), std::move(expected)});
  }
  static Sentence number(int value) { return Sentence::verbatim(std::to_string(value)); }

  static int count(const NodeFunctions& has, Channels channels) {
    switch (channels) {
      case Channels::kHeaters:
        return has.heaters;
      case Channels::kSensors:
        return has.sensors;
      case Channels::kOutputs:
        return has.outputs;
      case Channels::kInputs:
        return has.inputs;
      case Channels::kFilaments:
        return has.filament_sensors;
    }
    return 0;
  }
  static const char* key_of(Channels channels) {
    switch (channels) {
      case Channels::kHeaters:
        return "heaters";
      case Channels::kSensors:
        return "sensors";
      case Channels::kOutputs:
        return "outputs";
      case Channels::kInputs:
        return "inputs";
      case Channels::kFilaments:
        return "filament_sensors";
    }
    return "";
  }

  template <typename Device>
  void indices(const char* table, const std::vector<Device>& devices,
               Channels channels = Channels::kOutputs) {
    std::map<int, std::string> known;
    for (const Device& device : devices) {
      const std::string key = std::string(table) + "." + device.name + ".";
      const auto [first, is_new] = known.emplace(device.index, device.name);
      require(is_new, {key + "index"}, number(device.index),
              say("an index that no other has: [%1] has it", std::string(table) + "." + first->second));
      place(device.place, key, channels);
    }
  }

  void place(const DevicePlace& place, const std::string& key, Channels channels) {
    if (!place.on_node()) return;
    const NodeDescription* node = d_.node(place.node_id);
    require(node != nullptr, {key + "node"}, number(place.node_id),
            say("a node that has its table, [node.%1]", place.node_id));
    if (node == nullptr) return;
    const int most = count(node->functions, channels);
    const std::string node_key = "node." + std::to_string(place.node_id) + "." + key_of(channels);
    require(place.channel <= most, {key + "channel", node_key}, number(place.channel),
            most == 0 ? say("a node that has such channels: %1 is 0", node_key)
                      : say("a channel in 1 .. %1, as %2 says", most, node_key));
    const auto [first, is_new] = taken_.emplace(std::tuple(place.node_id, channels, place.channel), key);
    require(is_new, {key + "channel", key + "node"}, say("node %1 channel %2", place.node_id, place.channel),
            say("a channel that no other device has: [%1] has it",
                first->second.substr(0, first->second.size() - 1)));
  }

  void sensor(const SensorWiring& s, const std::string& key) {
    require(!s.max31865 || !s.is_thermistor(), {key + "sensor_max31865", key + "sensor"},
            Sentence::verbatim("true"), say("false: that converter measures pt100 and pt1000"));
    if (s.element == SensorElement::kPoints)
      require(falls(s.points_c, s.points_ohm), {key + "sensor_points_ohm", key + "sensor_points_c"},
              say("%1 at %2 C", listed(s.points_ohm), listed(s.points_c)),
              say("a resistance that falls all the way as it gets hotter"));
  }

  /// What a heat node can be told.
  void wiring(const HeaterDescription& h, const std::string& key) {
    const double limit = h.wiring.limit_for(h.max_c), highest = h.wiring.sensor.highest_c();
    sensor(h.wiring.sensor, key);
    // Hotter, what it tells is worth nothing: neither is a limit there.
    require(limit <= highest, {key + (h.wiring.limit_c > 0 ? "limit_c" : "max_c"), key + "sensor"},
            Sentence::verbatim(printed("%.6g", h.wiring.limit_c > 0 ? limit : h.max_c)),
            h.wiring.limit_c > 0
                ? say("at most %1, which its sensor is made for", printed("%.6g", highest))
                : say("at most %1: with limit_c, %2 above it, its sensor is made for no more",
                      printed("%.6g", highest - HeaterWiring::kDefaultMargin_c),
                      printed("%.6g", HeaterWiring::kDefaultMargin_c)));
    constexpr double kHighestLimit_c = 550;
    require(h.max_c + HeaterWiring::kLeastMargin_c <= limit && limit <= kHighestLimit_c,
            {key + "max_c", key + "limit_c"}, Sentence::verbatim(printed("%.6g", h.max_c)),
            say("at least %1 below limit_c, which is at most %2",
                printed("%.6g", HeaterWiring::kLeastMargin_c), printed("%.6g", kHighestLimit_c)));
    require(h.wiring.safe_c <= h.max_c, {key + "safe_c"},
            Sentence::verbatim(printed("%.6g", h.wiring.safe_c)), say("at most max_c"));
    if (h.wiring.fan_channel != 0)
      place({h.place.where, h.place.node_id, h.wiring.fan_channel}, key + "fan_", Channels::kOutputs);
  }

  void filament(const FilamentSensorDescription& f, const std::string& key) {
    place(f.place, key, Channels::kFilaments);
    if (f.kind != FilamentSensorKind::kMotion) return;
    const auto least = [&](const char* which, double mm, double edges) {
      require(mm >= edges * f.mm_per_edge, {key + which, key + "mm_per_edge"},
              Sentence::verbatim(printed("%.6g", mm)),
              say("at least %1, %2 edges", printed("%.6g", edges * f.mm_per_edge), printed("%.6g", edges)));
    };
    least("stands_mm", f.stands_mm, FilamentSensorDescription::kLeastEdges);
    least("slips_mm", f.slips_mm, FilamentSensorDescription::kLeastSlipEdges);
  }

  /// It has a node id of its own, also when it shares a chip with axes; its inputs are the heaters' first.
  void heat_node(const NodeDescription& node) {
    const std::string key = "node." + std::to_string(node.id) + ".";
    const NodeFunctions& has = node.functions;
    require(!has.has_axes(), {key + "axis_pairs"}, number(has.axis_pairs),
            say("0 of a node that carries heat"));
    require(has.heaters <= kHeatNodeHeaters, {key + "heaters"}, number(has.heaters),
            say("at most %1 on a heat node", kHeatNodeHeaters));
    require(has.heaters + has.sensors <= kHeatNodeSensors, {key + "sensors"}, number(has.sensors),
            say("at most %1 on a heat node, with those of the heaters", kHeatNodeSensors));
    require(has.outputs <= kHeatNodeOutputs, {key + "outputs"}, number(has.outputs),
            say("at most %1 on a heat node", kHeatNodeOutputs));
    require(has.filament_sensors <= kHeatNodeFilaments, {key + "filament_sensors"},
            number(has.filament_sensors), say("at most %1 on a heat node", kHeatNodeFilaments));
  }

  void inputs(const NodeDescription& node) {
    const std::string key = "node." + std::to_string(node.id) + ".";
    for (std::size_t i = 0; i < node.inputs.size(); ++i) {
      if (node.inputs[i].function == InputFunction::kNone) continue;
      const std::string input = key + "input" + std::to_string(i + 1);
      require(i < node.functions.inputs, {input, key + "inputs"}, say("a function"),
              say("an input that the node has: %1 is %2", key + "inputs", int{node.functions.inputs}));
      const bool of_axis = node.inputs[i].function == InputFunction::kHome ||
                           node.inputs[i].function == InputFunction::kPositiveLimit ||
                           node.inputs[i].function == InputFunction::kNegativeLimit;
      require(!of_axis || node.functions.has_axes(), {input + ".function", key + "axis_pairs"},
              say("a switch of an axis"), say("none, emergency_stop or probe: this node has no axes"));
    }
  }

  void axes(const JointDescription& joint) {
    const NodeDescription* node = d_.node(joint.node_id);
    if (node == nullptr) return;
    require(node->functions.has_axes(),
            {"joint." + joint.name + ".node", "node." + std::to_string(joint.node_id) + ".axis_pairs"},
            number(joint.node_id), say("a node that has axes: node.%1.axis_pairs is 0", joint.node_id));
  }

  /// TPDO1 of a node with axes tells of it.
  void input(const InputDescription& i) {
    const NodeDescription* node = i.place.on_node() ? d_.node(i.place.node_id) : nullptr;
    if (node == nullptr || i.place.channel > kNodeInputs) return;
    const std::string key = "input." + i.name + ".";
    const std::string of_node = "node." + std::to_string(i.place.node_id) + ".";
    const std::string function = of_node + "input" + std::to_string(i.place.channel) + ".function";
    require(node->functions.has_axes(), {key + "node", of_node + "axis_pairs"}, number(i.place.node_id),
            say("a node that has axes: it tells when an input changes"));
    require(
        node->inputs[i.place.channel - 1u].function == InputFunction::kNone, {key + "channel", function},
        number(i.place.channel),
        say("an input of node %1 whose function is none: a switch, a stop or a probe is not a job's to read",
            i.place.node_id));
  }

  void probe() {
    const DevicePlace& at = d_.probe.place;
    place(at, "probe.", Channels::kInputs);
    const NodeDescription* node = at.on_node() ? d_.node(at.node_id) : nullptr;
    if (node == nullptr || at.channel > kNodeInputs) return;
    const std::string input = "node." + std::to_string(at.node_id) + ".input" + std::to_string(at.channel);
    require(node->inputs[at.channel - 1u].function == InputFunction::kProbe,
            {"probe.channel", input + ".function"}, number(at.channel),
            say("an input of node %1 that has the probe function", at.node_id));
    require(node->functions.has_axes(), {"probe.node", "node." + std::to_string(at.node_id) + ".axis_pairs"},
            number(at.node_id), say("a node that has axes: it latches where they were"));
  }

  void bltouch() {
    require(d_.probe.present && d_.probe.place.on_node(), {"bltouch", "probe.where"}, say("a pin"),
            say("a probe on an input of a node, [probe] with where = \"node\": its line"));
    const std::uint8_t id = d_.probe.servo_node;
    // That it has no axes is a rule of every heat node.
    require(d_.node(id) != nullptr, {"bltouch.node"}, number(id),
            say("a heat node that has its table, [node.%1], with axis_pairs = 0", id));
  }

  const MachineDescription& d_;
  std::vector<BrokenRule>& broken_;
  std::map<std::tuple<std::uint8_t, Channels, std::uint8_t>, std::string> taken_;
};

}  // namespace

void judge_devices(const MachineDescription& description, std::vector<BrokenRule>& broken) {
  DeviceRules(description, broken).judge();
}

}  // namespace kinebus
