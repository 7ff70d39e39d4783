#include "gateway/devices/registry.hpp"

#include <utility>

#include "gateway/devices/bltouch.hpp"
#include "gateway/devices/heat_node_devices.hpp"
#include "gateway/devices/node_input.hpp"
#include "gateway/devices/node_probe.hpp"
#include "gateway/devices/simulated.hpp"

namespace kinebus {
namespace {

using Where = DevicePlace::Where;

template <typename Interface, typename Description>
struct Implementation {
  Where where;
  std::unique_ptr<Interface> (*make)(const Description&, const MachineDescription&) = nullptr;
  std::unique_ptr<Interface> (*on_heat_node)(const Description&, const MachineDescription&,
                                             const HeatNodeLinks&) = nullptr;
};

// One line for each implementation.
constexpr Implementation<Heater, HeaterDescription> kHeaterMakers[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, on_heat_node},
};
constexpr Implementation<Output, FanDescription> kFanMakers[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, on_heat_node},
};
constexpr Implementation<Output, OutputDescription> kOutputs[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, on_heat_node},
};
constexpr Implementation<Input, InputDescription> kInputs[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, node_input},
};
constexpr Implementation<Sensor, SensorDescription> kSensors[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, on_heat_node},
};
constexpr Implementation<FilamentSensor, FilamentSensorDescription> kFilaments[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, on_heat_node},
};
constexpr Implementation<SpindleDrive, SpindleDescription> kSpindles[] = {{Where::kSimulated, simulate}};
/// nullptr: it has a pin, and what moves that is no heat node.
std::unique_ptr<ContactProbe> contact_probe(const ProbeDescription& probe, const MachineDescription& machine,
                                            const HeatNodeLinks& links) {
  auto contact = node_probe(probe, machine);
  if (!probe.bltouch) return contact;
  const auto link = links.find(probe.servo_node);
  if (link == links.end()) return nullptr;
  return std::make_unique<BltouchProbe>(std::move(contact), link->second);
}

constexpr Implementation<ContactProbe, ProbeDescription> kProbes[] = {
    {Where::kSimulated, simulate},
    {Where::kNode, nullptr, contact_probe},
};

class Maker {
 public:
  explicit Maker(const MachineDescription& machine)
      : machine_(machine), heat_nodes_(heat_node_links(machine)) {}

  const HeatNodeLinks& heat_nodes() const { return heat_nodes_; }

  /// nullptr: nobody stands behind it, and wrong() says so.
  template <typename Interface, typename Description, std::size_t N>
  std::unique_ptr<Interface> make(const Implementation<Interface, Description> (&known)[N],
                                  const Description& description, const std::string& key) {
    for (const auto& implementation : known) {
      if (implementation.where != description.place.where) continue;
      auto made = implementation.make != nullptr
                      ? implementation.make(description, machine_)
                      : implementation.on_heat_node(description, machine_, heat_nodes_);
      if (made) return made;
    }
    if (wrong_.empty())
      wrong_ =
          say("%1 is to live on node %2, where this gateway knows no such device: use where = \"simulated\"",
              key, description.place.node_id);
    return nullptr;
  }
  const Sentence& wrong() const { return wrong_; }

 private:
  const MachineDescription& machine_;
  HeatNodeLinks heat_nodes_;
  Sentence wrong_;
};

}  // namespace

Result<Devices, Sentence> make_devices(const MachineDescription& machine) {
  Devices devices;
  Maker maker(machine);
  for (const auto& [id, link] : maker.heat_nodes()) devices.add_node(id, link);
  for (const HeaterDescription& h : machine.heaters)
    if (auto heater = maker.make(kHeaterMakers, h, "heater." + h.name))
      devices.add(h.id(), h.name, h.place.node_id, std::move(heater));
  for (const FanDescription& f : machine.fans)
    if (auto fan = maker.make(kFanMakers, f, "fan." + f.name))
      devices.add_fan({f.name, f.index}, f.place.node_id, std::move(fan));
  for (const OutputDescription& o : machine.outputs)
    if (auto output = maker.make(kOutputs, o, "output." + o.name))
      devices.add_output({o.name, o.index}, o.place.node_id, std::move(output));
  for (const InputDescription& i : machine.inputs)
    if (auto input = maker.make(kInputs, i, "input." + i.name))
      devices.add_input({i.name, i.index}, i.place.node_id, std::move(input));
  for (const SensorDescription& s : machine.sensors)
    if (auto sensor = maker.make(kSensors, s, "sensor." + s.name))
      devices.add_sensor(s.name, s.place.node_id, std::move(sensor));
  for (const FilamentSensorDescription& f : machine.filament_sensors)
    if (auto sensor = maker.make(kFilaments, f, "filament_sensor." + f.name))
      devices.add_filament_sensor(f.name, f.place.node_id, std::move(sensor));
  if (machine.spindle.present)
    if (auto spindle = maker.make(kSpindles, machine.spindle, "spindle"))
      devices.set_spindle(machine.spindle.place.node_id, std::move(spindle));
  if (machine.probe.present)
    if (auto probe = maker.make(kProbes, machine.probe, "probe"))
      devices.set_probe(machine.probe.place.node_id, std::move(probe));
  if (machine.accelerometer.present)
    if (auto accelerometer = on_heat_node(machine.accelerometer, maker.heat_nodes()))
      devices.set_accelerometer(machine.accelerometer.node, std::move(accelerometer));
  if (!maker.wrong().empty()) return Error<Sentence>(maker.wrong());
  return devices;
}

}  // namespace kinebus
