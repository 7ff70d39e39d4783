#pragma once
// A heat node on the bus, as all that lives on it share it: what each channel is to do goes out by SDO, one
// write at a time, the newest alone; temperatures and states come by TPDO, reasons by EMCY. Its settings are
// bring-up's. Safety is the node's own: here is what the gateway has to know of it.

#include <array>
#include <cstdint>
#include <optional>

#include "gateway/devices/device.hpp"
#include "gateway/devices/heat_node_tuning.hpp"
#include "gateway/devices/vibration_reading.hpp"
#include "protocol/canopen/heat_units.hpp"
#include "protocol/canopen/sdo_client.hpp"

namespace kinebus {

class HeatNodeLink : public Device {
 public:
  /// Temperatures come four times a second, states once and whenever one changes.
  static constexpr BusTime kTemperatureTimeout = std::chrono::seconds{2};
  static constexpr BusTime kStateTimeout = std::chrono::milliseconds{2500};

  /// `all_fans`: every fan of the machine is the node's own. Then it is told that nothing flows, too, and
  /// knows of everything that takes heat away.
  /// `axes`: VibrationReading.
  HeatNodeLink(std::uint8_t id, bool all_fans, std::array<std::uint8_t, 3> axes = {0, 1, 2})
      : id_(id), all_fans_(all_fans), vibration_(axes) {}

  bool on_frame(BusTime now, const CanFrame& frame) override;
  void on_time(BusTime now) override;
  void on_bring_up(BusTime now, bool done) override;
  std::optional<CanFrame> next_frame(BusTime now) override;
  BusTime next_deadline() const override { return sdo_.next_deadline(); }
  std::optional<Sentence> absent() const override;

  // Channels of a kind and inputs are counted from 0.
  void set_target(std::size_t heater, double celsius);
  void set_output(std::size_t output, double ratio);
  double target(std::size_t heater) const { return set_points_[heater].wanted / 10.0; }
  double output(std::size_t output) const;
  double celsius(std::size_t input) const { return temperatures_[input] / 10.0; }
  HeaterStatus status(std::size_t heater) const;
  std::optional<Sentence> heater_fault(std::size_t heater) const;
  /// The node is asked to try again.
  void reset_fault(std::size_t heater);
  /// The node measures it; a target, 0 too, ends that. One at a time.
  void tune(std::size_t heater, double celsius, double power_w);
  HeaterTuning tuning(std::size_t heater) const;
  /// For one heater at a time. Where several of the node melt filament, it is told which before (2228h);
  /// where one does, its settings say so.
  void feed_ahead(std::size_t heater, const FlowAhead& watts);
  void let_several_melt() { several_melt_ = true; }
  FilamentCondition filament(std::size_t sensor) const { return filaments_[sensor]; }
  /// Where the extruder is to be now; the node holds what its wheels see against it.
  void follow_extruder(double mm);
  void reset_filament(std::size_t sensor);
  /// Of the probe whose servo the node drives.
  void move_pin(ContactProbe::PinOrder order);
  ContactProbe::Pin pin() const;
  Sentence pin_words() const;
  void begin_vibration() { vibration_.begin(now_); }
  void end_vibration() { vibration_.end(); }
  const VibrationFound& vibration() const { return vibration_.found(); }

 private:
  enum class State : std::uint8_t { kOff = 0, kHeats = 1, kThere = 2, kTunes = 3, kFault = 4 };
  /// A number on the node, and whether it has it already.
  struct Value {
    std::int16_t wanted = 0;
    bool due = false;
    BusTime told{0};
    AbortCode refused = AbortCode::kNone;
    void set(std::int16_t value) {
      due = due || value != wanted || refused != AbortCode::kNone;
      refused = AbortCode::kNone;
      wanted = value;
    }
  };
  enum class Writing : std::uint8_t {
    kNothing,
    kReset,
    kSetPoint,
    kOutput,
    kFilament,
    kPin,
    kModel,
    kTuning,
    kVibration,
    kFlowHeater
  };

  bool on_report(BusTime now, const CanFrame& frame);
  void on_states(std::span<const std::uint8_t> states);
  void on_emergency(const CanFrame& frame);
  bool begin(BusTime now, Writing what, std::size_t n, ObjectAddress first, std::int16_t value, int bytes);
  void begin_next(BusTime now);
  bool ask(BusTime now, const std::optional<HeatNodeTuning::Question>& question);
  std::optional<CanFrame> flow_frame(BusTime now);
  std::optional<CanFrame> extruder_frame(BusTime now);
  void settle(BusTime now);

  std::uint8_t id_;
  bool all_fans_;
  bool serves_ = false;
  SdoClient sdo_;
  Writing writing_ = Writing::kNothing;
  std::size_t channel_ = 0;
  std::int16_t written_ = 0;
  std::array<std::uint8_t, 4> bytes_{};
  HeatNodeTuning tuning_;
  VibrationReading vibration_;
  using Flow = std::array<std::int16_t, std::tuple_size_v<FlowAhead>>;  ///< 10 mW
  Flow flow_{}, flow_told_{};
  BusTime flow_told_at_{0};
  bool several_melt_ = false;
  Value flow_heater_{.wanted = 1};  ///< 2228h: counted from 1

  std::array<Value, kHeaters> set_points_{};
  std::array<bool, kHeaters> reset_due_{};
  std::array<bool, kHeaters> model_due_{};  ///< whether the node has one is to be asked
  std::array<Measured, kHeaters> has_model_{};
  std::array<Value, kFans> outputs_{};
  std::array<State, kHeaters> states_{};
  std::array<std::uint16_t, kHeaters> reasons_{};  ///< EMCY codes; 0: none
  std::array<bool, kHeaters> lost_{};              ///< off, and not by this gateway
  std::array<std::int16_t, kHeatSensors> temperatures_{};
  std::array<std::int16_t, kHeaters> powers_{};  ///< 0.1 %
  bool powers_told_ = false;
  std::array<FilamentCondition, kFilamentSensors> filaments_{};
  std::array<bool, kFilamentSensors> filament_due_{};
  /// The values are those of 2262h.
  enum class PinTold : std::uint8_t { kUnknown, kIn, kOut, kMoves, kNotOut, kNotIn, kAlarm, kSelfTest };
  struct PinLink {
    PinTold told = PinTold::kUnknown;
    ContactProbe::PinOrder order = ContactProbe::PinOrder::kIn;
    bool asked = false, due = false;
    BusTime since{0};
    AbortCode refused = AbortCode::kNone;
  } pin_;
  std::uint32_t extruder_um_ = 0, extruder_told_um_ = 0;
  BusTime extruder_told_at_{0};
  BusTime heard_{0}, measured_{0}, now_{0};
};

}  // namespace kinebus
