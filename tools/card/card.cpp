#include "tools/card/card.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinebus {
namespace {

using namespace std::chrono_literals;
namespace control = cia402::control;

constexpr LocalTime kPoll = 20ms;
constexpr LocalTime kTransition = 2s;
/// A node without current control of its own never begins; one that has takes about a second.
constexpr LocalTime kTuneBegins = 2s, kTuneEnds = 20s;

}  // namespace

const char* words_of(cia402::State state) {
  static constexpr std::array kWords{
      "not ready to switch on", "switch on disabled", "ready to switch on",    "switched on",
      "operation enabled",      "quick stop active",  "fault reaction active", "fault"};
  return kWords[static_cast<std::size_t>(state)];
}

const char* words_of(SwitchFunction function) {
  static constexpr std::array kWords{"",
                                     "home A",
                                     "home B",
                                     "positive limit A",
                                     "positive limit B",
                                     "negative limit A",
                                     "negative limit B",
                                     "emergency stop",
                                     "probe"};
  const auto place = static_cast<std::size_t>(function);
  return place < kWords.size() ? kWords[place] : "unknown";
}

ObjectAddress Card::on(int axis, ObjectAddress base) {
  return {static_cast<std::uint16_t>(base.index + (axis & 1) * kAxisOffset), base.subindex};
}

cia402::State Card::drive_state(int axis) {
  return cia402::state_of(static_cast<std::uint16_t>(read(axis, object::kStatusword)));
}

Card::State Card::state() {
  State s;
  s.name = node_.read_text({0x1008, 0});
  s.serial = static_cast<std::uint32_t>(read(object::kSerialIdentity));
  for (int i = 0; i < 2; ++i) {
    Axis& axis = s.axes[static_cast<std::size_t>(i)];
    axis.state = drive_state(i);
    axis.position_known = read(i, object::kPositionKnown) != 0;
    axis.position_counts = static_cast<std::int32_t>(read(i, object::kPositionActual));
    axis.run_ma = static_cast<int>(read(i, object::kRunCurrent));
    axis.hold_ma = static_cast<int>(read(i, object::kHoldCurrent));
    axis.measured_ma = static_cast<int>(read(i, object::kMotorCurrent));
    axis.stage_celsius = static_cast<double>(read(i, object::kStageTemperature)) / 10;
    axis.supply_volts = static_cast<double>(read(i, {0x6079, 0})) / 1000;
    axis.tune_state = static_cast<int>(read(i, object::kAutoTune));
    axis.error_code = static_cast<std::uint16_t>(read(i, object::kErrorCode));
  }
  const auto active = static_cast<unsigned>(read(object::kSwitchLevels));
  for (std::size_t i = 0; i < s.inputs.size(); ++i) {
    const auto nth = [&](ObjectAddress first) {
      return read({first.index, static_cast<std::uint8_t>(first.subindex + i)});
    };
    s.inputs[i] = {static_cast<SwitchFunction>(nth(object::kSwitchFunction)),
                   nth(object::kSwitchPolarity) != 0, (active >> i & 1u) != 0};
  }
  const auto errors = read(object::kErrorHistory);
  for (std::int64_t i = 1; i <= std::min<std::int64_t>(errors, kErrorHistoryLength); ++i)
    s.errors.push_back(
        static_cast<std::uint16_t>(read({object::kErrorHistory.index, static_cast<std::uint8_t>(i)})));
  return s;
}

void Card::set_currents(int axis, std::optional<int> run_ma, std::optional<int> hold_ma) {
  const std::int64_t run = run_ma ? *run_ma : read(axis, object::kRunCurrent);
  const std::int64_t hold = hold_ma ? *hold_ma : read(axis, object::kHoldCurrent);
  if (hold > run)
    throw CardError(fmt::format("the hold current, {} mA, would be above the run current, {} mA", hold, run));
  if (run_ma) write(axis, object::kRunCurrent, run);
  if (hold_ma) write(axis, object::kHoldCurrent, hold);
}

void Card::power(int axis, bool on) {
  if (!on) return write(axis, object::kControlword, 0);
  constexpr cia402::State kOn = cia402::State::kOperationEnabled;
  if (drive_state(axis) == kOn) return;
  // Also lifts a stop that is latched, where no gateway speaks.
  write(axis, object::kControlword, 0);
  write(axis, object::kControlword, control::kFaultReset);
  for (const std::uint16_t word : {control::kShutdown, control::kSwitchedOn, control::kOperation})
    write(axis, object::kControlword, word);
  for (const LocalTime end = node_.now() + kTransition; drive_state(axis) != kOn;) {
    if (node_.now() >= end)
      throw CardError(fmt::format("axis {} does not switch on: {}, error {:04X}h", "AB"[axis & 1],
                                  words_of(drive_state(axis)),
                                  static_cast<unsigned>(read(axis, object::kErrorCode))));
    node_.pause(kPoll);
  }
}

std::int32_t Card::jog(int axis, std::int64_t counts, double counts_per_s,
                       const std::function<bool()>& stop) {
  write(axis, object::kModeOfOperation, static_cast<int>(cia402::Mode::kProfilePosition));
  power(axis, true);
  const double fastest = static_cast<double>(read(axis, object::kMaxProfileVelocity));
  if (!(counts_per_s >= 1) || counts_per_s > fastest)
    throw CardError(
        fmt::format("speed {:.0f} counts/s; expected 1 .. {:.0f}, as 607Fh says", counts_per_s, fastest));
  const std::int64_t target = read(axis, {0x6062, 0}) + counts;
  if (target != static_cast<std::int32_t>(target))
    throw CardError(fmt::format("{} counts lead beyond what 32 bits can count", counts));
  write(axis, object::kProfileVelocity, std::llround(counts_per_s));
  write(axis, object::kTargetPosition, target);
  write(axis, object::kControlword, control::kOperation);
  write(axis, object::kControlword, control::kOperation | control::kNewSetPoint);
  bool stopping = false;
  for (;;) {
    const auto word = static_cast<std::uint16_t>(read(axis, object::kStatusword));
    if (cia402::state_of(word) != cia402::State::kOperationEnabled)
      throw CardError(fmt::format("axis {} has stopped: {}, error {:04X}h", "AB"[axis & 1],
                                  words_of(cia402::state_of(word)),
                                  static_cast<unsigned>(read(axis, object::kErrorCode))));
    if ((word & cia402::status::kTargetReached) != 0) break;
    if (!stopping && stop && stop()) {
      stopping = true;
      write(axis, object::kControlword, control::kOperation | control::kHalt);
    }
    node_.pause(kPoll);
  }
  // A halt that ends would go on to the target: the target is where the motor stands.
  if (stopping) {
    write(axis, object::kTargetPosition, read(axis, {0x6062, 0}));
    write(axis, object::kModeOfOperation, 0);
  }
  write(axis, object::kControlword, control::kOperation);
  return static_cast<std::int32_t>(read(axis, object::kPositionActual));
}

Card::Tuned Card::tune(int axis) {
  power(axis, true);
  write(axis, object::kAutoTune, 1);
  const LocalTime begun = node_.now();
  for (;;) {
    const std::int64_t state = read(axis, object::kAutoTune);
    if (state == 2) break;
    if (state == 3)
      throw CardError(
          fmt::format("auto-tune of axis {} failed: is a motor connected, and is it free?", "AB"[axis & 1]));
    if (state == 0 && node_.now() - begun > kTuneBegins)
      throw CardError(
          fmt::format("axis {} does not begin to tune: this node measures no currents", "AB"[axis & 1]));
    if (node_.now() - begun > kTuneEnds) throw CardError("auto-tune does not end");
    node_.pause(kPoll);
  }
  return {static_cast<int>(read(axis, object::kPhaseResistance)),
          static_cast<int>(read(axis, object::kPhaseInductance)),
          static_cast<int>(read(axis, object::kEncoderOffset))};
}

void Card::store() {
  using enum cia402::State;
  for (int axis = 0; axis < 2; ++axis)
    if (const cia402::State state = drive_state(axis); state == kSwitchedOn || state == kOperationEnabled ||
                                                       state == kQuickStopActive ||
                                                       state == kFaultReactionActive)
      throw CardError(
          fmt::format("motor {} has power, and a node writes no memory while one has: switch it "
                      "off first (kinebus-card off {})",
                      "AB"[axis], "AB"[axis]));
  write(object::kStoreParameters, kSaveSignature);
}

}  // namespace kinebus
