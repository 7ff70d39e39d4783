#include "gateway/devices/heat_node_devices.hpp"

#include <algorithm>
#include <utility>

namespace kinebus {
namespace {

class NodeHeater : public Heater {
 public:
  NodeHeater(std::shared_ptr<HeatNodeLink> node, std::size_t channel, double power_w)
      : node_(std::move(node)), channel_(channel), power_w_(power_w) {}
  void set_target(double celsius) override { node_->set_target(channel_, celsius); }
  HeaterStatus status() const override { return node_->status(channel_); }
  std::optional<Sentence> fault() const override { return node_->heater_fault(channel_); }
  std::optional<Sentence> absent() const override { return node_->absent(); }
  void clear_fault() override { node_->reset_fault(channel_); }
  std::optional<Sentence> cannot_tune() const override { return std::nullopt; }
  void tune(double celsius) override { node_->tune(channel_, celsius, power_w_); }
  HeaterTuning tuning() const override { return node_->tuning(channel_); }
  void feed_ahead(const FlowAhead& watts) override { node_->feed_ahead(channel_, watts); }

 private:
  std::shared_ptr<HeatNodeLink> node_;
  std::size_t channel_;
  double power_w_;
};

class HeatNodeOutput : public Output {
 public:
  HeatNodeOutput(std::shared_ptr<HeatNodeLink> node, std::size_t channel)
      : node_(std::move(node)), channel_(channel) {}
  void set(double ratio) override { node_->set_output(channel_, ratio); }
  double ratio() const override { return node_->output(channel_); }

 private:
  std::shared_ptr<HeatNodeLink> node_;
  std::size_t channel_;
};

class NodeSensor : public Sensor {
 public:
  NodeSensor(std::shared_ptr<HeatNodeLink> node, std::size_t input) : node_(std::move(node)), input_(input) {}
  double celsius() const override { return node_->celsius(input_); }

 private:
  std::shared_ptr<HeatNodeLink> node_;
  std::size_t input_;
};

class NodeFilament : public FilamentSensor {
 public:
  NodeFilament(std::shared_ptr<HeatNodeLink> node, std::size_t channel, bool follows)
      : node_(std::move(node)), channel_(channel), follows_(follows) {}
  FilamentCondition condition() const override { return node_->filament(channel_); }
  void follow(double mm) override {
    if (follows_) node_->follow_extruder(mm);
  }
  void clear_fault() override { node_->reset_filament(channel_); }

 private:
  std::shared_ptr<HeatNodeLink> node_;
  std::size_t channel_;
  bool follows_;
};

class NodeAccelerometer : public VibrationSensor {
 public:
  explicit NodeAccelerometer(std::shared_ptr<HeatNodeLink> node) : node_(std::move(node)) {}
  std::optional<Sentence> absent() const override { return node_->absent(); }
  void begin() override { node_->begin_vibration(); }
  void end() override { node_->end_vibration(); }
  const VibrationFound& found() const override { return node_->vibration(); }

 private:
  std::shared_ptr<HeatNodeLink> node_;
};

/// `first`: the number of the first channel on the node. `more`: what else it is made of.
template <typename Made, typename Interface, typename... More>
std::unique_ptr<Interface> make(const DevicePlace& place, std::size_t first, std::size_t count,
                                const HeatNodeLinks& links, More... more) {
  const auto link = links.find(place.node_id);
  const std::size_t channel = first + place.channel - 1u;
  if (link == links.end() || place.channel == 0 || channel >= count) return nullptr;
  return std::make_unique<Made>(link->second, channel, more...);
}

}  // namespace

HeatNodeLinks heat_node_links(const MachineDescription& machine) {
  HeatNodeLinks links;
  for (const NodeDescription& node : machine.nodes)
    if (!node.functions.has_axes() && machine.carries_heat(node.id)) {
      links[node.id] = std::make_shared<HeatNodeLink>(
          node.id,
          std::all_of(machine.fans.begin(), machine.fans.end(),
                      [&](const FanDescription& fan) {
                        return fan.place.where == DevicePlace::Where::kNode && fan.place.node_id == node.id;
                      }),
          machine.accelerometer.directions());
      if (machine.hotends_on(node.id) > 1) links[node.id]->let_several_melt();
    }
  return links;
}

std::unique_ptr<Heater> on_heat_node(const HeaterDescription& heater, const MachineDescription&,
                                     const HeatNodeLinks& links) {
  return make<NodeHeater, Heater>(heater.place, 0, kHeaters, links, heater.wiring.power_w);
}

std::unique_ptr<Output> on_heat_node(const FanDescription& fan, const MachineDescription&,
                                     const HeatNodeLinks& links) {
  return make<HeatNodeOutput, Output>(fan.place, 0, kFans, links);
}

std::unique_ptr<Output> on_heat_node(const OutputDescription& output, const MachineDescription&,
                                     const HeatNodeLinks& links) {
  return make<HeatNodeOutput, Output>(output.place, 0, kFans, links);
}

/// Inputs of a node are its heaters' first.
std::unique_ptr<Sensor> on_heat_node(const SensorDescription& sensor, const MachineDescription& machine,
                                     const HeatNodeLinks& links) {
  const NodeDescription* node = machine.node(sensor.place.node_id);
  const std::size_t heaters = node != nullptr ? node->functions.heaters : 0;
  return make<NodeSensor, Sensor>(sensor.place, heaters, kHeatSensors, links);
}

std::unique_ptr<FilamentSensor> on_heat_node(const FilamentSensorDescription& sensor,
                                             const MachineDescription&, const HeatNodeLinks& links) {
  return make<NodeFilament, FilamentSensor>(sensor.place, 0, kFilamentSensors, links,
                                            sensor.kind == FilamentSensorKind::kMotion);
}

std::unique_ptr<VibrationSensor> on_heat_node(const AccelerometerDescription& accelerometer,
                                              const HeatNodeLinks& links) {
  const auto link = links.find(accelerometer.node);
  return link == links.end() ? nullptr : std::make_unique<NodeAccelerometer>(link->second);
}

}  // namespace kinebus
