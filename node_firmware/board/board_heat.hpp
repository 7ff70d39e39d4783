#pragma once
// A board's heat node: its core, what it wants to hear, samples in and power out. It has a place of its own
// in the board's program, behind the same CAN controller as the axis pairs, if there are any, and the id that
// follows theirs.

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <span>
#include <utility>

#include "node_firmware/board/hearing.hpp"
#include "node_firmware/board/pulsed_output.hpp"
#include "node_firmware/heat/heat_node.hpp"

namespace kinebus {

/// What a board has of heat.
template <typename T>
concept HeatDriver = requires(T& driver, int number, bool on) {
  { T::kSensors } -> std::convertible_to<int>;
  { T::kHeaters } -> std::convertible_to<int>;
  { T::kFans } -> std::convertible_to<int>;
  requires T::kSensors <= kHeatSensors&& T::kHeaters <= kHeaters&& T::kFans <= kFans;
  // Inputs of the board (SwitchEdge) that are the node's filament sensors.
  { T::kFilamentInputs } -> std::convertible_to<std::array<std::uint8_t, kFilamentSensors>>;
  // The input that is the line of a probe with a pin, too.
  { T::kProbeInput } -> std::convertible_to<std::uint8_t>;
  // The sum of several conversions since the last call, as parts of kFullRatio; nullopt: the converter
  // stands.
  { driver.take_ratio(number) } -> std::same_as<std::optional<std::uint32_t>>;
  driver.set_heater(number, on);
  driver.set_fan(number, on);
  driver.set_contactor(on);
  driver.set_servo(std::uint16_t{});
};

/// A board without.
struct NoHeat {
  static bool due(LocalTime) { return false; }
  static void on_frame(LocalTime, const CanFrame&) {}
  static void on_edge(std::uint8_t, bool) {}
  static void serve(LocalTime) {}
  static void drive(LocalTime) {}
  static bool renew_hearing(LocalTime) { return false; }
  static void find_due() {}
  static std::optional<CanFrame> next_frame() { return std::nullopt; }
  static std::span<const CanAccept> accepted() { return {}; }
  static bool healthy(LocalTime) { return true; }
  static bool stop_requested() { return false; }
  static constexpr std::size_t kNodes = 0;
};

template <HeatDriver Driver>
class BoardHeat {
 public:
  static constexpr std::size_t kNodes = 1;

  /// With this id from now on; set points and faults begin anew.
  void begin(const heat::HeatNodeOptions& options, LocalTime now, std::span<const std::uint8_t> stored) {
    heat::HeatNodeOptions of_this_board = options;
    of_this_board.max31865 = kMax31865Sensors;
    node_.emplace(of_this_board, now, stored);
    if constexpr (kMeasuresVibration)
      if (auto* chip = driver_.accelerometer()) node_->set_vibration(&chip->unit());
    next_sample_ = hearing_due_ = now;
    touched_ = true;
  }
  void end() {
    node_.reset();
    all_off();
  }
  bool there() const { return node_.has_value(); }
  std::uint8_t node_id() const { return node_ ? node_->node_id() : std::uint8_t{0}; }
  bool stop_requested() const { return node_ && node_->program_stop_requested(); }
  /// Something has power or is to have it: the processor must not stand still.
  bool heats() const { return node_ && node_->heats(); }
  /// Another node of the board has power: flash is not written then.
  void set_neighbours_powered(bool powered) {
    if (node_) node_->set_neighbours_powered(powered);
  }
  Driver& driver() { return driver_; }

  bool due(LocalTime now) const {
    return node_ && (touched_ || now >= due_ || now >= next_sample_ || now >= hearing_due_ || feels(now));
  }
  void on_frame(LocalTime at, const CanFrame& frame) {
    if (!node_ || !hearing_.hears(frame)) return;
    node_->on_frame(at, frame);
    touched_ = true;
    // At once: the frame may have come after this pass began, and its answer goes out in this pass.
    if (frame.id == cob_id::kSdoRequest + node_->node_id()) hearing_due_ = {};
  }
  /// Of an input of the board.
  void on_edge(std::uint8_t input, bool level) {
    if (input == Driver::kProbeInput) probe_line_ = level;
    for (std::size_t i = 0; i < Driver::kFilamentInputs.size(); ++i) {
      if (Driver::kFilamentInputs[i] != input) continue;
      filament_[i].level = level;
      ++filament_[i].edges;
    }
  }
  void serve(LocalTime now) {
    if (!node_) return;
    // Before the node looks at the time: a loop that was held up has not lost a sensor.
    if (now >= next_sample_) sample(now);
    if constexpr (kMeasuresVibration)
      if (feels(now)) driver_.accelerometer()->serve(now);
    // A frame has seen to what was due, and what it has left to do may take a while.
    if (!std::exchange(touched_, false) && now >= node_->next_deadline()) node_->on_time(now);
  }
  /// Every pass: what the outputs are to do now.
  void drive(LocalTime now) {
    if (!node_) return;
    for (int i = 0; i < Driver::kHeaters; ++i) {
      const auto n = static_cast<std::size_t>(i);
      driver_.set_heater(i, heaters_[n].step(now, node_->heater_output(i), heat::kFullPower));
    }
    for (int i = 0; i < Driver::kFans; ++i)
      driver_.set_fan(i, fans_[static_cast<std::size_t>(i)].step(now, node_->fan_output(i), heat::kFullFan));
    driver_.set_contactor(node_->contactor());
    driver_.set_servo(node_->servo_pulse());
  }
  bool renew_hearing(LocalTime now) {
    if (!node_ || now < hearing_due_) return false;
    hearing_due_ = now + kHearingPeriod;
    return hearing_.renew(*node_);
  }
  void find_due() {
    if (node_) due_ = node_->next_deadline();
  }
  std::optional<CanFrame> next_frame() { return node_ ? node_->next_frame() : std::nullopt; }
  std::span<const CanAccept> accepted() const {
    return node_ ? hearing_.accepted() : std::span<const CanAccept>{};
  }
  bool healthy(LocalTime now) const { return !node_ || node_->healthy(now); }

  /// As store_parameters() for an axis pair. `save(image)`: into flash; heaters are off meanwhile.
  template <typename Watchdog, typename Save>
  void store(Watchdog& dog, Save&& save) {
    if (!node_) return;
    const auto image = node_->image_to_store();
    if (image.empty()) return;
    all_off();
    dog.allow_flash();
    node_->on_image_stored(save(image));
    dog.back_to_normal();
    touched_ = true;
  }

 private:
  /// A board's driver may have an Adxl345.
  static constexpr bool kMeasuresVibration = requires(Driver & driver) { driver.accelerometer(); };
  /// Its accelerometer is due.
  bool feels(LocalTime now) const {
    if constexpr (kMeasuresVibration) {
      const auto* chip = driver_.accelerometer();
      return chip != nullptr && chip->due(now);
    } else {
      return false;
    }
  }
  /// Sensors that may be measured by a MAX31865, a bit each; of those the driver has max31865(sensor).
  static constexpr std::uint8_t kMax31865Sensors = [] {
    if constexpr (requires { Driver::kMax31865Sensors; })
      return Driver::kMax31865Sensors;
    else
      return std::uint8_t{0};
  }();
  std::optional<std::uint32_t> take_ratio(LocalTime now, int sensor) {
    const heat::SensorSetup& setup = node_->setup_of(sensor);
    if (setup.path != heat::SensorPath::kMax31865) return driver_.take_ratio(sensor);
    if constexpr (kMax31865Sensors != 0)
      if (auto* chip = driver_.max31865(sensor)) return chip->take(now, setup.wiring);
    return std::nullopt;
  }
  void sample(LocalTime now) {
    next_sample_ += heat::SensorInput::kSamplePeriod;
    if (next_sample_ <= now) next_sample_ = now + heat::SensorInput::kSamplePeriod;
    for (int i = 0; i < Driver::kSensors; ++i)
      if (const auto ratio = take_ratio(now, i)) node_->on_sample(now, i, *ratio);
    for (std::size_t i = 0; i < filament_.size(); ++i)
      node_->on_filament(static_cast<int>(i), filament_[i].level, std::exchange(filament_[i].edges, 0));
    node_->on_probe_line(now, probe_line_);
  }
  void all_off() {
    for (int i = 0; i < Driver::kHeaters; ++i) driver_.set_heater(i, false);
    for (int i = 0; i < Driver::kFans; ++i) driver_.set_fan(i, false);
    driver_.set_servo(0);
  }

  static constexpr LocalTime kHearingPeriod = std::chrono::milliseconds{10};
  // 40 ms a period at half power: slow for the switches and their supply, fast against every block.
  static constexpr PulsedOutput kHeaterPulse{std::chrono::milliseconds{10}};
  // 8 ms.
  static constexpr PulsedOutput kFanPulse{std::chrono::milliseconds{2}};
  template <std::size_t kCount>
  static constexpr std::array<PulsedOutput, kCount> several(const PulsedOutput& one) {
    return [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
      return std::array<PulsedOutput, kCount>{((void)kIndex, one)...};
    }
    (std::make_index_sequence<kCount>{});
  }

  struct Filament {
    bool level = false;
    std::uint32_t edges = 0;
  };
  Driver driver_;
  std::optional<heat::HeatNode> node_;
  Hearing hearing_;
  std::array<PulsedOutput, Driver::kHeaters> heaters_ = several<Driver::kHeaters>(kHeaterPulse);
  std::array<PulsedOutput, Driver::kFans> fans_ = several<Driver::kFans>(kFanPulse);
  std::array<Filament, kFilamentSensors> filament_{};
  bool probe_line_ = false;
  LocalTime due_{0}, next_sample_{0}, hearing_due_{0};
  bool touched_ = true;
};

}  // namespace kinebus
