#include "gateway/devices/devices.hpp"

#include <algorithm>

namespace kinebus {

Sentence sentence(FilamentCondition condition) {
  switch (condition) {
    case FilamentCondition::kOut:
      return say("there is no filament any more");
    case FilamentCondition::kStands:
      return say("the extruder turns and the filament stands still");
    case FilamentCondition::kSlips:
      return say("less filament comes than the extruder turns for");
    case FilamentCondition::kInOrder:
      break;
  }
  return {};
}

void Devices::add(HeaterId id, std::string name, std::uint8_t node, std::unique_ptr<Heater> heater) {
  members_.push_back({"heater." + name, node, heater.get(), true});
  heaters_.push_back({id, std::move(name), std::move(heater)});
}

void Devices::add_fan(DeviceName name, std::uint8_t node, std::unique_ptr<Output> fan) {
  members_.push_back({"fan." + name.name, node, fan.get()});
  fans_.push_back({std::move(name), std::move(fan)});
}

void Devices::add_output(DeviceName name, std::uint8_t node, std::unique_ptr<Output> output) {
  members_.push_back({"output." + name.name, node, output.get()});
  outputs_.push_back({std::move(name), std::move(output)});
}

void Devices::add_input(DeviceName name, std::uint8_t node, std::unique_ptr<Input> input) {
  members_.push_back({"input." + name.name, node, input.get()});
  inputs_.push_back({std::move(name), std::move(input)});
}

void Devices::add_sensor(std::string name, std::uint8_t node, std::unique_ptr<Sensor> sensor) {
  members_.push_back({"sensor." + name, node, sensor.get()});
  sensors_.push_back({std::move(name), std::move(sensor)});
}

void Devices::add_filament_sensor(std::string name, std::uint8_t node,
                                  std::unique_ptr<FilamentSensor> sensor) {
  members_.push_back({"filament_sensor." + name, node, sensor.get()});
  filaments_.push_back({std::move(name), node, std::move(sensor)});
}

void Devices::add_node(std::uint8_t node, std::shared_ptr<Device> shared) {
  members_.push_back({"node." + std::to_string(node), node, shared.get()});
  nodes_.push_back(std::move(shared));
}

void Devices::set_spindle(std::uint8_t node, std::unique_ptr<SpindleDrive> spindle) {
  members_.push_back({"spindle", node, spindle.get()});
  spindle_ = std::move(spindle);
}

void Devices::set_probe(std::uint8_t node, std::unique_ptr<ContactProbe> probe) {
  members_.push_back({"probe", node, probe.get()});
  probe_ = std::move(probe);
}

void Devices::set_accelerometer(std::uint8_t node, std::unique_ptr<VibrationSensor> accelerometer) {
  members_.push_back({"accelerometer", node, accelerometer.get()});
  accelerometer_ = std::move(accelerometer);
}

Heater* Devices::find(HeaterId id) const {
  for (const KnownHeater& known : heaters_)
    if (known.id == id) return known.heater.get();
  return nullptr;
}

void Devices::heat(HeaterId id, double celsius) {
  if (Heater* known = find(id)) known->set_target(celsius);
}

std::optional<Sentence> Devices::cannot_tune(HeaterId id) const {
  const Heater* known = find(id);
  return known != nullptr ? known->cannot_tune() : std::nullopt;
}

void Devices::tune(HeaterId id, double celsius) {
  if (Heater* known = find(id)) known->tune(celsius);
}

HeaterTuning Devices::tuning(HeaterId id) const {
  const Heater* known = find(id);
  return known != nullptr ? known->tuning() : HeaterTuning{};
}

void Devices::feed_ahead(HeaterId id, const FlowAhead& watts) {
  if (Heater* known = find(id)) known->feed_ahead(watts);
}

void Devices::heaters_off() {
  for (KnownHeater& known : heaters_) known.heater->set_target(0);
}

Output* Devices::find(const std::vector<KnownOutput>& all, std::uint8_t index) {
  for (const KnownOutput& known : all)
    if (known.name.index == index) return known.output.get();
  return nullptr;
}

void Devices::blow(std::uint8_t fan, double ratio) {
  if (Output* known = find(fans_, fan)) known->set(ratio);
}

void Devices::put_out(std::uint8_t output, double ratio) {
  if (Output* known = find(outputs_, output)) known->set(ratio);
}

void Devices::turn_spindle(double rpm) {
  if (spindle_) spindle_->set(rpm);
}

void Devices::follow_extruder(double mm) {
  for (KnownFilament& known : filaments_) known.sensor->follow(mm);
}

HeaterStatus Devices::heater(HeaterId id) const {
  const Heater* known = find(id);
  return known != nullptr ? known->status() : HeaterStatus{};
}

double Devices::ratio(const std::vector<KnownOutput>& all, std::uint8_t index) {
  const Output* known = find(all, index);
  return known != nullptr ? known->ratio() : 0;
}

std::vector<NamedHeaterStatus> Devices::heaters() const {
  std::vector<NamedHeaterStatus> all;
  for (const KnownHeater& known : heaters_)
    all.push_back({known.heater->status(), known.name, known.id, known.heater->tuning()});
  return all;
}

std::vector<OutputStatus> Devices::ratios(const std::vector<KnownOutput>& all) {
  std::vector<OutputStatus> told;
  told.reserve(all.size());
  for (const KnownOutput& known : all)
    told.push_back({known.name.name, known.name.index, known.output->ratio()});
  return told;
}

const Input* Devices::input(std::uint8_t index) const {
  for (const KnownInput& known : inputs_)
    if (known.name.index == index) return known.input.get();
  return nullptr;
}

std::vector<InputStatus> Devices::inputs() const {
  std::vector<InputStatus> all;
  all.reserve(inputs_.size());
  for (const KnownInput& known : inputs_)
    all.push_back({known.name.name, known.name.index, known.input->level()});
  return all;
}

std::vector<SensorStatus> Devices::sensors() const {
  std::vector<SensorStatus> all;
  for (const KnownSensor& known : sensors_) all.push_back({known.name, known.sensor->celsius()});
  return all;
}

std::vector<FilamentStatus> Devices::filaments() const {
  std::vector<FilamentStatus> all;
  for (const KnownFilament& known : filaments_) all.push_back({known.name, known.sensor->condition()});
  return all;
}

std::optional<DeviceFault> Devices::filament_trouble() const {
  for (const KnownFilament& known : filaments_)
    if (const auto condition = known.sensor->condition(); condition != FilamentCondition::kInOrder)
      return DeviceFault{"filament_sensor." + known.name, known.node, sentence(condition), false, true};
  return std::nullopt;
}

std::optional<DeviceFault> Devices::fault() const {
  for (const Member& member : members_)
    if (auto words = member.device->fault())
      return DeviceFault{member.key, member.node, std::move(*words), member.heater};
  return std::nullopt;
}

std::optional<DeviceFault> Devices::new_fault() {
  for (Member& member : members_) {
    auto words = member.device->fault();
    if (const bool told = std::exchange(member.told, words.has_value()); words && !told)
      return DeviceFault{member.key, member.node, std::move(*words), member.heater};
  }
  return std::nullopt;
}

void Devices::clear_faults() {
  for (const Member& member : members_) member.device->clear_fault();
}

std::optional<Sentence> Devices::absent(HeaterId id) const {
  const Heater* known = find(id);
  return known != nullptr ? known->absent() : std::nullopt;
}

std::optional<Sentence> Devices::heater_fault(HeaterId id) const {
  const Heater* known = find(id);
  return known != nullptr ? known->fault() : std::nullopt;
}

void Devices::on_bring_up(BusTime now, bool done) {
  for (const Member& member : members_) member.device->on_bring_up(now, done);
}

bool Devices::on_frame(BusTime now, const CanFrame& frame) {
  bool taken = false;
  for (const Member& member : members_) taken = member.device->on_frame(now, frame) || taken;
  return taken;
}

void Devices::on_time(BusTime now) {
  for (const Member& member : members_) member.device->on_time(now);
}

std::optional<CanFrame> Devices::next_frame(BusTime now) {
  for (const Member& member : members_)
    if (const auto frame = member.device->next_frame(now)) return frame;
  return std::nullopt;
}

BusTime Devices::next_deadline() const {
  BusTime due = BusTime::max();
  for (const Member& member : members_) due = std::min(due, member.device->next_deadline());
  return due;
}

}  // namespace kinebus
