#pragma once
// What a machine has besides motion, as the gateway sees it: one interface for each kind, whoever stands
// behind it (the simulation, a node on the bus). All are sans-IO, in the shape of every core here.

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/description/device_description.hpp"
#include "gateway/sentence.hpp"
#include "protocol/can/frame.hpp"
#include "protocol/canopen/object.hpp"
#include "protocol/time.hpp"

namespace kinebus {

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// Every frame of the bus that no motion part needs for itself alone. True: it was this device's.
  virtual bool on_frame(BusTime, const CanFrame&) { return false; }
  virtual void on_time(BusTime) {}
  /// Pulled until empty. Small: streams of motion share the bus.
  virtual std::optional<CanFrame> next_frame(BusTime) { return std::nullopt; }
  /// When on_time() is next needed; it comes at least ten times a second anyway.
  virtual BusTime next_deadline() const { return BusTime::max(); }
  /// Bring-up begins (false): its node hears nobody else now. It is done (true): the node is in operation,
  /// and has the machine file's settings.
  virtual void on_bring_up(BusTime, bool) {}
  /// Why it cannot be told anything now; none: it can.
  virtual std::optional<Sentence> absent() const { return std::nullopt; }
  /// The operator has seen to what was wrong: a fault that has gone is forgotten.
  virtual void clear_fault() {}
  /// Plain words while it is out of order (sensor broken, no rise); then it has switched itself off already.
  virtual std::optional<Sentence> fault() const { return std::nullopt; }
};

/// Whether its node has measured a heater, and watches it by that.
enum class Measured : std::uint8_t { kNotTold, kNotYet, kYes };

struct HeaterStatus {
  double actual_celsius = 0;
  double target_celsius = 0;      ///< 0: off
  std::optional<double> power{};  ///< of full, 0..1; none: not told
  Measured measured = Measured::kNotTold;
};

/// How far a heater's node is with measuring it, or how that ended last.
enum class TuningStage : std::uint8_t { kNone, kBegins, kHeats, kCools, kFits, kKeeps, kDone, kFailed };

/// A heater as its node has measured it.
struct HeaterModel {
  double power_w = 0;  ///< at the nominal supply, as the machine file says
  double capacity_j_per_k = 0, loss_w_per_k = 0;
  double lag_s = 0, dead_s = 0;  ///< of the sensor behind the block; of the block behind the power
};

struct HeaterTuning {
  TuningStage stage = TuningStage::kNone;
  double celsius = 0;  ///< it shall be good at
  HeaterModel model;   ///< after kFits
  Sentence failure;    ///< why it failed, or why the result will not outlive the node's power
  bool runs() const { return stage >= TuningStage::kBegins && stage <= TuningStage::kKeeps; }
};

/// The power that filament to come will take of a hot end, W: means over steps, the first from now.
inline constexpr BusTime kFlowAheadStep = std::chrono::milliseconds{400};
using FlowAhead = std::array<double, 4>;

class Heater : public Device {
 public:
  virtual void set_target(double celsius) = 0;  ///< 0: off, a measurement too
  virtual HeaterStatus status() const = 0;

  /// Why nobody can measure it; none: tune() may be called.
  virtual std::optional<Sentence> cannot_tune() const {
    return say("it is simulated: only a heater on a heat node can be measured");
  }
  /// Its node heats it part of the way and finds its model; needs cannot_tune() to be none.
  virtual void tune(double) {}
  virtual HeaterTuning tuning() const { return {}; }

  /// Ten times a second while it may be other than none.
  virtual void feed_ahead(const FlowAhead&) {}
};

/// A fan or an output.
class Output : public Device {
 public:
  virtual void set(double ratio) = 0;  ///< 0..1
  virtual double ratio() const = 0;
};

enum class InputLevel : std::uint8_t { kUnknown, kOff, kOn };

/// Something that a job may wait for.
class Input : public Device {
 public:
  /// kUnknown: its node has not told yet.
  virtual InputLevel level() const = 0;
  /// How often it has come on, and gone off: however short it was.
  struct Changes {
    std::uint32_t rises = 0, falls = 0;
  };
  virtual Changes changes() const = 0;
};

/// Of an encoder on the spindle.
struct SpindleAngle {
  BusTime at{0};
  double turns = 0;  ///< whole at each index pulse; grows whichever way it turns

  friend bool operator==(const SpindleAngle&, const SpindleAngle&) = default;
};

struct SpindleStatus {
  double actual_rpm = 0, target_rpm = 0;  ///< > 0 clockwise
  std::optional<SpindleAngle> angle{};    ///< none: no encoder, or no index pulse has come yet

  /// Under load it is a little slow.
  bool at_speed() const {
    constexpr double kWindow = 0.02;
    return std::abs(actual_rpm - target_rpm) <= kWindow * std::abs(target_rpm);
  }
};

class SpindleDrive : public Device {
 public:
  virtual void set(double rpm) = 0;  ///< > 0 clockwise, < 0 the other way, 0: off
  virtual SpindleStatus status() const = 0;
};

class Sensor : public Device {
 public:
  virtual double celsius() const = 0;
};

/// As its node judges it; the values are those of 2258h.
enum class FilamentCondition : std::uint8_t { kInOrder, kOut, kStands, kSlips };

/// Being out of order is no fault of the machine: it has nothing to print with.
class FilamentSensor : public Device {
 public:
  virtual FilamentCondition condition() const = 0;
  /// Where the extruder is to be now, mm; ten times a second.
  virtual void follow(double) {}
};

/// A number of the probe's node, to be read or written by SDO.
struct ProbeRequest {
  ObjectAddress address;
  bool read = true;
  std::uint8_t size = 0;  ///< bytes
  std::int64_t value = 0;
};

class ContactProbe : public Device {
 public:
  /// How far it is with one contact.
  enum class Watch : std::uint8_t {
    kOff,
    kArms,     ///< its node is told; touches() is not known for certain
    kWaits,    ///< for the contact
    kAsks,     ///< it has come, or may have: its time is asked for
    kContact,  ///< contact() says when
    kNone,     ///< asked for: it has not come
    kFailed    ///< its node does not answer
  };
  virtual bool touches() const = 0;
  /// The next contact counts; with `away` the next time that it lets go.
  virtual void arm(bool) {}
  /// No more of the way is left: has it come?
  virtual void ask() {}
  virtual Watch watch() const { return Watch::kOff; }
  /// On the clock of the bus.
  virtual BusTime contact() const { return BusTime{0}; }

  /// Where the pin is of a probe that has one: out for a contact, in before all other motion.
  enum class Pin : std::uint8_t { kNone, kMoves, kIn, kOut, kFailed, kTests };
  virtual Pin pin() const { return Pin::kNone; }
  /// kTest: in and out by itself, until it is told something else. kReset: ends its alarm, and draws it in.
  enum class PinOrder : std::uint8_t { kOut, kIn, kTest, kReset };
  virtual void move_pin(PinOrder) {}
  /// After kFailed: why it is not where it should be.
  virtual Sentence pin_words() const { return {}; }

  // Its node's objects, which the owner asks for: one after the other, in this order.
  virtual std::optional<ProbeRequest> next_request() { return std::nullopt; }
  /// nullopt: there was no answer, or a refusal.
  virtual void on_reply(BusTime, std::optional<std::int64_t>) {}
};

/// What an accelerometer has felt, as energy over frequency.
struct VibrationFound {
  enum class Stage : std::uint8_t { kNone, kMeasures, kReads, kDone, kFailed };
  Stage stage = Stage::kNone;
  Sentence failure;
  // After kDone.
  double rate_hz = 0;         ///< readings a second; a band is 1/8192 of it wide, the first around 0 Hz
  std::uint32_t windows = 0;  ///< of 2.56 s, a quarter of that apart
  std::uint32_t clipped = 0;  ///< readings at the end of its range
  /// Along X, Y and Z in each band: squares of amplitudes, mm^2/s^4, over all windows.
  std::vector<std::array<double, 3>> energy;
};

class VibrationSensor : public Device {
 public:
  virtual void begin() = 0;
  /// What was found so far is read.
  virtual void end() = 0;
  virtual const VibrationFound& found() const = 0;
};

}  // namespace kinebus
