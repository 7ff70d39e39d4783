#pragma once
// A machine on virtual nodes whose devices do at once what they are told, and go wrong when a test says so:
// seconds of a job cost milliseconds of a test. And all that is told, word for word.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <utility>

#include "gateway/machine/tests/machine_rig.hpp"

namespace kinebus {

/// What stands behind the devices.
struct Hand {
  struct OfHeater {
    double actual = 20, target = 0;
    int fed_ahead = 0;  ///< times that it was told what filament to come will take
    FlowAhead ahead{};
    bool lags = false;  ///< it does not come to its target
    bool broken = false;
    bool told = false;  ///< that it is: until that is cleared, it does not heat
    Measured measured = Measured::kNotTold;
    std::optional<HeaterTuning> tuning;  ///< none: nobody can measure it
  };
  OfHeater hotend, bed;
  FilamentCondition filament = FilamentCondition::kInOrder;
  int followed = 0;  ///< times that the extruder's place was told
  double extruder_mm = 0;
  ContactProbe::Pin pin = ContactProbe::Pin::kNone;  ///< kNone: there is no probe
  std::optional<ContactProbe::PinOrder> pin_order;   ///< the last one
  double spindle_rpm = 0;                            ///< to be
  bool spindle_lags = false;
  int served = 0;  ///< turns of the spindle's on_time()
};

class HandHeater final : public Heater {
 public:
  explicit HandHeater(Hand::OfHeater& hand) : hand_(hand) {}
  void set_target(double celsius) override {
    hand_.target = hand_.told ? 0 : celsius;
    if (!hand_.lags) hand_.actual = hand_.target > 0 ? hand_.target : 20;
  }
  HeaterStatus status() const override {
    return {.actual_celsius = hand_.actual, .target_celsius = hand_.target, .measured = hand_.measured};
  }
  std::optional<Sentence> cannot_tune() const override {
    return hand_.tuning ? std::nullopt : Heater::cannot_tune();
  }
  void tune(double celsius) override { hand_.tuning = HeaterTuning{TuningStage::kBegins, celsius, {}, {}}; }
  HeaterTuning tuning() const override { return hand_.tuning.value_or(HeaterTuning{}); }
  void feed_ahead(const FlowAhead& watts) override {
    ++hand_.fed_ahead;
    hand_.ahead = watts;
  }
  std::optional<Sentence> fault() const override {
    hand_.told = hand_.told || hand_.broken;
    return hand_.told ? std::optional(Sentence::verbatim("the sensor is open")) : std::nullopt;
  }
  void clear_fault() override { hand_.told = hand_.broken; }

 private:
  Hand::OfHeater& hand_;
};

class HandFilament final : public FilamentSensor {
 public:
  explicit HandFilament(Hand& hand) : hand_(hand) {}
  FilamentCondition condition() const override { return hand_.filament; }
  void follow(double mm) override {
    ++hand_.followed;
    hand_.extruder_mm = mm;
  }

 private:
  Hand& hand_;
};

class HandProbe final : public ContactProbe {
 public:
  explicit HandProbe(Hand& hand) : hand_(hand) {}
  bool touches() const override { return false; }
  Pin pin() const override { return hand_.pin; }
  void move_pin(PinOrder order) override { hand_.pin_order = order; }
  Sentence pin_words() const override { return Sentence::verbatim("the pin is stuck"); }

 private:
  Hand& hand_;
};

class HandSpindle final : public SpindleDrive {
 public:
  explicit HandSpindle(Hand& hand) : hand_(hand) {}
  void on_time(BusTime) override { ++hand_.served; }
  void set(double rpm) override { hand_.spindle_rpm = rpm; }
  SpindleStatus status() const override {
    return {.actual_rpm = hand_.spindle_lags ? 0 : hand_.spindle_rpm, .target_rpm = hand_.spindle_rpm};
  }

 private:
  Hand& hand_;
};

class HandRig : public ::testing::Test {
 protected:
  explicit HandRig(MachineDescription description = with_devices(default_m1()))
      : rig(std::move(description)) {
    use(rig.machine);
  }
  static MachineDescription with_devices(MachineDescription machine) {
    machine.filament_sensors.push_back({.name = "spool"});
    machine.spindle = {.present = true, .min_rpm = 1000, .max_rpm = 24000};
    return machine;
  }
  /// Another gateway, on this file.
  void use(const MachineDescription& machine, Gateway::Options options = {}) {
    Devices devices;
    devices.add(kFirstHotend, "hotend", 0, std::make_unique<HandHeater>(hand.hotend));
    devices.add(kFirstBed, "bed", 0, std::make_unique<HandHeater>(hand.bed));
    devices.add_filament_sensor("spool", 0, std::make_unique<HandFilament>(hand));
    if (hand.pin != ContactProbe::Pin::kNone) devices.set_probe(0, std::make_unique<HandProbe>(hand));
    devices.set_spindle(0, std::make_unique<HandSpindle>(hand));
    rig.machine = machine;
    rig.gateway = std::make_unique<Gateway>(rig.machine, options, std::move(devices));
  }
  ::testing::AssertionResult ready() {
    if (!rig.make_ready()) return ::testing::AssertionFailure() << rig.story();
    rig.events.clear();
    return ::testing::AssertionSuccess();
  }
  Result<void, Refusal> asks(Command command) { return rig.gateway->carry_out(std::move(command)); }
  Result<void, Refusal> runs(std::string text) {
    return asks(command::Run{std::make_unique<StringSource>(std::move(text)), "part"});
  }
  /// A job, to where X is `x_mm` on its way up.
  ::testing::AssertionResult runs_to(std::string text, double x_mm) {
    if (const auto done = runs(std::move(text)); !done)
      return ::testing::AssertionFailure() << done.error().words.english();
    if (!rig.run_until([&] { return state() == MachineState::kRunning && x() > x_mm; }, k30s))
      return ::testing::AssertionFailure() << rig.story();
    return ::testing::AssertionSuccess();
  }
  /// "": it is carried out; else why not.
  std::string why_not(Command command) {
    const auto done = asks(std::move(command));
    return done ? std::string() : done.error().words.english();
  }
  /// What was told since the last time, one a line: "= state", "! alarm", "- message", ". end -> advice".
  std::string told() {
    while (auto event = rig.gateway->next_event()) rig.events.push_back(std::move(*event));
    std::string text;
    for (const MachineEvent& e : rig.events) {
      static constexpr std::array<const char*, 5> kMarks{"= ", "! ", "- ", "? ", ". "};
      text += kMarks[static_cast<std::size_t>(e.kind)] + e.words.english();
      if (e.kind == MachineEvent::Kind::kFinished && !e.advice.empty()) text += " -> " + e.advice.english();
      text += '\n';
    }
    rig.events.clear();
    return text;
  }
  MachineStatus status() const { return rig.gateway->status(); }
  MachineState state() const { return rig.gateway->state(); }
  double x() const { return status().machine_pose[kX]; }
  double z() const { return status().machine_pose[kZ]; }
  /// Nothing moves any more, as the motors are.
  bool rests() {
    rig.run_for(std::chrono::milliseconds{300});
    const JointVector still = rig.joints();
    rig.run_for(std::chrono::milliseconds{300});
    return rig.joints() == still;
  }

  /// 60 mm out and back, 6 s.
  inline static const std::string kLine = "G1 X60 F1200\nG1 X0\n";
  static constexpr BusTime k30s = std::chrono::seconds{30};
  Hand hand;
  MachineRig rig;
};

}  // namespace kinebus
