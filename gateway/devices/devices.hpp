#pragma once
// All devices of a machine together: found by kind and index, served as one.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gateway/devices/device.hpp"

namespace kinebus {

/// As the machine file has named and numbered it.
struct DeviceName {
  std::string name;
  std::uint8_t index = 0;
};
struct NamedHeaterStatus : HeaterStatus {
  std::string name;
  HeaterId id;
  HeaterTuning tuning{};
};
struct OutputStatus {
  std::string name;
  std::uint8_t index = 0;
  double ratio = 0;  ///< 0..1
};
struct InputStatus {
  std::string name;
  std::uint8_t index = 0;
  InputLevel level{};
};
struct SensorStatus {
  std::string name;
  double celsius = 0;
};
struct FilamentStatus {
  std::string name;
  FilamentCondition condition = FilamentCondition::kInOrder;
};
/// What is wrong; empty: nothing is.
Sentence sentence(FilamentCondition condition);
struct DeviceFault {
  std::string device;  ///< "heater.bed", as the machine file says
  std::uint8_t node = 0;
  Sentence words;
  bool heater = false;
  bool filament = false;
  bool cold = false;  ///< in order, and not hot enough for what is to be fed
};

class Devices {
 public:
  void add(HeaterId id, std::string name, std::uint8_t node, std::unique_ptr<Heater> heater);
  void add_fan(DeviceName name, std::uint8_t node, std::unique_ptr<Output> fan);
  void add_output(DeviceName name, std::uint8_t node, std::unique_ptr<Output> output);
  void add_input(DeviceName name, std::uint8_t node, std::unique_ptr<Input> input);
  void add_sensor(std::string name, std::uint8_t node, std::unique_ptr<Sensor> sensor);
  void add_filament_sensor(std::string name, std::uint8_t node, std::unique_ptr<FilamentSensor> sensor);
  /// What several of the others live on. Before them.
  void add_node(std::uint8_t node, std::shared_ptr<Device> shared);
  void set_spindle(std::uint8_t node, std::unique_ptr<SpindleDrive> spindle);
  void set_probe(std::uint8_t node, std::unique_ptr<ContactProbe> probe);
  void set_accelerometer(std::uint8_t node, std::unique_ptr<VibrationSensor> accelerometer);

  // Commands. One for a device that is not there has no effect: whether it is, is asked of the description.
  void heat(HeaterId id, double celsius);  ///< 0: off
  void heaters_off();
  /// As Heater's.
  std::optional<Sentence> cannot_tune(HeaterId id) const;
  void tune(HeaterId id, double celsius);
  HeaterTuning tuning(HeaterId id) const;
  void feed_ahead(HeaterId id, const FlowAhead& watts);
  void blow(std::uint8_t fan, double ratio);
  void put_out(std::uint8_t output, double ratio);
  void turn_spindle(double rpm);
  void follow_extruder(double mm);

  // What they say. Cold, off and at rest when there is none.
  HeaterStatus heater(HeaterId id) const;
  double fan(std::uint8_t index) const { return ratio(fans_, index); }
  double output(std::uint8_t index) const { return ratio(outputs_, index); }
  const Input* input(std::uint8_t index) const;  ///< nullptr: there is none
  SpindleStatus spindle() const { return spindle_ ? spindle_->status() : SpindleStatus{}; }
  ContactProbe* probe() { return probe_.get(); }                     ///< nullptr: there is none
  VibrationSensor* accelerometer() { return accelerometer_.get(); }  ///< nullptr: there is none
  bool probe_touches() const { return probe_ && probe_->touches(); }
  std::vector<NamedHeaterStatus> heaters() const;
  std::vector<OutputStatus> fans() const { return ratios(fans_); }
  std::vector<OutputStatus> outputs() const { return ratios(outputs_); }
  std::vector<InputStatus> inputs() const;
  std::vector<SensorStatus> sensors() const;
  std::vector<FilamentStatus> filaments() const;
  /// Of the first sensor that has something to say of its filament.
  std::optional<DeviceFault> filament_trouble() const;
  /// Of the first that is out of order.
  std::optional<DeviceFault> fault() const;
  /// Of one that has come to be out of order: each is told once, until it is in order again.
  std::optional<DeviceFault> new_fault();
  void clear_faults();
  /// Why this heater cannot be told anything now; none: it can.
  std::optional<Sentence> absent(HeaterId id) const;
  std::optional<Sentence> heater_fault(HeaterId id) const;

  // Sans-IO, as of every device.
  bool on_frame(BusTime now, const CanFrame& frame);
  void on_time(BusTime now);
  void on_bring_up(BusTime now, bool done);
  std::optional<CanFrame> next_frame(BusTime now);
  BusTime next_deadline() const;

 private:
  struct Member {
    std::string key;
    std::uint8_t node;
    Device* device;
    bool heater = false;
    bool told = false;  ///< that it is out of order
  };
  struct KnownHeater {
    HeaterId id;
    std::string name;
    std::unique_ptr<Heater> heater;
  };
  struct KnownOutput {
    DeviceName name;
    std::unique_ptr<Output> output;
  };
  struct KnownInput {
    DeviceName name;
    std::unique_ptr<Input> input;
  };
  struct KnownSensor {
    std::string name;
    std::unique_ptr<Sensor> sensor;
  };
  struct KnownFilament {
    std::string name;
    std::uint8_t node;
    std::unique_ptr<FilamentSensor> sensor;
  };
  static std::vector<OutputStatus> ratios(const std::vector<KnownOutput>& all);
  static double ratio(const std::vector<KnownOutput>& all, std::uint8_t index);
  Heater* find(HeaterId id) const;
  static Output* find(const std::vector<KnownOutput>& all, std::uint8_t index);

  std::vector<Member> members_;  ///< all of them, as they were added
  std::vector<std::shared_ptr<Device>> nodes_;
  std::vector<KnownHeater> heaters_;
  std::vector<KnownOutput> fans_, outputs_;
  std::vector<KnownInput> inputs_;
  std::vector<KnownSensor> sensors_;
  std::vector<KnownFilament> filaments_;
  std::unique_ptr<SpindleDrive> spindle_;
  std::unique_ptr<ContactProbe> probe_;
  std::unique_ptr<VibrationSensor> accelerometer_;
};

}  // namespace kinebus
